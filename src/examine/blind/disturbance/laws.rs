//! Changes of the values of one joint by a law. A law may capture a state: each log starts with a
//! copy of the closure as it was created.

use super::super::action::{Action, Begin, BeginPower, Moment};
use super::super::fault::Disturbance;
use super::super::mechanics::Joints;
use crate::arm::robot::MAX_DOF;

/// Zero for each joint.
pub(super) const NONE: Joints = [0.0; MAX_DOF];

/// A change of the values of all joints.
pub(super) fn change(
    law: impl FnMut(&Moment, &mut Joints) + Clone + Send + Sync + 'static,
) -> Begin {
    Box::new(move || Box::new(law.clone()))
}

/// A term added to the values of one joint.
fn term(
    joint: usize,
    mut law: impl FnMut(&Moment) -> f64 + Clone + Send + Sync + 'static,
) -> Begin {
    change(move |moment, values| values[joint] += law(moment))
}

impl Disturbance {
    /// Adds a torque at the motor of a joint.
    pub(super) fn motor_torque(
        self,
        joint: usize,
        law: impl FnMut(&Moment) -> f64 + Clone + Send + Sync + 'static,
    ) -> Disturbance {
        self.acting(Action::Gears(term(joint, law)))
    }

    /// Adds a torque at the link of a joint.
    pub(super) fn joint_torque(
        self,
        joint: usize,
        law: impl FnMut(&Moment) -> f64 + Clone + Send + Sync + 'static,
    ) -> Disturbance {
        self.acting(Action::Joints(term(joint, law)))
    }

    /// Changes the logged torque of a joint.
    pub(super) fn logged_torque(
        self,
        joint: usize,
        mut law: impl FnMut(&Moment, f64) -> f64 + Clone + Send + Sync + 'static,
    ) -> Disturbance {
        let logged = change(move |moment, tau| tau[joint] = law(moment, tau[joint]));
        self.acting(Action::Torques(logged))
    }

    /// Changes the power.
    pub(super) fn power(
        self,
        law: impl FnMut(&Moment, &Joints, f64) -> f64 + Clone + Send + Sync + 'static,
    ) -> Disturbance {
        let begin: BeginPower = Box::new(move || Box::new(law.clone()));
        self.acting(Action::Power(begin))
    }
}

//! The use of limits by a motion.

use crate::arm::dynamics::{Data, Load};
use crate::arm::kinematics::{fk, jacobian, limits_ok};
use crate::arm::robot::Model;
use crate::retime::energy::power::power;
use crate::retime::motion::timed::JointState;
use crate::retime::path::joint_path::Joints;
use crate::tool::retrofit::largest_share;
use nalgebra::{Isometry3, Vector6};

/// Shares of the limits that a motion uses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measure {
    /// Of the joint speed limits.
    pub velocity: f64,
    /// Of the joint acceleration limits.
    pub acceleration: f64,
    /// Of the joint torque limits.
    pub torque: f64,
    /// Of the robot's maximum TCP speed.
    pub tcp_speed: f64,
    /// Maximum distance of the flange from the intended position at any time, m.
    pub deviation_m: f64,
    /// Whether some joint leaves its range.
    pub out_of_range: bool,
}

impl Measure {
    /// Adds a state without load at the flange.
    pub(super) fn add(&mut self, model: &Model, data: &mut Data, state: &JointState) {
        let limits = &model.limits;
        self.velocity = self.velocity.max(largest_share(&state.qd, limits.velocity.as_ref()));
        self.acceleration =
            self.acceleration.max(largest_share(&state.qdd, limits.acceleration.as_ref()));
        self.out_of_range |= limits_ok(model, &state.q).is_err();
        if model.has_dynamics() {
            let tau = power(model, data, &Load::none(), state).tau;
            self.torque = self.torque.max(largest_share(&tau, limits.torque.as_ref()));
        }
        if let Some(limit) = limits.tcp_speed {
            let rate = jacobian(model, &state.q, &Isometry3::identity()) * Vector6::from(state.qd);
            self.tcp_speed = self.tcp_speed.max(rate.fixed_rows::<3>(0).norm() / limit);
        }
    }

    /// Adds the distance between a position and the intended one.
    pub(super) fn add_deviation(&mut self, model: &Model, q: &Joints, intended: &Joints) {
        let distance =
            (fk(model, q).translation.vector - fk(model, intended).translation.vector).norm();
        self.deviation_m = self.deviation_m.max(distance);
    }

    /// The exceeded limit in words.
    pub(super) fn exceeded_limit(&self) -> Option<String> {
        let figures = [
            ("joint speed", self.velocity),
            ("joint acceleration", self.acceleration),
            ("torque", self.torque),
            ("speed of the tool", self.tcp_speed),
        ];
        let worst = figures.into_iter().fold(("", 0.0), |a, b| if b.1 > a.1 { b } else { a });
        if worst.1 > 1.0 {
            return Some(format!("the {} would be {:.1} % of the limit", worst.0, 100.0 * worst.1));
        }
        self.out_of_range.then(|| "a joint would leave its range".to_owned())
    }
}

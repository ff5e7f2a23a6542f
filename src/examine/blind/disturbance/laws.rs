//! Changes of joint values by laws with and without internal state.

use super::super::action::{Begin, Moment};
use super::super::mechanics::Joints;
use crate::arm::robot::MAX_DOF;

/// A stateless term added to one joint.
pub(super) fn memoryless(
    joint: usize,
    law: impl Fn(&Moment) -> f64 + Clone + Send + Sync + 'static,
) -> Begin {
    Box::new(move || {
        let law = law.clone();
        Box::new(move |moment, tau| tau[joint] += law(moment))
    })
}

/// A term with state added to one joint; the state is reset at the start of each log.
pub(super) fn with_state<S: Clone + Send + Sync + 'static>(
    joint: usize,
    state: S,
    law: impl Fn(&mut S, &Moment) -> f64 + Clone + Send + Sync + 'static,
) -> Begin {
    Box::new(move || {
        let (law, mut state) = (law.clone(), state.clone());
        Box::new(move |moment, tau| tau[joint] += law(&mut state, moment))
    })
}

/// A stateless change of one joint's logged value.
pub(super) fn mapped(
    joint: usize,
    law: impl Fn(&Moment, f64) -> f64 + Clone + Send + Sync + 'static,
) -> Begin {
    Box::new(move || {
        let law = law.clone();
        Box::new(move |moment, values| values[joint] = law(moment, values[joint]))
    })
}

/// Zero for each joint.
pub(super) const NONE: Joints = [0.0; MAX_DOF];

//! Springs of single joints.

use crate::arm::robot::LawState;

use crate::arm::effects::effect::{Published, Values};

/// Coordinates are stiffness and torque at 0; parameters are stiffness and centre.
pub(in crate::arm::effects) const STIFFNESS_AND_CENTRE: Published = Published {
    parameters: |x| match x {
        [stiffness, at_zero, ..] if *stiffness != 0.0 => vec![*stiffness, -at_zero / stiffness],
        _ => vec![0.0, 0.0],
    },
    coordinates: |x| match x {
        [stiffness, centre, ..] => vec![*stiffness, -stiffness * centre],
        _ => vec![0.0, 0.0],
    },
};

/// Torque against a spring \[Nm\].
pub(in crate::arm::effects) fn spring(state: &LawState, [stiffness, at_zero, ..]: &Values) -> f64 {
    stiffness * state.q + at_zero
}

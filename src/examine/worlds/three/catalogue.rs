//! All faults of torques.

use super::fault::{Fault, Place};
use super::{draw_body, drive_faults, friction, outside};
use crate::examine::worlds::random::Rng;

/// All torque effects but `link_parameters`, which has its own kind of case.
pub(super) const EFFECTS: [&str; 29] = [
    "payload",
    "rotor_inertia",
    "gravity_spring",
    "base_tilt",
    "encoder_offset",
    "cable",
    "friction_level",
    "torque_offset",
    "stribeck",
    "nonlinear_viscous",
    "viscous_asymmetry",
    "load_friction",
    "gear_efficiency",
    "warm_up",
    "position_friction",
    "presliding",
    "backlash",
    "elasticity",
    "ripple",
    "wrist_coupling",
    "brake_drag",
    "torque_constant",
    "current_saturation",
    "flux_weakening",
    "time_delay",
    "filter_lag",
    "current_sign",
    "contact",
    "apparent_torque",
];

/// Faults for which torques must be the motors' and the model must have rotors.
pub(super) const MOTOR_EFFECTS: [&str; 6] = [
    "rotor_inertia",
    "wrist_coupling",
    "torque_constant",
    "current_saturation",
    "flux_weakening",
    "current_sign",
];

/// The fault of an effect; none where the arm has no place for it.
pub(super) fn draw(id: &'static str, place: &Place, rng: &mut Rng) -> Option<Fault> {
    if id == "outside" {
        return Some(outside::draw(place, rng));
    }
    friction::draw(id, place, rng)
        .or_else(|| drive_faults::draw(id, place, rng))
        .or_else(|| draw_body::draw(id, place, rng))
}

//! The effects that are added, each with its laws.

use super::law::Draw;
use super::{environment, friction, measurement, transmission};

/// An effect with its laws.
#[derive(Clone, Copy)]
pub(super) struct Entry {
    /// Its id.
    pub(super) id: &'static str,
    /// Draws a law of it.
    pub(super) draw: Draw,
}

const fn entry(id: &'static str, draw: Draw) -> Entry {
    Entry { id, draw }
}

/// All effects of the torque but two: other link parameters are no effect, and a flipped current
/// has no small size.
pub(super) const EFFECTS: [Entry; 27] = [
    entry("payload", environment::payload),
    entry("rotor_inertia", transmission::rotor_inertia),
    entry("gravity_spring", environment::gravity_spring),
    entry("base_tilt", environment::base_tilt),
    entry("encoder_offset", environment::encoder_offset),
    entry("cable", environment::cable),
    entry("friction_level", friction::friction_level),
    entry("torque_offset", measurement::torque_offset),
    entry("stribeck", friction::stribeck),
    entry("nonlinear_viscous", friction::nonlinear_viscous),
    entry("viscous_asymmetry", friction::viscous_asymmetry),
    entry("load_friction", friction::load_friction),
    entry("gear_efficiency", friction::gear_efficiency),
    entry("warm_up", friction::warm_up),
    entry("position_friction", friction::position_friction),
    entry("presliding", friction::presliding),
    entry("backlash", transmission::backlash),
    entry("elasticity", transmission::elasticity),
    entry("ripple", transmission::ripple),
    entry("wrist_coupling", transmission::wrist_coupling),
    entry("brake_drag", friction::brake_drag),
    entry("torque_constant", measurement::torque_constant),
    entry("current_saturation", measurement::current_saturation),
    entry("flux_weakening", measurement::flux_weakening),
    entry("time_delay", measurement::time_delay),
    entry("filter_lag", measurement::filter_lag),
    entry("contact", environment::contact),
];

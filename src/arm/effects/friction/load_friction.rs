//! Friction that grows with the gear torque.

use crate::arm::robot::LawState;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Values, Variable, bounded, every, linear,
};

pub(in crate::arm::effects) const LOAD_FRICTION: Effect = Effect {
    id: "load_friction",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::LoadSense),
    title: "Friction of the load",
    law: "τ = mu·|τ_L|·s",
    source: "P. Hamon et al., Dynamic identification of robot with a dry friction model depending on load and velocity, ICRA 2010; A. Bittencourt, S. Gunnarsson, 2012",
    parameters: &[bounded("mu", "1", "friction per torque through the gear", [0.0, 0.5])],
    coordinates: &[linear(|_| 0.08)],
    published: None,
    joints: every,
    brings: &[],
    confused: &["gear_efficiency", "position_friction"],
    inspect: "bearings and preload of the gear",
    experiment: ["--variant payload", "the same path with and without a payload"],
    form: Form::Law { dissipates: true, torque },
};

fn torque(state: &LawState, [mu, ..]: &Values) -> f64 {
    mu * state.gear.abs() * state.sense
}

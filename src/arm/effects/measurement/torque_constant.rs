//! A torque constant or current sensor gain that differs from the stated one.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, bounded, every, linear,
};

pub(in crate::arm::effects) const TORQUE_CONSTANT: Effect = Effect {
    id: "torque_constant",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Measurement,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Torque constant",
    law: "τ = (1 + error) τ",
    source: "M. Gautier, S. Briot, Global identification of drive gains parameters of robots using a known payload, ICRA 2011",
    parameters: &[bounded("error", "1", "logged over true torque, less 1", [-0.9, 4.0])],
    coordinates: &[linear(|_| 0.1)],
    published: None,
    joints: every,
    brings: &[],
    confused: &["link_parameters", "current_saturation"],
    inspect: "temperature of the motor and scale of its current sensor",
    experiment: ["--variant payload", "with and without a known payload"],
    form: Form::Model(|model, joint, values| model.sensors.torque_error[joint] += values[0]),
};

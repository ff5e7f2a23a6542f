//! Rotor and gear inertias that differ from the stated ones.

use crate::arm::effects::scale::Scale;
use crate::arm::robot::Model;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, every, free, linear,
};

pub(in crate::arm::effects) const ROTOR_INERTIA: Effect = Effect {
    id: "rotor_inertia",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Parameter,
    acts: Acts::Always,
    variable: None,
    title: "Inertia of the rotor",
    law: "τ = inertia·q̈_motor",
    source: "M. Gautier, W. Khalil, Direct calculation of minimum set of inertial parameters, IEEE T-RA 6, 1990: of axes 1 and 2 grouped with the links",
    parameters: &[free("inertia", "kg m2", "change of the rotor inertia, at the joint")
        .beside(|model, joint| model.rotors().map(|of| of.reflected_inertia(joint)))],
    coordinates: &[linear(usual)],
    published: None,
    joints: every,
    brings: &[],
    confused: &["elasticity", "filter_lag", "link_parameters"],
    inspect: "type of the motor and gear ratio",
    experiment: ["--harmonics 1,4,7,11", "faster motion"],
    form: Form::Model(change),
};

/// Usual change: a fifth of the rotor, or a tenth of the joint's inertia for a model without rotors.
fn usual(of: &Scale) -> f64 {
    if of.rotor > 0.0 { 0.2 * of.rotor } else { 0.1 * of.inertia }
}

fn change(model: &mut Model, joint: usize, values: &[f64]) {
    match model.rotors_mut() {
        Some(motors) => {
            motors.rotor_inertia[joint] += values[0] / (motors.ratio[joint] * motors.ratio[joint]);
        }
        // A model without rotors says nothing of what is a part of the links already.
        None => model.sensors.apparent_inertia[joint] += values[0],
    }
}

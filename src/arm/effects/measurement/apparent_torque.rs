//! Apparent torque of a log in proportion to acceleration and speed, which may be negative.

use crate::arm::robot::Model;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, every, free, linear,
};

pub(in crate::arm::effects) const APPARENT_TORQUE: Effect = Effect {
    id: "apparent_torque",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Measurement,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Apparent torque",
    law: "τ = inertia·q̈ + viscous·q̇",
    source: "docs/identification.md",
    parameters: &[
        free("inertia", "kg m2", "apparent inertia"),
        free("viscous", "Nm s/rad", "apparent viscous friction"),
    ],
    coordinates: &[linear(|of| 0.1 * of.rotor), linear(|of| 0.1 * of.viscous)],
    published: None,
    joints: every,
    brings: &[],
    confused: &["time_delay", "filter_lag", "elasticity"],
    inspect: "how the drive computes the torque that is logged",
    experiment: ["--harmonics 1,4,7,11", "faster motion tells a delay from an inertia"],
    form: Form::Model(change),
};

fn change(model: &mut Model, joint: usize, values: &[f64]) {
    model.sensors.apparent_inertia[joint] += values[0];
    model.sensors.apparent_viscous[joint] += values[1];
}

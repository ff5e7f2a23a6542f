//! Loss in the windings.

use crate::arm::robot::Model;

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, every, free,
};

pub(in crate::arm::effects) const COPPER_LOSS: Effect = Effect {
    id: "copper_loss",
    channel: Channel::Power,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Loss in the windings",
    law: "P = loss·τ²",
    source: "docs/energy.md",
    parameters: &[free("loss", "W/(Nm)2", "change of the loss per squared torque")],
    coordinates: &[],
    published: None,
    joints: every,
    brings: &[],
    confused: &["inverter_loss"],
    inspect: "resistance and temperature of the windings",
    experiment: ["", "the same program again, logged with its power"],
    form: Form::Model(change),
};

fn change(model: &mut Model, joint: usize, values: &[f64]) {
    if let Some(motors) = &mut model.motors {
        motors.loss_constant[joint] += values[0];
    }
}

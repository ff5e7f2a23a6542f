//! Coils of the brakes.

use crate::arm::robot::Model;

use crate::arm::effects::effect::{Acts, Channel, Effect, Form, Nature, Scope, Subject, free};

pub(in crate::arm::effects) const BRAKE_POWER: Effect = Effect {
    id: "brake_power",
    channel: Channel::Power,
    scope: Scope::Robot,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Coils of the brakes",
    law: "P = power while they are released",
    source: "docs/energy.md",
    parameters: &[free("power", "W", "power more")],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["base_load"],
    inspect: "coils of the brakes, and the brake timeout",
    experiment: ["", "a log with a long wait"],
    form: Form::Model(change),
};

fn change(model: &mut Model, _: usize, values: &[f64]) {
    if let Some(brakes) = &mut model.brakes {
        brakes.power_released_w += values[0];
    }
}

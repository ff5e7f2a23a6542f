//! Controller, fans, brakes.

use crate::arm::effects::effect::{Channel, Effect, Form, Scope, free};

pub(in crate::arm::effects) const BASE_LOAD: Effect = Effect {
    id: "base_load",
    channel: Channel::Power,
    scope: Scope::Robot,
    title: "Controller, fans, brakes",
    law: "P = power",
    source: "docs/energy.md",
    parameters: &[free("power", "W", "power more")],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["brake_power"],
    experiment: ["", "the same program again, logged with its power"],
    form: Form::Model(|model, _, values| model.drive.base_w += values[0]),
};

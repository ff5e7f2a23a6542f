//! Controller, fans, brakes.

use crate::arm::effects::effect::{Acts, Channel, Effect, Form, Nature, Scope, Subject, free};

pub(in crate::arm::effects) const BASE_LOAD: Effect = Effect {
    id: "base_load",
    channel: Channel::Power,
    scope: Scope::Robot,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Controller, fans, brakes",
    law: "P = power",
    source: "docs/energy.md",
    parameters: &[free("power", "W", "power more")],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["brake_power"],
    inspect: "what hangs on the supply of the controller",
    experiment: ["", "the same program again, logged with its power"],
    form: Form::Model(|model, _, values| model.drive.base_w += values[0]),
};

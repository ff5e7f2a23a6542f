//! Loss in the iron.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, every, free,
};

pub(in crate::arm::effects) const IRON_LOSS: Effect = Effect {
    id: "iron_loss",
    channel: Channel::Power,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Loss in the iron",
    law: "P = loss·q̇²",
    source: "docs/energy.md",
    parameters: &[free("loss", "W s2/rad2", "loss per squared rate")],
    coordinates: &[],
    published: None,
    joints: every,
    brings: &[],
    confused: &["friction_level"],
    inspect: "temperature of the motor at high speed",
    experiment: ["", "the same program again, logged with its power"],
    form: Form::Elsewhere,
};

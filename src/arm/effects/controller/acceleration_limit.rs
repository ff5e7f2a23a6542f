//! Acceleration that is higher or lower.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Timing, bounded,
};

pub(in crate::arm::effects) const ACCELERATION_LIMIT: Effect = Effect {
    id: "acceleration_limit",
    channel: Channel::Motion,
    scope: Scope::Robot,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Acceleration that is higher or lower",
    law: "acceleration × factor",
    source: "docs/controller.md",
    parameters: &[bounded("factor", "1", "acceleration over planned acceleration", [0.01, 10.0])],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["speed_limit"],
    inspect: "AccSet, and the loaddata of the tool",
    experiment: ["", "the same program again, logged with `line` or `cmd`"],
    form: Form::Timing(Timing::Acceleration),
};

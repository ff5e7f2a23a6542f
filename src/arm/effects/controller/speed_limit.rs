//! Speed that is limited.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Timing, bounded,
};

pub(in crate::arm::effects) const SPEED_LIMIT: Effect = Effect {
    id: "speed_limit",
    channel: Channel::Motion,
    scope: Scope::Robot,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Speed that is limited",
    law: "speed × factor",
    source: "docs/controller.md",
    parameters: &[bounded("factor", "1", "speed over planned speed", [0.01, 10.0])],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["acceleration_limit"],
    inspect: "speed override and VelSet",
    experiment: ["", "the same program again, logged with `line` or `cmd`"],
    form: Form::Timing(Timing::Speed),
};

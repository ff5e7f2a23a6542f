//! Speed that is limited.

use crate::arm::effects::effect::{Channel, Effect, Form, Scope, Timing, bounded};

pub(in crate::arm::effects) const SPEED_LIMIT: Effect = Effect {
    id: "speed_limit",
    channel: Channel::Motion,
    scope: Scope::Robot,
    title: "Speed that is limited",
    law: "speed × factor",
    source: "docs/controller.md",
    parameters: &[bounded("factor", "1", "speed over planned speed", [0.01, 10.0])],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["acceleration_limit"],
    experiment: ["", "the same program again, logged with `line` or `cmd`"],
    form: Form::Timing(Timing::Speed),
};

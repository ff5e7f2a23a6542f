//! Corners that are cut more or less.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Timing, bounded,
};

pub(in crate::arm::effects) const ZONE_BLENDING: Effect = Effect {
    id: "zone_blending",
    channel: Channel::Motion,
    scope: Scope::Robot,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Corners that are cut more or less",
    law: "zone radius × factor",
    source: "docs/controller.md",
    parameters: &[bounded("factor", "1", "radius over planned radius", [0.0, 10.0])],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["acceleration_limit"],
    inspect: "zones and speeds of the program",
    experiment: ["", "the same program again, logged with `line` or `cmd`"],
    form: Form::Timing(Timing::Blending),
};

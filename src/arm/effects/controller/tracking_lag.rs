//! Lag of the servos.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Timing, free,
};

pub(in crate::arm::effects) const TRACKING_LAG: Effect = Effect {
    id: "tracking_lag",
    channel: Channel::Motion,
    scope: Scope::Robot,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Lag of the servos",
    law: "q(t) = q_ref(t − lag)",
    source: "docs/controller.md",
    parameters: &[free("lag", "s", "the robot later than planned")],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["zone_blending"],
    inspect: "the tuning of the servos",
    experiment: ["", "the same program again, logged with `line` or `cmd`"],
    form: Form::Timing(Timing::Lag),
};

//! A wait that is not in the model.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Timing, free,
};

pub(in crate::arm::effects) const PROGRAM_WAIT: Effect = Effect {
    id: "program_wait",
    channel: Channel::Motion,
    scope: Scope::Robot,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "A wait that the model does not know",
    law: "wait between two movements",
    source: "docs/controller.md",
    parameters: &[free("wait", "s", "time more")],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["acceleration_limit"],
    inspect: "the signal or the device that the program waits for",
    experiment: ["", "the same program again, logged with `line` or `cmd`"],
    form: Form::Timing(Timing::Wait),
};

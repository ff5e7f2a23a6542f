//! Braking energy that is lost.

use crate::arm::effects::effect::{Acts, Channel, Effect, Form, Nature, Scope, Subject};

pub(in crate::arm::effects) const NO_REGENERATION: Effect = Effect {
    id: "no_regeneration",
    channel: Channel::Power,
    scope: Scope::Robot,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Braking energy that is lost",
    law: "P = max(P, 0)",
    source: "docs/energy.md",
    parameters: &[],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["copper_loss"],
    inspect: "braking resistor and link of the drives",
    experiment: ["", "the same program again, logged with its power"],
    form: Form::Model(|model, _, _| model.drive.regeneration = 0.0),
};

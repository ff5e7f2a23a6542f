//! Loss of inverter and cables.

use crate::arm::effects::effect::{Acts, Channel, Effect, Form, Nature, Scope, Subject, free};

pub(in crate::arm::effects) const INVERTER_LOSS: Effect = Effect {
    id: "inverter_loss",
    channel: Channel::Power,
    scope: Scope::Robot,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: None,
    title: "Loss of inverter and cables",
    law: "P = per_current·Σ|τ|/(n k_t)",
    source: "docs/energy.md",
    parameters: &[free("per_current", "W/A", "loss per current")],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["copper_loss", "base_load"],
    inspect: "drive unit and motor cables",
    experiment: ["", "the same program again, logged with its power"],
    form: Form::Elsewhere,
};

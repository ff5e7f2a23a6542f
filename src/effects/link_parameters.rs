//! Masses, centres and inertias of the links.

use super::effect::{Channel, Effect, Form, Of, every, free};

/// Masses, centres and inertias of the links.
pub(super) const LINK_PARAMETERS: Effect = Effect {
    id: "link_parameters",
    channel: Channel::Torque,
    of: Of::Joint,
    title: "Masses, centres and inertias of the links",
    law: "τ = Y(q, q̇, q̈)·Δπ",
    source: "docs/identification.md",
    parameters: &[free("mass", "kg", "mass more, by link; other base combinations by their names")],
    coordinates: &[],
    published: None,
    joints: every,
    brings: &[],
    confused: &["payload", "gravity_spring"],
    experiment: ["", "identify the robot"],
    form: Form::Elsewhere,
};

//! A force from outside.

use super::effect::{Channel, Effect, Form, Of, free};

/// A force from outside.
pub(super) const CONTACT: Effect = Effect {
    id: "contact",
    channel: Channel::Torque,
    of: Of::Robot,
    title: "A force from outside",
    law: "τ = Jᵀ·force from t_start_s to t_end_s",
    source: "rigid bodies: docs/architecture.md",
    parameters: &[
        free("force", "N", "size of the force"),
        free("t_start_s", "s", "from"),
        free("t_end_s", "s", "to"),
    ],
    coordinates: &[],
    published: None,
    joints: |_| vec![0],
    brings: &[],
    confused: &["brake_drag"],
    experiment: ["", "a dry run"],
    form: Form::Elsewhere,
};

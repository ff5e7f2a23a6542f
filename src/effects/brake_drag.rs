//! A holding brake that does not let go.

use crate::robot::LawState;

use super::effect::{Channel, Effect, Form, Of, Values, bounded, every, free, linear};

/// Drag of a brake.
pub(super) const BRAKE_DRAG: Effect = Effect {
    id: "brake_drag",
    channel: Channel::Torque,
    of: Of::Joint,
    title: "Drag of a brake",
    law: "τ = drag·s, from t_start_s to t_end_s where these are given",
    source: "ABB product manuals: brake release check",
    parameters: &[
        bounded("drag", "Nm", "friction more", [0.0, f64::INFINITY]),
        free("t_start_s", "s", "from"),
        free("t_end_s", "s", "to; 0 for the end"),
    ],
    coordinates: &[linear(|of| of.coulomb)],
    published: None,
    joints: every,
    brings: &[],
    confused: &["friction_level", "warm_up"],
    experiment: ["--variant friction", "one joint after the other"],
    form: Form::Law { dissipates: true, torque },
};

fn torque(state: &LawState, [drag, start, end, ..]: &Values) -> f64 {
    let within = *end <= *start || (*start..=*end).contains(&state.t);
    if within { drag * state.sense } else { 0.0 }
}

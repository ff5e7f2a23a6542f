//! A holding brake that does not release fully.

use crate::arm::robot::LawState;

use crate::arm::effects::effect::{
    Acts, Channel, Coordinate, Effect, Form, Nature, Role, Scope, Subject, Values, bounded, every,
    free, linear, shaped,
};
use crate::arm::effects::window::within;

pub(in crate::arm::effects) const BRAKE_DRAG: Effect = Effect {
    id: "brake_drag",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::InWindow,
    variable: None,
    title: "Drag of a brake",
    law: "τ = drag·s, from t_start_s to t_end_s where these are given",
    source: "ABB product manuals: brake release check",
    parameters: &[
        bounded("drag", "Nm", "friction more", [0.0, f64::INFINITY]),
        free("t_start_s", "s", "from"),
        free("t_end_s", "s", "to; 0 for the end"),
        bounded("period_s", "s", "time after which it comes again; 0: never", [0.0, f64::INFINITY]),
    ],
    coordinates: &[
        linear(|of| 0.5 * of.coulomb),
        Coordinate { role: Role::Choice(|_| vec![0.0]), usual: shaped },
        Coordinate { role: Role::Choice(|_| vec![0.0]), usual: shaped },
        Coordinate { role: Role::Choice(|_| vec![0.0]), usual: shaped },
    ],
    published: None,
    joints: every,
    brings: &[],
    confused: &["friction_level", "warm_up"],
    inspect: "the air gap and the voltage of the brake",
    experiment: ["--variant friction", "one joint after the other"],
    form: Form::Law { dissipates: true, torque },
};

fn torque(state: &LawState, [drag, start, end, period]: &Values) -> f64 {
    if *end <= *start || within(state.t, *start, *end, *period) { drag * state.sense } else { 0.0 }
}

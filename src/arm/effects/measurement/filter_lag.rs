//! Torques logged after a filter.

use crate::arm::effects::effect::{
    Acts, Channel, Coordinate, Effect, Form, Nature, Role, Scope, Subject, Variable, bounded,
    every, shape, shaped,
};
use crate::arm::effects::motion::Motion;
use crate::arm::effects::response::Response;

pub(in crate::arm::effects) const FILTER_LAG: Effect = Effect {
    id: "filter_lag",
    channel: Channel::Torque,
    scope: Scope::Robot,
    subject: Subject::Measurement,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::Reversal),
    title: "Lag of a filter",
    law: "lag·dτ/dt + τ_logged = τ",
    source: "docs/identification.md",
    parameters: &[
        bounded("lag", "s", "time constant", [0.0, 0.1]).everyday(0.004),
        bounded("only_joint", "1", "the only joint that has it; 0: all", [0.0, 7.0]),
    ],
    coordinates: &[
        shape(|_| vec![0.002, 0.004, 0.008, 0.016, 0.032]),
        Coordinate { role: Role::OnlyJoint, usual: shaped },
    ],
    published: None,
    joints: every,
    brings: &[],
    confused: &["time_delay", "elasticity"],
    inspect: "the filter of the logged signal",
    experiment: ["--harmonics 1,4,7,11", "a filter also takes amplitude"],
    form: Form::Series(added),
};

fn added(motion: &Motion<'_>, _: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    Response { delay: 0.0, lag: values[0] }.added(motion, values[1])
}

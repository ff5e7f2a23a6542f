//! Torques that are logged with a delay relative to positions.

use crate::arm::effects::effect::{
    Acts, Channel, Coordinate, Effect, Form, Nature, Role, Scope, Subject, Variable, bounded,
    every, shape, shaped,
};
use crate::arm::effects::motion::Motion;
use crate::arm::effects::response::Response;

pub(in crate::arm::effects) const TIME_DELAY: Effect = Effect {
    id: "time_delay",
    channel: Channel::Torque,
    scope: Scope::Robot,
    subject: Subject::Measurement,
    nature: Nature::Law,
    acts: Acts::Always,
    variable: Some(Variable::Reversal),
    title: "Delay",
    law: "τ = τ(t − delay), logged",
    source: "docs/identification.md",
    parameters: &[
        bounded("delay", "s", "torque later than position", [-0.05, 0.05]).everyday(0.004),
        bounded("only_joint", "1", "the only joint that has it; 0: all", [0.0, 7.0]),
    ],
    coordinates: &[
        shape(|_| vec![-0.016, -0.008, -0.004, -0.002, 0.002, 0.004, 0.008, 0.016]),
        Coordinate { role: Role::OnlyJoint, usual: shaped },
    ],
    published: None,
    joints: every,
    brings: &[],
    confused: &["filter_lag", "presliding", "backlash"],
    inspect: "the clocks of the logged signals",
    experiment: ["--harmonics 1,4,7,11", "a delay grows with the frequency"],
    form: Form::Series(added),
};

fn added(motion: &Motion<'_>, _: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    Response { delay: values[0], lag: 0.0 }.added(motion, values[1])
}

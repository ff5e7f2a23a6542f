//! Torques that are logged later than the positions.

use super::effect::{Channel, Coordinate, Effect, Form, Of, Role, bounded, every, shape, shaped};
use super::motion::Motion;

/// Delay.
pub(super) const TIME_DELAY: Effect = Effect {
    id: "time_delay",
    channel: Channel::Torque,
    of: Of::Robot,
    title: "Delay",
    law: "τ = τ(t − delay), logged",
    source: "docs/identification.md",
    parameters: &[
        bounded("delay", "s", "torque later than position", [-0.05, 0.05]),
        bounded("joint", "1", "the only joint that has it; 0: all", [0.0, 7.0]),
    ],
    coordinates: &[
        shape(|_| vec![-0.016, -0.008, -0.004, -0.002, 0.002, 0.004, 0.008, 0.016]),
        Coordinate { role: Role::Choice(|_| vec![0.0]), usual: shaped },
    ],
    published: None,
    joints: every,
    brings: &[],
    confused: &["filter_lag", "presliding", "backlash"],
    experiment: ["--harmonics 1,4,7,11", "a delay grows with the frequency"],
    form: Form::Series(added),
};

fn added(motion: &Motion<'_>, _: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let of =
        |tau: &Vec<f64>| motion.later(tau, values[0]).iter().zip(tau).map(|(a, b)| a - b).collect();
    let of_joint = |joint: &usize| values[1] == 0.0 || *joint as f64 + 1.0 == values[1];
    (0..motion.torque.len())
        .filter(of_joint)
        .map(|joint| (joint, of(&motion.torque[joint])))
        .collect()
}

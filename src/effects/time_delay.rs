//! Torques that are logged later than the positions.

use super::effect::{Channel, Effect, Form, Of, bounded, every, shape};
use super::motion::Motion;

/// Delay.
pub(super) const TIME_DELAY: Effect = Effect {
    id: "time_delay",
    channel: Channel::Torque,
    of: Of::Robot,
    title: "Delay",
    law: "τ = τ(t − delay), logged",
    source: "docs/identification.md",
    parameters: &[bounded("delay", "s", "torque later than position", [-0.05, 0.05])],
    coordinates: &[shape(|_| vec![-0.016, -0.008, -0.004, -0.002, 0.002, 0.004, 0.008, 0.016])],
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
    motion.torque.iter().map(of).enumerate().collect()
}

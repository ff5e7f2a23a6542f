//! Torques behind a filter.

use super::effect::{Channel, Effect, Form, Of, bounded, every, shape};
use super::motion::Motion;

/// Lag of a filter.
pub(super) const FILTER_LAG: Effect = Effect {
    id: "filter_lag",
    channel: Channel::Torque,
    of: Of::Robot,
    title: "Lag of a filter",
    law: "lag·dτ/dt + τ_logged = τ",
    source: "docs/identification.md",
    parameters: &[bounded("lag", "s", "time constant", [0.0, 0.1])],
    coordinates: &[shape(|_| vec![0.002, 0.004, 0.008, 0.016, 0.032])],
    published: None,
    joints: every,
    brings: &[],
    confused: &["time_delay", "elasticity"],
    experiment: ["--harmonics 1,4,7,11", "a filter also takes amplitude"],
    form: Form::Series(added),
};

/// Rows over which the beginning of an open motion settles, or rounds of a closed one.
const ROUNDS: usize = 2;

fn added(motion: &Motion<'_>, _: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    // Exact for a torque that is a line between rows.
    let ratio = motion.step() / values[0].max(1e-9);
    let kept = (-ratio).exp();
    let mean = (1.0 - kept) / ratio;
    let of = |tau: &Vec<f64>| -> Vec<f64> {
        let mut state = tau.first().copied().unwrap_or(0.0);
        let mut last = state;
        let mut out = vec![0.0; tau.len()];
        for _ in 0..if motion.closed { ROUNDS } else { 1 } {
            for (to, x) in out.iter_mut().zip(tau) {
                state = kept * state + (mean - kept) * last + (1.0 - mean) * x;
                last = *x;
                *to = state - x;
            }
        }
        out
    };
    motion.torque.iter().map(of).enumerate().collect()
}

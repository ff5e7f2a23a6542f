//! Torques behind a filter.

use super::effect::{Channel, Coordinate, Effect, Form, Of, Role, bounded, every, shape, shaped};
use super::motion::Motion;

/// Lag of a filter.
pub(super) const FILTER_LAG: Effect = Effect {
    id: "filter_lag",
    channel: Channel::Torque,
    of: Of::Robot,
    title: "Lag of a filter",
    law: "lag·dτ/dt + τ_logged = τ",
    source: "docs/identification.md",
    parameters: &[
        bounded("lag", "s", "time constant", [0.0, 0.1]),
        bounded("joint", "1", "the only joint that has it; 0: all", [0.0, 7.0]),
    ],
    coordinates: &[
        shape(|_| vec![0.002, 0.004, 0.008, 0.016, 0.032]),
        Coordinate { role: Role::Choice(|_| vec![0.0]), usual: shaped },
    ],
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
    let of = |tau: &Vec<f64>| -> Vec<f64> {
        lagged(motion, tau, values[0]).iter().zip(tau).map(|(late, x)| late - x).collect()
    };
    let of_joint = |joint: &usize| values[1] == 0.0 || *joint as f64 + 1.0 == values[1];
    (0..motion.torque.len())
        .filter(of_joint)
        .map(|joint| (joint, of(&motion.torque[joint])))
        .collect()
}

/// A series of a motion behind a pole with the time constant `lag` \[s\].
#[must_use]
pub fn lagged(motion: &Motion<'_>, x: &[f64], lag: f64) -> Vec<f64> {
    // Exact for a series that is a line between rows.
    let ratio = motion.step() / lag.max(1e-9);
    let kept = (-ratio).exp();
    let mean = (1.0 - kept) / ratio;
    let mut state = x.first().copied().unwrap_or(0.0);
    let mut last = state;
    let mut out = vec![0.0; x.len()];
    for _ in 0..if motion.closed { ROUNDS } else { 1 } {
        for (to, x) in out.iter_mut().zip(x) {
            state = kept * state + (mean - kept) * last + (1.0 - mean) * x;
            last = *x;
            *to = state;
        }
    }
    out
}

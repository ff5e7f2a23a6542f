//! Friction that builds up over a distance after each reversal.

use super::effect::{Channel, Effect, Form, Of, bounded, every, shape};
use super::motion::Motion;

/// Pre-sliding.
pub(super) const PRESLIDING: Effect = Effect {
    id: "presliding",
    channel: Channel::Torque,
    of: Of::Joint,
    title: "Pre-sliding",
    law: "dz/dq = (1 − s z)/distance, τ = coulomb·(z − s)",
    source: "P. Dahl, A solid friction model, 1968",
    parameters: &[bounded(
        "distance",
        "rad",
        "angle in which 1/e is left to build up",
        [1e-5, 0.2],
    )],
    coordinates: &[shape(|_| vec![0.001, 0.003, 0.008, 0.02])],
    published: None,
    joints: every,
    brings: &[],
    confused: &["stribeck", "backlash", "time_delay"],
    experiment: ["--variant friction", "reversals at two speeds: a distance is no time"],
    form: Form::Series(added),
};

fn added(motion: &Motion<'_>, joint: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let coulomb = motion.scale(joint).coulomb;
    let step = motion.step();
    let senses = &motion.senses[joint];
    let mut z = senses.first().copied().unwrap_or(0.0);
    let mut series = vec![0.0; motion.len()];
    // What was before the first row is known after one round.
    for _ in 0..if motion.closed { 2 } else { 1 } {
        for (row, to) in series.iter_mut().enumerate() {
            let rate = motion.rates[joint][row];
            let towards = if rate == 0.0 { z } else { rate.signum() };
            z = towards + (z - towards) * (-rate.abs() * step / values[0].max(1e-9)).exp();
            *to = if senses[row] == 0.0 { 0.0 } else { coulomb * (z - senses[row]) };
        }
    }
    motion.at_joints(joint, series)
}

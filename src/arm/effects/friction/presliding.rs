//! Friction that builds up over a distance after each reversal.

use crate::arm::effects::effect::{
    Acts, Channel, Effect, Form, Nature, Scope, Subject, Variable, bounded, every, shape,
};
use crate::arm::effects::motion::Motion;

pub(in crate::arm::effects) const PRESLIDING: Effect = Effect {
    id: "presliding",
    channel: Channel::Torque,
    scope: Scope::Joint,
    subject: Subject::Drive,
    nature: Nature::Law,
    acts: Acts::AfterReversals,
    variable: Some(Variable::Reversal),
    title: "Pre-sliding",
    law: "dz/dq = (1 − s z)/distance, τ = coulomb·(z − s)",
    source: "P. Dahl, A solid friction model, 1968",
    parameters: &[bounded(
        "distance",
        "rad",
        "angle in which 1/e is left to build up",
        [1e-5, 0.2],
    )
    .everyday(0.002)],
    coordinates: &[shape(|_| vec![0.001, 0.003, 0.008, 0.02])],
    published: None,
    joints: every,
    brings: &[],
    confused: &["stribeck", "backlash", "time_delay"],
    inspect: "seals and bearings",
    experiment: ["--variant friction", "reversals at two speeds: a distance is no time"],
    form: Form::Series(added),
};

fn added(motion: &Motion<'_>, joint: usize, values: &[f64]) -> Vec<(usize, Vec<f64>)> {
    let coulomb = motion.scale(joint).coulomb;
    let step = motion.step();
    let (senses, rates) = (&motion.senses[joint], &motion.rates[joint]);
    let mut z = senses.first().copied().unwrap_or(0.0);
    let mut series = vec![0.0; motion.rows()];
    // A second pass of a periodic motion determines the initial state.
    for _ in 0..if motion.closed { 2 } else { 1 } {
        let mut before = if motion.closed { rates.last() } else { rates.first() };
        for (row, to) in series.iter_mut().enumerate() {
            for (rate, path) in paths(before.copied().unwrap_or(0.0), rates[row], step) {
                let towards = if rate == 0.0 { z } else { rate.signum() };
                z = towards + (z - towards) * (-path / values[0].max(1e-9)).exp();
            }
            before = Some(&rates[row]);
            *to = if senses[row] == 0.0 { 0.0 } else { coulomb * (z - senses[row]) };
        }
    }
    motion.at_joints(joint, series)
}

/// Speeds and distances between two rows, for a speed that is linear between them.
fn paths(first: f64, last: f64, step: f64) -> [(f64, f64); 2] {
    if first * last >= 0.0 {
        let rate = if last == 0.0 { first } else { last };
        return [(rate, 0.5 * (first + last).abs() * step), (last, 0.0)];
    }
    let both = first.abs() + last.abs();
    [first, last].map(|rate| (rate, 0.5 * rate * rate / both * step))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The distance between two rows equals that of a finer subdivision.
    #[test]
    fn ways_do_not_depend_on_the_step() {
        for (first, last) in [(0.2, 0.5), (0.2, -0.5), (-0.1, 0.0), (0.0, 0.3)] {
            let totals =
                |count: usize| {
                    let at = |k: usize| first + (last - first) * k as f64 / count as f64;
                    let all = (0..count).flat_map(|k| paths(at(k), at(k + 1), 1.0 / count as f64));
                    all.fold([0.0; 2], |[back, on], (rate, path)| {
                        if rate < 0.0 { [back + path, on] } else { [back, on + path] }
                    })
                };
            let [one, many] = [totals(1), totals(1000)];
            for (one, many) in one.into_iter().zip(many) {
                assert!((one - many).abs() < 1e-9, "{first} {last}: {one} {many}");
            }
        }
    }
}

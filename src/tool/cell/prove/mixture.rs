//! Cycles on the wrong side: each side is then a mixture of the same two levels. A mixture with a share of
//! strangers on each side is compared with two plain levels by their likelihoods.

use super::doubt::Doubt;
use super::estimate::Estimate;

/// Twice the logarithm of the likelihoods' ratio from which on strangers are taken as seen: two shares,
/// which are 0 at the edge of their range.
const SEEN: f64 = 8.0;
/// The same where the sides hardly differ, so that nothing but the shape of the scatter speaks for two levels.
const SEEN_ALONE: f64 = 16.0;
/// Least distance of the levels, in their standard deviations.
const APART: f64 = 2.0;
/// Steps of the expectation maximisation.
const STEPS: usize = 200;
/// Fewest cycles.
const FEWEST: usize = 10;

struct Mixture {
    levels: [f64; 2],
    variance: f64,
    /// Share of strangers on each side.
    strangers: [f64; 2],
    likelihood: f64,
}

/// The doubt that strangers cast on a saving: they make it smaller than it is.
pub(super) fn swapped(of: &Estimate) -> Option<Doubt> {
    let saving = of.saving;
    let after = of.residual[1].iter().map(|y| y - saving).collect();
    let sides: [Vec<f64>; 2] = [of.residual[0].clone(), after];
    if sides.iter().any(|side| side.len() < FEWEST) {
        return None;
    }
    let n = sides.iter().map(Vec::len).sum::<usize>() as f64;
    let squares = of.residual.iter().flatten().map(|y| y * y).sum::<f64>();
    if squares <= 0.0 {
        return None;
    }
    let plain = -0.5 * n * (squares / n).ln() - 0.5 * n;
    let mut all: Vec<f64> = sides.iter().flatten().copied().collect();
    all.sort_by(f64::total_cmp);
    let quarter = all.len() / 4;
    let quarters = [all[all.len() - 1 - quarter], all[quarter]];
    let starts = [([0.0, -saving], 0.15), (quarters, 0.4), ([quarters[1], quarters[0]], 0.4)];
    let fits = starts.map(|(levels, share)| fit(&sides, levels, share, squares / n));
    let best = fits.into_iter().max_by(|a, b| a.likelihood.total_cmp(&b.likelihood))?;
    // The levels have no names: fewer strangers are more likely than more.
    let is_turned = best.strangers.iter().sum::<f64>() > 1.0;
    let strangers = best.strangers.map(|share| if is_turned { 1.0 - share } else { share });
    let distance = best.levels[0] - best.levels[1];
    // Half of the cycles on the wrong side leave no difference: its sign is not known then.
    let is_open = strangers.iter().sum::<f64>() > 0.8;
    let is_seen = 2.0 * (best.likelihood - plain) > if is_open { SEEN_ALONE } else { SEEN }
        && distance.abs() > APART * best.variance.sqrt()
        && distance.abs() > saving.abs();
    if !is_seen {
        return None;
    }
    let more = distance.abs() - saving.abs();
    let both = distance.abs() + saving.abs();
    let widens = match (saving > 0.0, is_open) {
        (_, true) => [both, both],
        (true, false) => [0.0, more],
        (false, false) => [more, 0.0],
    };
    Some(Doubt {
        name: "mixed sides",
        widens,
        withholds: false,
        text: format!(
            "both sides look like mixtures of two levels {:.1} % apart, with {:.0} % and {:.0} % of the cycles on \
             the wrong side: were cycles or logs swapped? The interval covers that; check which program ran when",
            100.0 * distance.abs(),
            100.0 * strangers[0],
            100.0 * strangers[1]
        ),
    })
}

/// Expectation maximisation.
fn fit(sides: &[Vec<f64>; 2], levels: [f64; 2], share: f64, variance: f64) -> Mixture {
    let n = sides.iter().map(Vec::len).sum::<usize>() as f64;
    let mut mixture = Mixture {
        levels,
        variance: 0.5 * variance,
        strangers: [share; 2],
        likelihood: f64::NEG_INFINITY,
    };
    // Levels that hardly scatter are single cycles, not a side.
    let least = 0.02 * variance;
    for _ in 0..STEPS {
        let (mut sums, mut counts, mut strangers) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        let mut weights: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
        let mut likelihood = 0.0;
        for side in 0..2 {
            for y in &sides[side] {
                let density = |level: usize| {
                    (-0.5 * (y - mixture.levels[level]).powi(2) / mixture.variance).exp()
                };
                let own = (1.0 - mixture.strangers[side]) * density(side);
                let other = mixture.strangers[side] * density(1 - side);
                let all = (own + other).max(1e-300);
                likelihood += all.ln() - 0.5 * mixture.variance.ln();
                let weight = other / all;
                weights[side].push(weight);
                strangers[side] += weight;
                sums[side] += (1.0 - weight) * y;
                counts[side] += 1.0 - weight;
                sums[1 - side] += weight * y;
                counts[1 - side] += weight;
            }
        }
        let is_done = likelihood - mixture.likelihood < 1e-9;
        mixture.likelihood = likelihood;
        if is_done {
            break;
        }
        for level in 0..2 {
            mixture.levels[level] = sums[level] / f64::max(counts[level], 1e-9);
        }
        let mut squares = 0.0;
        for side in 0..2 {
            for (y, weight) in sides[side].iter().zip(&weights[side]) {
                squares += (1.0 - weight) * (y - mixture.levels[side]).powi(2)
                    + weight * (y - mixture.levels[1 - side]).powi(2);
            }
            mixture.strangers[side] =
                (strangers[side] / sides[side].len() as f64).clamp(1e-6, 1.0 - 1e-6);
        }
        mixture.variance = (squares / n).max(least);
    }
    mixture
}

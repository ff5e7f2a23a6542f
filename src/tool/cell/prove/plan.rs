//! The power analysis: how many cycles show which saving.

use super::interval::REPEATS;

/// Sum of the quantiles of the normal distribution for a two-sided level of 5 % and a power of 80 %.
const QUANTILES: f64 = 1.96 + 0.8416;
/// Cycles that the estimate of the scatter costs (two-sample t test).
const SCATTER: f64 = 2.0;
/// Least part of an effect's square that is left for the scatter.
const LEAST: f64 = 0.1;
/// Fewest cycles of a side for which an interval can be given.
pub(super) const FEWEST: usize = 5;

/// Cycles of each side that show a saving (share), if the mean of n cycles has the variance `long_run` / n,
/// relative to the energy of a cycle.
pub(super) fn needed(effect: f64, long_run: f64) -> usize {
    let sides = 1.0 + (1.0 - effect).powi(2);
    // What the meter does not repeat, no number of cycles helps against.
    let left = (effect.powi(2) - (QUANTILES * REPEATS).powi(2)).max(LEAST * effect.powi(2));
    let n = QUANTILES.powi(2) * long_run * sides / left + SCATTER;
    (n.ceil() as usize).max(FEWEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smaller_effect_needs_more_cycles() {
        // σ = 3 %, effect 3 %: 2 · 2.8² plus the cost of the scatter.
        assert_eq!(needed(0.03, 9e-4), 18);
        assert!(needed(0.01, 9e-4) > 140);
        assert_eq!(needed(0.5, 1e-6), FEWEST);
    }
}

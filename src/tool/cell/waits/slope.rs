//! By how much what a wait is for comes later if the robot comes later.

use super::evidence::Evidence;
use super::samples::Candidate;

/// Half the quantile of χ² with one degree of freedom: 95 %.
const HALF_CHI2: f64 = 1.92;
/// Values that are tried.
const LOWEST: f64 = -0.5;
const STEP: f64 = 0.05;
const COUNT: usize = 41;

/// A slope b with its 95 % interval. The ends of the interval lie in −0.5 … 1.5: an interval as wide says
/// that the log does not tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// Seconds later for each second that the robot comes later.
    pub value: f64,
    /// See `value`.
    pub low: f64,
    /// See `value`.
    pub high: f64,
}

/// The slope of a wait after a reference.
pub(super) fn slope(evidence: &Evidence<'_>, candidate: &Candidate, most: f64) -> Slope {
    let grid: Vec<f64> = (0..COUNT).map(|k| LOWEST + STEP * k as f64).collect();
    let all: Vec<Vec<f64>> = grid.iter().map(|b| evidence.counts_from(candidate, *b)).collect();
    let total = |of: &[f64]| evidence.advantage(of, &all[COUNT / 2], f64::INFINITY);
    let totals: Vec<f64> = all.iter().map(|of| total(of)).collect();
    let best = (0..COUNT).max_by(|a, b| totals[*a].total_cmp(&totals[*b])).unwrap_or(COUNT / 2);
    let near = |k: &usize| evidence.advantage(&all[best], &all[*k], most) <= HALF_CHI2;
    // Half a step beyond the last value that is near.
    let low = (0..=best).rev().take_while(near).last().unwrap_or(best);
    let high = (best..COUNT).take_while(near).last().unwrap_or(best);
    Slope { value: grid[best], low: grid[low] - 0.5 * STEP, high: grid[high] + 0.5 * STEP }
}

//! Intervals by a studentised circular block bootstrap: blocks of successive cycles are drawn on each side,
//! and the whole estimate, adjustments included, is made again.

use super::blocks::{block_length, drawn_variance, long_run_variances};
use super::estimate::{Estimate, Point, Prior, estimate};

/// Number of resamples, and their seed: the same logs give the same interval.
const RESAMPLES: usize = 1999;
const SEED: u64 = 20_261_129;
/// Levels of the interval, and of the bound of the cycle time.
const LEVEL: f64 = 0.025;
const BOUND: f64 = 0.05;
/// Quantiles of the normal distribution at these levels.
pub(super) const NORMAL: f64 = 1.96;
/// How Student's quantile exceeds the normal one, times the degrees of freedom.
const STUDENT: f64 = 2.4;
/// What no meter repeats better than from one period to another, share.
pub(super) const REPEATS: f64 = 0.002;
const NORMAL_BOUND: f64 = 1.645;

/// What is uncertain about an estimate.
#[derive(Clone, Debug)]
pub(super) struct Uncertainty {
    /// 95 % interval of the saving.
    pub(super) interval: [f64; 2],
    /// Standard error of the saving.
    pub(super) error: f64,
    /// Standard error of the difference of the durations, s.
    pub(super) error_s: f64,
    /// Upper 95 % bound of the difference of the durations, s.
    pub(super) longer: f64,
    /// Lengths of the blocks of both sides.
    pub(super) blocks: [usize; 2],
    /// n times the variance of the mean of both sides.
    pub(super) long_run: [f64; 2],
}

/// The uncertainty of an estimate.
pub(super) fn uncertainty(
    sides: [&[Point]; 2],
    strata: usize,
    prior: Prior,
    of: &Estimate,
) -> Uncertainty {
    let blocks = [0, 1]
        .map(|side| block_length(&of.influence[side]).max(block_length(&of.influence_s[side])));
    let sizes = sides.map(|points| points.len() as f64);
    let variances =
        |influence: &[Vec<f64>; 2]| long_run_variances([&influence[0], &influence[1]], blocks);
    let long_run = variances(&of.influence);
    let of_sides = |long_run: [f64; 2]| long_run[0] / sizes[0] + long_run[1] / sizes[1];
    let (of_mean, of_time) = (of_sides(long_run), of_sides(variances(&of.influence_s)));
    // The slopes have the memory of the cycles, too.
    let memory = memory(of, &long_run);
    let error = (of_mean + memory * of.slope_variance).sqrt();
    let error_s = of_time.sqrt();
    let longer = of.duration[1] - of.duration[0];

    let mut random = fastrand::Rng::with_seed(SEED);
    let (mut savings, mut times) = (Vec::with_capacity(RESAMPLES), Vec::with_capacity(RESAMPLES));
    let mut drawn = [0, 1].map(|side| Vec::with_capacity(sides[side].len()));
    for _ in 0..RESAMPLES {
        for side in 0..2 {
            draw(sides[side], blocks[side], &mut random, &mut drawn[side]);
        }
        let Some(again) = estimate([&drawn[0], &drawn[1]], strata, prior) else { continue };
        let variance = |influence: &[Vec<f64>; 2]| -> f64 {
            (0..2).map(|side| drawn_variance(&influence[side], blocks[side]) / sizes[side]).sum()
        };
        let error = (variance(&again.influence) + memory * again.slope_variance).sqrt();
        if error > 0.0 {
            savings.push((again.saving - of.saving) / error);
        }
        let error_s = variance(&again.influence_s).sqrt();
        if error_s > 0.0 {
            times.push((again.duration[1] - again.duration[0] - longer) / error_s);
        }
    }
    let plain = |x: &Vec<f64>| x.iter().map(|x| x * x).sum::<f64>();
    let plain: f64 = of.influence.iter().map(plain).sum();
    let all: f64 = (0..2).map(|side| sizes[side] * long_run[side]).sum();
    let freedom = ((sizes[0] + sizes[1]) * plain / all.max(f64::MIN_POSITIVE) - 2.0).max(2.0);
    let least = NORMAL + STUDENT / freedom;
    let error = error.hypot(REPEATS);
    let [low, high] = [1.0 - LEVEL, LEVEL].map(|level| quantile(&mut savings, level));
    // Tails of the resamples that are lighter than normal ones come from their small number of values.
    let low = low.unwrap_or(least).max(least);
    let high = high.unwrap_or(-least).min(-least);
    let bound = quantile(&mut times, BOUND).unwrap_or(-NORMAL_BOUND).min(-NORMAL_BOUND);
    Uncertainty {
        interval: [of.saving - low * error, of.saving - high * error],
        error,
        error_s,
        longer: longer - bound * error_s,
        blocks,
        long_run,
    }
}

/// How much more the mean varies than without memory.
fn memory(of: &Estimate, long_run: &[f64; 2]) -> f64 {
    let plain = |x: &Vec<f64>| x.iter().map(|x| x * x).sum::<f64>() / x.len().max(1) as f64;
    let plain: f64 = of.influence.iter().map(plain).sum();
    if plain > 0.0 { (long_run.iter().sum::<f64>() / plain).max(1.0) } else { 1.0 }
}

/// Draws circular blocks until there are as many cycles as there were.
fn draw(points: &[Point], length: usize, random: &mut fastrand::Rng, drawn: &mut Vec<Point>) {
    drawn.clear();
    while drawn.len() < points.len() {
        let begin = random.usize(0..points.len());
        let count = length.min(points.len() - drawn.len());
        drawn.extend((0..count).map(|i| points[(begin + i) % points.len()]));
    }
}

/// The value at this share of the values.
fn quantile(values: &mut [f64], share: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let place = (share * (values.len() + 1) as f64).round() as usize;
    values.get(place.clamp(1, values.len().max(1)) - 1).copied()
}

//! Cycles that a stop, an abort or a broken reading has spoilt. The rule is one for both sides, and wide.

use super::unit::{LeftOut, Period, Unit};

/// Robust standard deviations from the median within which a cycle is kept in any case.
const DEVIATIONS: f64 = 6.0;
/// Share of the median within which a duration is kept in any case.
const DURATION: f64 = 0.3;
/// The same for energies.
const ENERGY: f64 = 0.5;
/// The median absolute deviation of a normal distribution, inverse.
const NORMAL: f64 = 1.4826;

/// Whether each unit is kept, for both sides, and what was left out.
pub(super) fn kept(
    sides: &[Vec<(usize, Unit)>; 2],
    strata: usize,
) -> ([Vec<bool>; 2], Vec<LeftOut>) {
    let mut keep = [0, 1].map(|side| vec![true; sides[side].len()]);
    let mut counts = [[0; 3]; 2];
    for stratum in 0..strata {
        let of = |side: usize, value: fn(&Unit) -> f64| -> Vec<f64> {
            let units = sides[side].iter().filter(|(own, _)| *own == stratum);
            units.map(|(_, unit)| value(unit)).collect()
        };
        // Both sides have one range of durations, but a retrofit changes the energy. Beside waits of any length
        // a stop shows only in the time without them.
        let times: [fn(&Unit) -> f64; 2] =
            [|unit| unit.duration_s, |unit| unit.duration_s - unit.rest_s];
        let ranges = times.map(|time| {
            let both: Vec<f64> = [0, 1].iter().flat_map(|side| of(*side, time)).collect();
            range(&both, DURATION)
        });
        for side in 0..2 {
            let energies = range(&of(side, |unit| unit.energy_j), ENERGY);
            for (keep, (_, unit)) in
                keep[side].iter_mut().zip(&sides[side]).filter(|(_, (own, _))| *own == stratum)
            {
                let is = |outside: fn(f64, [f64; 2]) -> bool| {
                    times.iter().zip(ranges).any(|(time, range)| outside(time(unit), range))
                };
                let why = if is(|time, range| time > range[1]) {
                    0
                } else if is(|time, range| time < range[0]) {
                    1
                } else if !(energies[0]..=energies[1]).contains(&unit.energy_j) {
                    2
                } else {
                    continue;
                };
                counts[side][why] += 1;
                *keep = false;
            }
        }
    }
    let reasons = [
        "stopped on the way: far longer than others of their kind",
        "ended early: far shorter than others of their kind",
        "far from the energy of all others of their kind",
    ];
    let mut left_out = Vec::new();
    for (period, counts) in [Period::Before, Period::After].into_iter().zip(counts) {
        for (why, count) in reasons.iter().zip(counts).filter(|(_, count)| *count > 0) {
            left_out.push(LeftOut { period, count, why: (*why).to_owned() });
        }
    }
    (keep, left_out)
}

/// The values that are kept.
fn range(values: &[f64], share: f64) -> [f64; 2] {
    let middle = median(values);
    let deviations: Vec<f64> = values.iter().map(|x| (x - middle).abs()).collect();
    let width = (DEVIATIONS * NORMAL * median(&deviations)).max(share * middle.abs());
    [middle - width, middle + width]
}

/// Root of the sum of squares about the mean.
pub(super) fn deviation(x: &[f64]) -> f64 {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    x.iter().map(|x| (x - mean).powi(2)).sum::<f64>().sqrt()
}

/// The median; 0 without values.
pub(super) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    match n {
        0 => 0.0,
        _ => 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]),
    }
}

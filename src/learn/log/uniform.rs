//! Samples at equal intervals.

use std::ops::Range;

/// An interval longer than the median by this factor ends a section.
const GAP: f64 = 3.5;
/// Largest deviation of a sample from the grid, as a share of the interval.
const JITTER: f64 = 0.02;
/// An interval longer than the median by this factor lacks a sample, even with an uneven clock.
const LOSES: f64 = 1.75;
/// Largest distance, in intervals, of a grid point from a sample; else it counts as lost.
const LOST: f64 = 0.5;

/// Samples of several series at equal intervals, without a gap.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Time of the first sample \[s\].
    pub start: f64,
    /// Interval \[s\].
    pub step: f64,
    /// The series, all of the same length.
    pub series: Vec<Vec<f64>>,
    /// Samples that the log lacks; their values are interpolated.
    pub lost: Vec<usize>,
}

impl Section {
    /// Number of samples.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.series.first().map_or(0, Vec::len)
    }

    /// Time of a sample \[s\].
    #[must_use]
    pub fn time(&self, index: usize) -> f64 {
        self.start + self.step * index as f64
    }
}

/// The median interval of ascending times \[s\]; 0 for fewer than two.
#[must_use]
pub fn median_step(t: &[f64]) -> f64 {
    quantile(t.windows(2).map(|pair| pair[1] - pair[0]), 0.5)
}

/// The value at this share of the sorted values; 0 without any.
#[must_use]
pub fn quantile(values: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get((share * sorted.len() as f64) as usize).copied().unwrap_or(0.0)
}

/// The least and the largest value.
pub(super) fn extremes(x: &[f64]) -> [f64; 2] {
    x.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)])
}

/// The difference of the largest and the smallest value.
#[must_use]
pub fn range(x: &[f64]) -> f64 {
    let [low, high] = extremes(x);
    high - low
}

/// The series at equal intervals: unchanged for even times `t` (ascending, s), else by cubic
/// interpolation of four samples. A gap begins a new section.
#[must_use]
pub fn sections(t: &[f64], series: &[&[f64]]) -> Vec<Section> {
    let part = |rows: Range<usize>| {
        let series: Vec<&[f64]> = series.iter().map(|x| &x[rows.clone()]).collect();
        section(&t[rows], &series)
    };
    between_gaps(t, GAP).into_iter().map(part).collect()
}

/// The rows between gaps: intervals longer than `gap` times the median one.
pub(super) fn between_gaps(t: &[f64], gap: f64) -> Vec<Range<usize>> {
    let longest = gap * median_step(t);
    let mut sections = Vec::new();
    let mut begin = 0;
    for end in 1..=t.len() {
        if end == t.len() || t[end] - t[end - 1] > longest {
            sections.push(begin..end);
            begin = end;
        }
    }
    sections
}

fn section(t: &[f64], series: &[&[f64]]) -> Section {
    let start = t.first().copied().unwrap_or(0.0);
    let duration = t.last().map_or(0.0, |last| last - start);
    let usual = median_step(t);
    let intervals = if usual > 0.0 { (duration / usual).round().max(1.0) } else { 1.0 };
    let step = if duration > 0.0 { duration / intervals } else { 1.0 };
    let count = if duration > 0.0 { intervals as usize + 1 } else { t.len().min(1) };
    let on_grid = |(i, t): (usize, &f64)| (t - start - step * i as f64).abs() <= JITTER * step;
    let even = t.len() == count && t.iter().enumerate().all(on_grid);
    let as_logged = || series.iter().map(|x| x.to_vec()).collect();
    if even {
        return Section { start, step, series: as_logged(), lost: Vec::new() };
    }
    let between: Vec<Vec<f64>> =
        series.iter().map(|x| interpolated(t, x, start, step, count)).collect();
    let is_whole = t.windows(2).all(|pair| pair[1] - pair[0] < LOSES * usual);
    if is_whole && is_clock_uneven(series, &between) {
        let step = duration / (t.len() - 1).max(1) as f64;
        return Section { start, step, series: as_logged(), lost: Vec::new() };
    }
    let mut lost = Vec::new();
    let mut after = 0;
    for k in 0..count {
        let at = start + step * k as f64;
        while after < t.len() && t[after] < at - LOST * step {
            after += 1;
        }
        if t.get(after).is_none_or(|t| *t > at + LOST * step) {
            lost.push(k);
        }
    }
    Section { start, step, series: between, lost }
}

/// Whether only the logged times are uneven: then the samples as logged are smoother than
/// interpolated ones.
fn is_clock_uneven(series: &[&[f64]], between: &[Vec<f64>]) -> bool {
    let odds = |(logged, between): (&&[f64], &Vec<f64>)| {
        let [logged, between] = [logged, between.as_slice()].map(roughness);
        if logged > 0.0 && between > 0.0 { (logged / between).ln() } else { 0.0 }
    };
    series.iter().zip(between).map(odds).sum::<f64>() < 0.0
}

/// Mean square of fourth differences, which are mainly noise.
fn roughness(x: &[f64]) -> f64 {
    let squares =
        x.windows(5).map(|x| (x[0] - 4.0 * x[1] + 6.0 * x[2] - 4.0 * x[3] + x[4]).powi(2));
    squares.sum::<f64>() / x.len() as f64
}

/// `x` interpolated at `count` times from `start` on.
#[must_use]
pub fn interpolated(t: &[f64], x: &[f64], start: f64, step: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| interpolated_at(t, x, start + step * k as f64)).collect()
}

/// `x` interpolated at a time.
pub(super) fn interpolated_at(t: &[f64], x: &[f64], at: f64) -> f64 {
    // Two samples before and two after, fewer at the ends.
    let width = t.len().min(4);
    let after = t.partition_point(|t| *t < at);
    let first = after.saturating_sub(2).min(t.len() - width);
    lagrange(&t[first..first + width], &x[first..first + width], at)
}

/// The value at `at` of the polynomial through the points.
fn lagrange(t: &[f64], x: &[f64], at: f64) -> f64 {
    let weight = |i: usize| {
        let others = t.iter().enumerate().filter(|(k, _)| *k != i);
        others.map(|(_, other)| (at - other) / (t[i] - other)).product::<f64>()
    };
    x.iter().enumerate().map(|(i, x)| x * weight(i)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding error of a cubic polynomial.
    const EXACT: f64 = 1e-9;

    #[test]
    fn uneven_samples_of_a_cubic_become_even_ones_of_it() {
        let cubic = |t: f64| 1.0 + 2.0 * t - 3.0 * t * t + 0.5 * t * t * t;
        let mut t: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
        for (i, t) in t.iter_mut().enumerate() {
            *t += 0.003 * (1.7 * i as f64).sin();
        }
        t.remove(100);
        let x: Vec<f64> = t.iter().map(|t| cubic(*t)).collect();
        let found = sections(&t, &[&x]);
        assert_eq!(found.len(), 1);
        for (i, x) in found[0].series[0].iter().enumerate() {
            assert!((x - cubic(found[0].time(i))).abs() < EXACT);
        }
    }

    #[test]
    fn even_samples_of_an_uneven_clock_stay_and_uneven_ones_do_not() {
        let wave = |t: f64| (3.0 * t).sin();
        let even: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
        let uneven: Vec<f64> =
            (0..200).map(|i| 0.01 * f64::from(i) + 0.003 * (1.7 * f64::from(i)).sin()).collect();
        let [of_even, of_uneven] =
            [&even, &uneven].map(|t| -> Vec<f64> { t.iter().map(|t| wave(*t)).collect() });
        assert_eq!(sections(&uneven, &[&of_even])[0].series[0], of_even);
        assert_ne!(sections(&uneven, &[&of_uneven])[0].series[0], of_uneven);
        // With missing samples, the rows are not evenly spaced.
        let keep = |x: &[f64]| -> Vec<f64> {
            x.iter().enumerate().filter(|(k, _)| k % 40 != 20).map(|(_, x)| *x).collect()
        };
        let [t, kept] = [&uneven, &of_even].map(|x| keep(x));
        assert_ne!(sections(&t, &[&kept])[0].series[0], kept);
    }

    #[test]
    fn samples_that_are_missing_are_lost() {
        let t: Vec<f64> =
            (0..50).filter(|i| ![7, 20, 21].contains(i)).map(|i| 0.01 * f64::from(i)).collect();
        assert_eq!(sections(&t, &[&t])[0].lost, [7, 20, 21]);
    }

    #[test]
    fn a_gap_parts_the_sections_and_even_samples_stay() {
        let t: Vec<f64> =
            (0..60).map(|i| 0.5 * f64::from(i) + if i < 40 { 0.0 } else { 7.0 }).collect();
        let x: Vec<f64> = t.iter().map(|t| (13.0 * t).sin()).collect();
        let found = sections(&t, &[&x]);
        assert_eq!(found.iter().map(Section::samples).collect::<Vec<_>>(), [40, 20]);
        assert_eq!(found[0].series[0], x[..40]);
    }
}

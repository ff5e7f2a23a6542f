//! Cycles in the power alone: the lag at which it repeats, then the most distinctive part of a cycle
//! wherever it is found again.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::outliers::{deviation, median};
use super::series::Series;

/// Most points of the search.
const GRID: f64 = 60_000.0;
/// Least correlation of the power with itself one cycle later.
const REPEATS: f64 = 0.3;
/// Lags whose correlation is nearly the largest come first, the shortest of them before its multiples; then as
/// many others.
const NEARLY: f64 = 0.85;
const CANDIDATES: usize = 40;
/// Shortest period, in points.
const SHORTEST: usize = 20;
/// Part of the cycle that is found again, and its least correlation.
const PART: usize = 5;
const SAME: f64 = 0.75;
/// Cycles resemble each other if this share of the time is in cycles whose duration is this near to the median
/// and whose course at these points is the same. A longer cycle counts as this many of them.
const ALIKE: f64 = 0.8;
const DURATION: f64 = 0.3;
const POINTS: usize = 16;
const STOP: f64 = 3.0;
/// Least distance of two starts, as a share of the period.
const APART: f64 = 0.6;

/// The starts of the cycles, s; none if the power does not repeat.
pub(super) fn starts(series: &Series) -> Vec<f64> {
    let [first, last] = series.range();
    let step = series.step.max((last - first) / GRID);
    if step <= 0.0 {
        return Vec::new();
    }
    let count = ((last - first) / step) as usize;
    let at = |i: usize| first + step * i as f64;
    let x: Vec<f64> = (0..count).map(|i| series.mean(at(i), at(i + 1))).collect();
    let mut found = periods(&x).into_iter().map(|period| cycles(&x, period));
    let found = found.find(|found| is_one_work(&x, found)).unwrap_or_default();
    found.into_iter().map(|(place, shift)| at(place) + step * shift).collect()
}

/// Cycles of about this period: where the most distinctive part of one is found again.
fn cycles(x: &[f64], period: usize) -> Vec<(usize, f64)> {
    let length = (period / PART).max(4);
    let Some(from) = distinctive(x, period, length) else { return Vec::new() };
    let mut template = x[from..from + length].to_vec();
    let mut found = matches(x, &template, period);
    // The mean of what was found is a better sample than the first one.
    for k in 0..length {
        let sum: f64 = found.iter().map(|at| x[at.0 + k]).sum();
        template[k] = sum / found.len().max(1) as f64;
    }
    if found.len() > 1 {
        found = matches(x, &template, period);
    }
    found
}

/// Whether cycles resemble each other, in duration and course: a movement that a cycle repeats does not, since
/// the rest of the cycle comes between. Counted by time, in which a stop is no more than a few cycles.
fn is_one_work(x: &[f64], found: &[(usize, f64)]) -> bool {
    let spans: Vec<&[f64]> = found.windows(2).map(|pair| &x[pair[0].0..pair[1].0]).collect();
    let lengths: Vec<f64> = spans.iter().map(|span| span.len() as f64).collect();
    let usual = median(&lengths);
    let courses: Vec<Vec<f64>> = spans.iter().map(|span| course(span)).collect();
    let middle: Vec<f64> = (0..POINTS)
        .map(|point| median(&courses.iter().map(|course| course[point]).collect::<Vec<f64>>()))
        .collect();
    let (mut alike, mut all) = (0.0, 0.0);
    for (length, course) in lengths.iter().zip(&courses) {
        let time = length.min(STOP * usual);
        all += time;
        if (length - usual).abs() <= DURATION * usual && correlation(course, &middle) >= SAME {
            alike += time;
        }
    }
    alike > 0.0 && alike >= ALIKE * all
}

/// The course of a cycle at equal distances.
fn course(span: &[f64]) -> Vec<f64> {
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let at = |point: usize| point * span.len() / POINTS;
    (0..POINTS).map(|point| mean(&span[at(point)..at(point + 1).max(at(point) + 1)])).collect()
}

/// Periods in points, the likeliest first.
fn periods(x: &[f64]) -> Vec<usize> {
    let n = x.len();
    let mean = x.iter().sum::<f64>() / n.max(1) as f64;
    let size = (2 * n).next_power_of_two();
    let mut values = vec![Complex::new(0.0, 0.0); size];
    for (value, x) in values.iter_mut().zip(x) {
        value.re = x - mean;
    }
    let mut planner = FftPlanner::new();
    planner.plan_fft_forward(size).process(&mut values);
    for value in &mut values {
        *value = Complex::new(value.norm_sqr(), 0.0);
    }
    planner.plan_fft_inverse(size).process(&mut values);
    let zero = values.first().map_or(0.0, |value| value.re) / n.max(1) as f64;
    let r = |lag: usize| values[lag].re / ((n - lag) as f64 * zero);
    let below = (1..n / 2).find(|lag| r(*lag) < 0.0);
    let Some(below) = below.filter(|_| zero > 0.0) else { return Vec::new() };
    let mut peaks: Vec<usize> = (below.max(SHORTEST)..(n / 2).saturating_sub(1))
        .filter(|lag| r(*lag) >= r(lag - 1) && r(*lag) > r(lag + 1) && r(*lag) > REPEATS)
        .collect();
    peaks.sort_by(|a, b| r(*b).total_cmp(&r(*a)));
    let most = peaks.first().map_or(0.0, |lag| r(*lag));
    peaks.truncate(CANDIDATES);
    peaks.sort_by_key(|lag| (r(*lag) < NEARLY * most, *lag));
    peaks
}

/// Start of the part of the second period that varies most and is least like the rest.
fn distinctive(x: &[f64], period: usize, length: usize) -> Option<usize> {
    let places = (period / 2..period + period / 2).step_by((length / 3).max(1));
    let places = places.filter(|from| from + length + period <= x.len());
    let score = |from: usize| {
        let part = &x[from..from + length];
        let others = (from + 3 * period / 10..from + 7 * period / 10).step_by((length / 8).max(1));
        let others = others.filter(|other| other + length <= x.len());
        let alike = others.map(|other| correlation(part, &x[other..other + length]));
        deviation(part) * (1.0 - alike.fold(0.0, f64::max))
    };
    places.max_by(|a, b| score(*a).total_cmp(&score(*b)))
}

/// Where the template is found: point, and shift from it in points.
fn matches(x: &[f64], template: &[f64], period: usize) -> Vec<(usize, f64)> {
    let fits: Vec<f64> =
        x.windows(template.len()).map(|part| correlation(part, template)).collect();
    let mut best: Vec<usize> = (0..fits.len()).filter(|i| fits[*i] >= SAME).collect();
    best.sort_by(|a, b| fits[*b].total_cmp(&fits[*a]).then(a.cmp(b)));
    let apart = (APART * period as f64) as usize;
    let mut taken = vec![false; fits.len()];
    let mut found = Vec::new();
    for place in best {
        if taken[place] {
            continue;
        }
        let from = place.saturating_sub(apart);
        let to = (place + apart).min(taken.len());
        taken[from..to].fill(true);
        let shift = match (place.checked_sub(1).map(|i| fits[i]), fits.get(place + 1)) {
            (Some(a), Some(b)) if a + b < 2.0 * fits[place] => {
                (0.5 * (a - b) / (a + b - 2.0 * fits[place])).clamp(-0.5, 0.5)
            }
            _ => 0.0,
        };
        found.push((place, shift));
    }
    found.sort_by_key(|(place, _)| *place);
    found
}

/// Correlation of two series; 0 where one is constant.
pub(super) fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len() as f64;
    let [ma, mb] = [a, b].map(|x| x.iter().sum::<f64>() / n);
    let ab: f64 = a.iter().zip(b).map(|(a, b)| (a - ma) * (b - mb)).sum();
    let scale = deviation(a) * deviation(b);
    if scale > 0.0 { ab / scale } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cycles_of_different_length_are_found() {
        let mut random = fastrand::Rng::with_seed(3);
        let (mut t, mut power, mut begins, mut now) = (Vec::new(), Vec::new(), Vec::new(), 0.0);
        for _ in 0..20 {
            begins.push(now);
            let wait = 2.0 + 0.5 * random.f64();
            let until = now + 6.0 + wait;
            let mut at = now;
            while at < until {
                let p = at - now;
                let work = if p < 6.0 {
                    400.0 + 300.0 * (2.1 * p).sin() + 200.0 * (5.0 * p).sin()
                } else {
                    0.0
                };
                t.push(at);
                power.push(300.0 + work + 10.0 * random.f64());
                at += 0.02;
            }
            now = until;
        }
        let found = starts(&Series::new(t, power, false));
        assert!(found.len() >= 18, "{found:?}");
        // The part may end before the wait or begin in it.
        let last = |start: &f64| begins.iter().rev().find(|begin| **begin <= *start).copied();
        let next = |start: &f64| begins.iter().find(|begin| **begin > *start).copied();
        let spread = |to: &dyn Fn(&f64) -> Option<f64>| {
            let off: Vec<f64> = found.iter().filter_map(|start| Some(to(start)? - start)).collect();
            off.iter().fold(f64::MIN, |a, b| a.max(*b))
                - off.iter().fold(f64::MAX, |a, b| a.min(*b))
        };
        assert!(spread(&last).min(spread(&next)) < 0.06, "{} {}", spread(&last), spread(&next));
    }

    #[test]
    fn noise_does_not_repeat() {
        let mut random = fastrand::Rng::with_seed(4);
        let t: Vec<f64> = (0..4000).map(|i| 0.01 * f64::from(i)).collect();
        let power = t.iter().map(|_| 300.0 + random.f64()).collect();
        assert!(starts(&Series::new(t, power, false)).is_empty());
    }
}

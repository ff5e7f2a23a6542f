//! Repetitions of a motion: where they are, their mean, their noise.
//!
//! The positions of a repeated motion are a Fourier series, fitted by least squares and
//! differentiated analytically; torques are averaged over the repetitions, whose spread
//! tells the noise (J. Swevers, C. Ganseman, D. Tükel, J. De Schutter, H. Van Brussel,
//! "Optimal robot excitation and identification", IEEE T-RA 13, 1997).

use std::f64::consts::TAU;

use super::differentiate::derivatives;
use super::uniform::Section;

/// Samples at which repetitions are compared, for the search.
const COMPARED: usize = 3000;
/// Share of a joint's range by which repetitions may differ, and before the period is known
/// to a sample.
const SAME: f64 = 0.01;
const NEARLY: f64 = 0.03;
/// Share by which the motion has to differ in between.
const DIFFERENT: f64 = 0.06;
/// The part of the moving time that has to come back: a log has ways into the motion and out
/// of it, too.
const PART: f64 = 0.35;
/// Share of the fastest step below which nothing moves.
const RESTING: f64 = 0.01;
/// Shortest period, in samples.
const SHORTEST: usize = 20;
/// Harmonics of the series at most.
const HARMONICS: usize = 240;
/// Share of these from which on a series has no end.
const ENDLESS: f64 = 0.9;
/// Frequencies at which noise is looked at.
const IN_TAIL: usize = 60;
/// A harmonic counts where its power is this many times what noise would give it.
const ABOVE_NOISE: f64 = 16.0;

/// Repetitions in evenly sampled series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periods {
    /// Duration of one \[s\].
    pub period: f64,
    /// First sample of the first.
    pub first: usize,
    /// Number of whole ones.
    pub count: usize,
}

/// The mean of repetitions.
#[derive(Clone, Debug, PartialEq)]
pub struct Averaged {
    /// Interval of the samples \[s\].
    pub step: f64,
    /// Harmonics of the series of the positions.
    pub harmonics: usize,
    /// Positions, rates and accelerations of each joint over one period.
    pub motion: [Vec<Vec<f64>>; 3],
    /// The mean of the other series over one period.
    pub mean: Vec<Vec<f64>>,
    /// How each repetition of these differs from the mean: by series, by repetition.
    pub spread: Vec<Vec<Vec<f64>>>,
}

/// The repetitions of `q`, which is sampled evenly; `None` where fewer than two are found.
/// `known` is the period, where it is known \[s\].
#[must_use]
pub fn find_periods(q: &[&[f64]], step: f64, known: Option<f64>) -> Option<Periods> {
    let n = q.first()?.len();
    let period = known.or_else(|| search(q, step))?;
    let lag = period / step;
    if !(lag >= SHORTEST as f64 && 2.0 * lag <= n as f64 + 0.5) {
        return None;
    }
    let (first, length) = longest_run(q, lag)?;
    // The last sample of the last period is the one before its end.
    let count = ((length as f64 + lag) / lag + 1e-6).floor() as usize;
    (count >= 2).then_some(Periods { period, first, count })
}

/// The lag at which the motion comes back \[s\].
fn search(q: &[&[f64]], step: f64) -> Option<f64> {
    let n = q[0].len();
    let every = n.div_ceil(COMPARED).max(1);
    let thin: Vec<Vec<f64>> =
        q.iter().map(|x| x.iter().step_by(every).copied().collect()).collect();
    let miss = Misses::of(&thin)?;
    let mut apart = false;
    let mut best: Option<(usize, f64)> = None;
    for lag in 1..=thin[0].len() / 2 {
        let value = miss.at(lag);
        apart |= value > DIFFERENT;
        if !apart || value > NEARLY {
            if best.is_some() {
                break;
            }
            continue;
        }
        if best.is_none_or(|(_, least)| value < least) {
            best = Some((lag, value));
        }
    }
    let (lag, _) = best?;
    // At the full rate, around what was found, and between samples by a parabola.
    let whole: Vec<Vec<f64>> = q.iter().map(|x| x.to_vec()).collect();
    let miss = Misses::of(&whole)?;
    let around = (lag * every).saturating_sub(2 * every).max(2)..=(lag + 2) * every;
    let (lag, least) = around
        .filter(|lag| 2 * lag <= n)
        .map(|lag| (lag, miss.at(lag)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    if least > SAME {
        return None;
    }
    let (before, after) = (miss.at(lag - 1).powi(2), miss.at(lag + 1).powi(2));
    let bend = before + after - 2.0 * least * least;
    let shift = if bend > 0.0 { 0.5 * (before - after) / bend } else { 0.0 };
    // Sampling at a whole number of samples per period is the rule.
    let shift = if shift.abs() < 0.05 { 0.0 } else { shift };
    Some((lag as f64 + shift.clamp(-0.5, 0.5)) * step)
}

/// How much a motion misses itself some time later, while it moves.
struct Misses<'a> {
    /// The moving joints, each with its range.
    joints: Vec<(&'a [f64], f64)>,
    /// Samples at which any of them moves.
    moving: Vec<usize>,
}

impl Misses<'_> {
    fn of(q: &[Vec<f64>]) -> Option<Misses<'_>> {
        let ranges: Vec<f64> = q.iter().map(|x| range(x)).collect();
        let largest = ranges.iter().fold(0.0, |m: f64, x| m.max(*x));
        let joints: Vec<(&[f64], f64)> = q
            .iter()
            .zip(&ranges)
            .filter(|(_, range)| **range > 1e-3 * largest && **range > 0.0)
            .map(|(x, range)| (x.as_slice(), *range))
            .collect();
        let count = joints.first()?.0.len();
        let step = |i: usize| {
            joints.iter().map(|(x, range)| (x[i + 1] - x[i]).abs() / range).fold(0.0, f64::max)
        };
        let steps: Vec<f64> = (0..count - 1).map(step).collect();
        let fast = steps.iter().fold(0.0, |m: f64, x| m.max(*x));
        let moving = (0..count - 1).filter(|i| steps[*i] > RESTING * fast).collect();
        Some(Misses { joints, moving })
    }

    /// The share of a joint's range by which [`PART`] of the samples miss at most.
    fn at(&self, lag: usize) -> f64 {
        let count = self.joints[0].0.len();
        let mut all: Vec<f64> = self
            .moving
            .iter()
            .filter(|i| **i + lag < count)
            .map(|i| {
                let miss = |(x, range): &(&[f64], f64)| (x[*i] - x[i + lag]).abs() / range;
                self.joints.iter().map(miss).fold(0.0, f64::max)
            })
            .collect();
        if all.is_empty() {
            return f64::INFINITY;
        }
        let place = (PART * all.len() as f64) as usize;
        *all.select_nth_unstable_by(place, f64::total_cmp).1
    }
}

fn range(x: &[f64]) -> f64 {
    let (low, high) = x
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    high - low
}

/// First sample and length of the longest run of samples that come back a period later.
fn longest_run(q: &[&[f64]], lag: f64) -> Option<(usize, usize)> {
    let n = q[0].len();
    let whole = lag.round() as usize;
    let ranges: Vec<f64> = q.iter().map(|x| range(x)).collect();
    let back = |i: usize| {
        q.iter().zip(&ranges).all(|(x, range)| {
            // A lag between two samples leaves a part of a step.
            let step = (x[(i + 1).min(n - 1)] - x[i]).abs();
            (x[i] - x[i + whole]).abs() <= 0.03 * range.max(1e-6) + step
        })
    };
    let mut best = (0, 0);
    let mut begin = 0;
    for i in 0..=n.checked_sub(whole)? {
        if i == n - whole || !back(i) {
            if i - begin > best.1 {
                best = (begin, i - begin);
            }
            begin = i + 1;
        }
    }
    (best.1 > 0).then_some(best)
}

/// The mean of the repetitions: the first `joints` series of `section` as Fourier series, the
/// others sample by sample.
#[must_use]
pub fn averaged(section: &Section, periods: &Periods, joints: usize) -> Averaged {
    let samples = (periods.period / section.step).round().max(2.0) as usize;
    let step = periods.period / samples as f64;
    let start = section.time(periods.first);
    let place = |repetition: usize, k: usize| {
        let t = start + periods.period * repetition as f64 + step * k as f64;
        (t - section.start) / section.step
    };
    let is_lost = |r: usize, k: usize| {
        section.lost.binary_search(&(place(r, k).round().max(0.0) as usize)).is_ok()
    };
    let lost: Vec<Vec<usize>> =
        (0..samples).map(|k| (0..periods.count).filter(|r| is_lost(*r, k)).collect()).collect();
    let repetitions = |series: &[f64]| -> Vec<Vec<f64>> {
        let of = |r: usize| (0..samples).map(|k| sample(series, place(r, k))).collect();
        let mut all: Vec<Vec<f64>> = (0..periods.count).map(of).collect();
        // The other repetitions know a lost sample better than those around it.
        for (k, lost) in lost.iter().enumerate() {
            if lost.is_empty() || lost.len() == periods.count {
                continue;
            }
            let known = (0..periods.count).filter(|r| !lost.contains(r)).map(|r| all[r][k]);
            let mean = known.sum::<f64>() / (periods.count - lost.len()) as f64;
            for r in lost {
                all[*r][k] = mean;
            }
        }
        all
    };
    let mean_of = |all: &[Vec<f64>]| -> Vec<f64> {
        let n = all.len() as f64;
        (0..samples).map(|k| all.iter().map(|one| one[k]).sum::<f64>() / n).collect()
    };
    let mut motion: [Vec<Vec<f64>>; 3] = Default::default();
    let mut harmonics = 1;
    let most = HARMONICS.min((samples - 1) / 4);
    for series in &section.series[..joints] {
        let all = repetitions(series);
        let mean = mean_of(&all);
        let count = all.len() as f64;
        let noise: f64 = all
            .iter()
            .flat_map(|one| one.iter().zip(&mean).map(|(a, b)| (a - b).powi(2)))
            .sum::<f64>()
            / ((count - 1.0) * samples as f64);
        let series = fourier(&mean, 0..=most);
        // Power of a coefficient of the mean that is noise alone. Rounding is the same in each
        // repetition: only frequencies without motion show it.
        let tail: Vec<[f64; 2]> = fourier(&mean, tail(samples));
        let rounding = tail.iter().map(|[a, b]| a * a + b * b).sum::<f64>();
        let rounding = rounding / tail.len().max(1) as f64;
        let floor = (4.0 * noise / (count * samples as f64)).max(rounding);
        let scale = series.iter().skip(1).map(|[a, b]| a * a + b * b).fold(0.0, f64::max);
        let counts = |[a, b]: &[f64; 2]| {
            let power = a * a + b * b;
            power > ABOVE_NOISE * floor && power > 1e-16 * scale
        };
        let highest = series.iter().skip(1).rposition(counts).map_or(0, |k| k + 1);
        harmonics = harmonics.max(highest);
        // An acceleration that jumps has harmonics without end.
        let values = if highest as f64 >= ENDLESS * most as f64 {
            let [rates, accelerations] = beside_jumps(&mean, step);
            [mean, rates, accelerations]
        } else {
            evaluated(&series[..=highest], samples, periods.period)
        };
        for (to, values) in motion.iter_mut().zip(values) {
            to.push(values);
        }
    }
    let mut mean = Vec::new();
    let mut spread = Vec::new();
    for series in &section.series[joints..] {
        let mut all = repetitions(series);
        let middle = mean_of(&all);
        for one in &mut all {
            one.iter_mut().zip(&middle).for_each(|(x, m)| *x -= m);
        }
        mean.push(middle);
        spread.push(all);
    }
    Averaged { step, harmonics, motion, mean, spread }
}

/// Rates and accelerations of a period that repeats, by local polynomials.
fn beside_jumps(x: &[f64], step: f64) -> [Vec<f64>; 2] {
    let n = x.len();
    // Another period to each side, so that none of it is at an end.
    let t: Vec<f64> = (0..3 * n).map(|k| step * k as f64).collect();
    let all: Vec<f64> = x.iter().cycle().take(3 * n).copied().collect();
    let found = derivatives(&t, &all);
    [0, 1].map(|order| found[n..2 * n].iter().map(|of| of.map_or(0.0, |of| of[order])).collect())
}

/// The value between samples, on a line.
fn sample(x: &[f64], place: f64) -> f64 {
    let last = x.len() - 1;
    let place = place.clamp(0.0, last as f64);
    let nearest = place.round();
    if (place - nearest).abs() < 1e-6 {
        return x[nearest as usize];
    }
    let before = place.floor() as usize;
    let share = place - before as f64;
    x[before] * (1.0 - share) + x[(before + 1).min(last)] * share
}

/// Coefficients of cosine and sine, the mean first, of one period.
fn fourier(x: &[f64], harmonics: impl Iterator<Item = usize>) -> Vec<[f64; 2]> {
    let n = x.len() as f64;
    harmonics
        .map(|k| {
            let (mut a, mut b) = (0.0, 0.0);
            for (i, value) in x.iter().enumerate() {
                // Whole turns are left out, so that the angle keeps its digits.
                let turn = (k * i % x.len()) as f64 / n;
                let (sin, cos) = (TAU * turn).sin_cos();
                a += value * cos;
                b += value * sin;
            }
            let scale = if k == 0 { 1.0 / n } else { 2.0 / n };
            [a * scale, b * scale]
        })
        .collect()
}

/// Some frequencies that no motion has, of a period with so many samples.
fn tail(samples: usize) -> impl Iterator<Item = usize> {
    let (from, to) = (3 * samples / 8, samples.saturating_sub(1) / 2);
    (from..to).step_by(((to - from.min(to)) / IN_TAIL).max(1))
}

/// The series and its two derivatives at `samples` times of the period.
fn evaluated(series: &[[f64; 2]], samples: usize, period: f64) -> [Vec<f64>; 3] {
    let mut out: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; samples]);
    for (k, [a, b]) in series.iter().enumerate() {
        let w = TAU * k as f64 / period;
        for i in 0..samples {
            let turn = (k * i % samples) as f64 / samples as f64;
            let (sin, cos) = (TAU * turn).sin_cos();
            out[0][i] += a * cos + b * sin;
            out[1][i] += w * (b * cos - a * sin);
            out[2][i] -= w * w * (a * cos + b * sin);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::*;

    const STEP: f64 = 0.01;

    fn motion(t: f64) -> [f64; 3] {
        let w = TAU / 5.0;
        let (s1, c1) = (w * t).sin_cos();
        let (s4, c4) = (4.0 * w * t).sin_cos();
        [0.7 * s1 + 0.2 * c4, 0.7 * w * c1 - 0.8 * w * s4, -0.7 * w * w * s1 - 3.2 * w * w * c4]
    }

    /// Rest, a ramp, five and a half periods, rest.
    fn log() -> Section {
        let q: Vec<f64> = (0..3500)
            .map(|i| {
                let t = STEP * f64::from(i) - 3.0;
                if t < 0.0 {
                    motion(0.0)[0] * (1.0 + t / 3.0)
                } else if t < 27.5 {
                    motion(t)[0]
                } else {
                    motion(27.5)[0]
                }
            })
            .collect();
        let torque = q.iter().enumerate().map(|(i, q)| 3.0 * q + (i % 2) as f64).collect();
        Section { start: 0.0, step: STEP, series: vec![q, torque], lost: Vec::new() }
    }

    #[test]
    fn repetitions_are_found_between_rest_and_rest() {
        let log = log();
        let found = find_periods(&[&log.series[0]], STEP, None).unwrap();
        assert!((found.period - 5.0).abs() < 1e-9, "{found:?}");
        assert_eq!(found.count, 5);
        assert!((250..360).contains(&found.first), "{found:?}");
        assert_eq!(find_periods(&[&log.series[0][..700]], STEP, None), None);
    }

    #[test]
    fn the_series_is_differentiated_and_the_rest_averaged() {
        let log = log();
        let periods = Periods { period: 5.0, first: 320, count: 5 };
        let found = averaged(&log, &periods, 1);
        assert_eq!(found.harmonics, 4);
        for i in 0..500 {
            let t = STEP * (320 + i) as f64 - 3.0;
            for (order, expected) in motion(t).into_iter().enumerate() {
                assert!((found.motion[order][0][i] - expected).abs() < 1e-9 * 40.0);
            }
        }
        assert_eq!(found.spread[0].len(), 5);
    }

    #[test]
    fn what_one_repetition_lost_the_others_know() {
        let mut log = log();
        let periods = Periods { period: 5.0, first: 320, count: 5 };
        let whole = averaged(&log, &periods, 1);
        for k in [400, 401, 900] {
            log.series[1][k] += 20.0;
            log.lost.push(k);
        }
        let found = averaged(&log, &periods, 1);
        let all = found.mean[0].iter().zip(&whole.mean[0]);
        assert!(all.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) < 1e-9);
        assert!(found.spread[0].iter().flatten().all(|x| x.abs() < 1e-9));
    }

    #[test]
    fn rest_is_no_repetition() {
        assert_eq!(find_periods(&[&[0.5; 1000]], STEP, None), None);
    }
}

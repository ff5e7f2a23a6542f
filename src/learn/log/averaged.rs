//! Mean and noise of the repetitions of a motion.
//!
//! The positions are fitted by a Fourier series and differentiated analytically; torques are
//! averaged over the repetitions, and their spread gives the noise (J. Swevers, C. Ganseman, D.
//! Tükel, J. De Schutter, H. Van Brussel, "Optimal robot excitation and identification", IEEE T-RA
//! 13, 1997).

use std::f64::consts::TAU;

use super::differentiate::derivatives;
use super::periods::Periods;
use super::uniform::Section;

/// Largest number of harmonics.
const HARMONICS: usize = 240;
/// Share of these above which the series converges too slowly.
const ENDLESS: f64 = 0.9;
/// Number of frequencies that determine the rounding noise.
const IN_TAIL: usize = 60;
/// Least ratio of a harmonic's power to that of noise.
const ABOVE_NOISE: f64 = 16.0;

/// The mean of repetitions.
#[derive(Clone, Debug, PartialEq)]
pub struct Averaged {
    /// Interval of the samples \[s\].
    pub step: f64,
    /// Number of harmonics of the position series.
    pub harmonics: usize,
    /// Positions, rates and accelerations of each joint over one period.
    pub motion: [Vec<Vec<f64>>; 3],
    /// The mean of the other series over one period.
    pub mean: Vec<Vec<f64>>,
    /// Deviation of each repetition from that mean: by series, by repetition.
    pub spread: Vec<Vec<Vec<f64>>>,
}

/// The samples of repetitions in a section.
struct Repetitions<'a> {
    section: &'a Section,
    periods: &'a Periods,
    /// Number of samples in a period, and their interval \[s\].
    samples: usize,
    step: f64,
    /// For each sample of a period, the repetitions in which it is lost.
    lost: Vec<Vec<usize>>,
}

impl Repetitions<'_> {
    fn new<'a>(section: &'a Section, periods: &'a Periods) -> Repetitions<'a> {
        let samples = (periods.period / section.step).round().max(2.0) as usize;
        let step = periods.period / samples as f64;
        let mut repetitions = Repetitions { section, periods, samples, step, lost: Vec::new() };
        let is_lost = |r: usize, k: usize| {
            let place = repetitions.place(r, k).round().max(0.0) as usize;
            section.lost.binary_search(&place).is_ok()
        };
        let of = |k: usize| (0..periods.count).filter(|r| is_lost(*r, k)).collect();
        repetitions.lost = (0..samples).map(of).collect();
        repetitions
    }

    /// Place of sample `k` of a repetition among the samples of the section.
    fn place(&self, repetition: usize, k: usize) -> f64 {
        let start = self.section.time(self.periods.first);
        let t = start + self.periods.period * repetition as f64 + self.step * k as f64;
        (t - self.section.start) / self.section.step
    }

    /// The repetitions of a series.
    fn series(&self, series: &[f64]) -> Vec<Vec<f64>> {
        let count = self.periods.count;
        let of = |r: usize| (0..self.samples).map(|k| sample(series, self.place(r, k))).collect();
        let mut all: Vec<Vec<f64>> = (0..count).map(of).collect();
        // The other repetitions estimate a lost sample better than neighbouring samples.
        for (k, lost) in self.lost.iter().enumerate() {
            if lost.is_empty() || lost.len() == count {
                continue;
            }
            let known = (0..count).filter(|r| !lost.contains(r)).map(|r| all[r][k]);
            let mean = known.sum::<f64>() / (count - lost.len()) as f64;
            for r in lost {
                all[*r][k] = mean;
            }
        }
        all
    }
}

/// The mean of the repetitions: the first `joints` series of `section` as Fourier series, the
/// others sample by sample.
#[must_use]
pub fn averaged(section: &Section, periods: &Periods, joints: usize) -> Averaged {
    let repetitions = Repetitions::new(section, periods);
    let mut motion: [Vec<Vec<f64>>; 3] = Default::default();
    let mut harmonics = 1;
    for series in &section.series[..joints] {
        let (highest, values) = smooth(&repetitions.series(series), periods.period);
        harmonics = harmonics.max(highest);
        for (to, values) in motion.iter_mut().zip(values) {
            to.push(values);
        }
    }
    let mut mean = Vec::new();
    let mut spread = Vec::new();
    for series in &section.series[joints..] {
        let mut all = repetitions.series(series);
        let middle = mean_of(&all);
        for one in &mut all {
            one.iter_mut().zip(&middle).for_each(|(x, m)| *x -= m);
        }
        mean.push(middle);
        spread.push(all);
    }
    Averaged { step: repetitions.step, harmonics, motion, mean, spread }
}

fn mean_of(repetitions: &[Vec<f64>]) -> Vec<f64> {
    let n = repetitions.len() as f64;
    let samples = repetitions.first().map_or(0, Vec::len);
    (0..samples).map(|k| repetitions.iter().map(|one| one[k]).sum::<f64>() / n).collect()
}

/// The highest harmonic above the noise, and the Fourier series up to it with two derivatives.
fn smooth(repetitions: &[Vec<f64>], period: f64) -> (usize, [Vec<f64>; 3]) {
    let mean = mean_of(repetitions);
    let (samples, count) = (mean.len(), repetitions.len() as f64);
    let most = HARMONICS.min((samples - 1) / 4);
    let noise: f64 = repetitions
        .iter()
        .flat_map(|one| one.iter().zip(&mean).map(|(a, b)| (a - b).powi(2)))
        .sum::<f64>()
        / ((count - 1.0) * samples as f64);
    let series = fourier(&mean, 0..=most);
    // Noise power of a coefficient of the mean. Rounding errors are the same in each repetition, so
    // that only frequencies without motion show them.
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
    // The Fourier series of a motion with a jump in its acceleration converges slowly.
    if highest as f64 >= ENDLESS * most as f64 {
        let [rates, accelerations] = beside_jumps(&mean, period / samples as f64);
        return (highest, [mean, rates, accelerations]);
    }
    (highest, evaluated(&series[..=highest], samples, period))
}

/// Rates and accelerations of a periodic series, by local polynomials.
fn beside_jumps(x: &[f64], step: f64) -> [Vec<f64>; 2] {
    let n = x.len();
    // A period on each side avoids boundary effects.
    let t: Vec<f64> = (0..3 * n).map(|k| step * k as f64).collect();
    let all: Vec<f64> = x.iter().cycle().take(3 * n).copied().collect();
    let found = derivatives(&t, &all);
    [0, 1].map(|order| found[n..2 * n].iter().map(|of| of.map_or(0.0, |of| of[order])).collect())
}

/// The value between samples, by linear interpolation.
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

/// Coefficients of cosine and sine of one period; the mean comes first.
fn fourier(x: &[f64], harmonics: impl Iterator<Item = usize>) -> Vec<[f64; 2]> {
    let n = x.len() as f64;
    harmonics
        .map(|k| {
            let (mut a, mut b) = (0.0, 0.0);
            for (i, value) in x.iter().enumerate() {
                // Whole turns are removed to keep the accuracy of the angle.
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

/// Some frequencies above those of a motion.
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
    use super::super::periodic_motion::{STEP, log, motion};
    use super::*;

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
    fn lost_samples_come_from_the_other_repetitions() {
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
}

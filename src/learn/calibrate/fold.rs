//! Folding the rows of a log onto the simulated cycle, in windows.

use std::ops::Range;

use super::aligned::Aligned;
use super::cycle::Cycle;
use crate::learn::log::{Channel, Log, median_step, quantile};

/// Approximate largest numbers of instants and of windows in a cycle.
const INSTANTS: f64 = 2000.0;
const WINDOWS: f64 = 100.0;
/// Ratio of the standard deviation to the median absolute value, for normal noise.
const OF_MEDIAN: f64 = 1.4826;
/// Ratio of the variance of second differences to that of independent noise.
const OF_DIFFERENCES: f64 = 6.0;

/// Means of a log over windows of the cycle.
pub(super) struct Windows {
    /// Instants \[s\], from the start of the cycle.
    pub(super) times: Vec<f64>,
    /// Indices of the instants of each window.
    pub(super) ranges: Vec<Range<usize>>,
    /// Mean of each window, and its standard deviation from noise \[W\].
    pub(super) power: Vec<f64>,
    pub(super) power_sd: Vec<f64>,
    /// The same for the torque of each joint \[Nm\]; empty without torques.
    pub(super) torque: Vec<(Vec<f64>, Vec<f64>)>,
}

/// Sums over the rows at one instant.
#[derive(Clone)]
struct Bin {
    rows: f64,
    t: f64,
    power: f64,
    /// Simulated power at the same times.
    expected: f64,
    torque: Vec<f64>,
}

/// Averages the passes of a log in bins and windows of the cycle.
pub(super) fn fold(
    cycle: &Cycle<'_>,
    log: &Log,
    aligned: &Aligned,
    torques: Option<&[Vec<f64>]>,
) -> Windows {
    let unit = if aligned.kilowatts { 1000.0 } else { 1.0 };
    let t = log.time();
    let power: Vec<f64> =
        log.column(Channel::Power).unwrap_or_default().iter().map(|w| w * unit).collect();
    let torques = torques.unwrap_or_default();
    let noise = Noise::estimated(&power);
    let torque_noise: Vec<Noise> = torques.iter().map(|tau| Noise::estimated(tau)).collect();
    let width = (cycle.duration / INSTANTS).max(median_step(t));
    let count = (cycle.duration / width).ceil() as usize + 1;
    let empty =
        Bin { rows: 0.0, t: 0.0, power: 0.0, expected: 0.0, torque: vec![0.0; torques.len()] };
    let mut bins = vec![empty; count];
    for segment in aligned.passes.iter().flatten() {
        let from = t.partition_point(|t| *t < segment.log.start);
        let to = t.partition_point(|t| *t < segment.log.end);
        for i in from..to.max(from) {
            let at = segment.begin + (t[i] - segment.log.start) / segment.pace;
            let Some(bin) = bins.get_mut((at / width) as usize) else { continue };
            bin.rows += 1.0;
            bin.t += at;
            bin.power += power[i];
            bin.expected += cycle.power(at);
            for (sum, tau) in bin.torque.iter_mut().zip(torques) {
                *sum += tau[i];
            }
        }
    }
    bins.retain(|bin| bin.rows > 0.0);
    for bin in &mut bins {
        bin.t = (bin.t / bin.rows).min(cycle.duration);
        // The mean power of a bin differs from the power at its mean time where the power curve
        // bends. The simulated power gives the difference.
        let bent = bin.expected / bin.rows - cycle.power(bin.t);
        bin.power = bin.power / bin.rows - bent;
        bin.torque.iter_mut().for_each(|sum| *sum /= bin.rows);
    }
    let mut windows = Windows {
        times: bins.iter().map(|bin| bin.t).collect(),
        ranges: ranges(cycle, &bins),
        power: Vec::new(),
        power_sd: Vec::new(),
        torque: Vec::new(),
    };
    let means = |value: &dyn Fn(&Bin) -> f64, variance: &dyn Fn(&Bin) -> f64| {
        let of = |range: &Range<usize>| {
            let (bins, n) = (&bins[range.clone()], range.len() as f64);
            let mean = bins.iter().map(value).sum::<f64>() / n;
            let variance = bins.iter().map(|bin| variance(bin) / bin.rows).sum::<f64>() / (n * n);
            (mean, variance.sqrt())
        };
        windows.ranges.iter().map(of).unzip()
    };
    let found: (Vec<f64>, Vec<f64>) = means(&|bin| bin.power, &|bin| noise.variance(bin.power));
    let torque: Vec<(Vec<f64>, Vec<f64>)> = (0..torques.len())
        .map(|j| means(&|bin| bin.torque[j], &|bin| torque_noise[j].variance(bin.torque[j])))
        .collect();
    (windows.power, windows.power_sd) = found;
    windows.torque = torque;
    windows
}

/// Windows of the instants; no window crosses the end of a movement or of a wait.
fn ranges(cycle: &Cycle<'_>, bins: &[Bin]) -> Vec<Range<usize>> {
    let longest = cycle.duration / WINDOWS;
    let mut ranges = Vec::new();
    for piece in cycle.pieces() {
        let parts = ((piece.end - piece.start) / longest).ceil().max(1.0);
        let step = (piece.end - piece.start) / parts;
        for part in 0..parts as usize {
            let from = piece.start + step * part as f64;
            let place = |t: f64| bins.partition_point(|bin| bin.t < t);
            let range = place(from)..place(from + step);
            if !range.is_empty() {
                ranges.push(range);
            }
        }
    }
    ranges
}

/// Variance of a row's noise: a constant part, and a part proportional to the squared value.
struct Noise {
    constant: f64,
    relative: f64,
}

impl Noise {
    /// Estimate from the second differences of small and of large values.
    fn estimated(values: &[f64]) -> Noise {
        let middle = quantile(values.iter().map(|x| x.abs()), 0.5);
        let square = |part: &dyn Fn(f64) -> bool| {
            let of: Vec<f64> = values.iter().copied().filter(|x| part(*x)).collect();
            of.iter().map(|x| x * x).sum::<f64>() / of.len().max(1) as f64
        };
        let [low, high] =
            [differences(values, |x| x.abs() < middle), differences(values, |x| x.abs() >= middle)];
        let [below, above] = [square(&|x| x.abs() < middle), square(&|x| x.abs() >= middle)];
        let relative = if above > below { ((high - low) / (above - below)).max(0.0) } else { 0.0 };
        let constant = (low - relative * below).max(0.0);
        Noise { constant, relative }
    }

    fn variance(&self, value: f64) -> f64 {
        (self.constant + self.relative * value * value).max(QUIET * value * value)
    }
}

/// Least relative variance of the noise.
const QUIET: f64 = 1e-6;

/// Variance of the noise from second differences of the values that `meant` selects.
fn differences(values: &[f64], meant: impl Fn(f64) -> bool) -> f64 {
    let triples = values.windows(3).filter(|triple| triple.iter().all(|x| meant(*x)));
    let median =
        quantile(triples.map(|triple| (triple[0] - 2.0 * triple[1] + triple[2]).abs()), 0.5);
    (OF_MEDIAN * median).powi(2) / OF_DIFFERENCES
}

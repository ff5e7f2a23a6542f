//! The noise of a log: from its repetitions, or from its fastest changes.

use super::used::Used;

/// Neighbours over which the power of noise is averaged.
const SMOOTHED: usize = 8;

/// Variances of one repetition's noise \[N²m²\].
pub(super) struct Noise {
    /// In the rows of each frequency.
    pub(super) spectrum: Vec<f64>,
    /// At each instant.
    pub(super) scatter: Vec<f64>,
}

impl Noise {
    /// Of what is neither the mean nor a drift of repetitions.
    pub(super) fn of_repetitions(used: &Used, joint: usize, spread: &[Vec<f64>]) -> Noise {
        let count = spread.len();
        let line = line(count);
        let rows = spread.first().map_or(0, Vec::len);
        let drift: Vec<f64> = (0..rows)
            .map(|k| spread.iter().zip(&line).map(|(of, w)| w * of[k]).sum::<f64>())
            .collect();
        let left = (count - if count > 2 { 2 } else { 1 }).max(1) as f64;
        let mut spectrum = vec![0.0; used.spectrum.bins];
        let mut scatter = vec![0.0; rows];
        for (of, weight) in spread.iter().zip(&line) {
            let weight = if count > 2 { *weight } else { 0.0 };
            let rest: Vec<f64> = of.iter().zip(&drift).map(|(x, d)| x - weight * d).collect();
            scatter.iter_mut().zip(&rest).for_each(|(sum, x)| *sum += x * x / left);
            let power = used.spectrum.smoothed(&used.rows(joint, &rest), SMOOTHED);
            spectrum.iter_mut().zip(power).for_each(|(sum, power)| *sum += power / left);
        }
        Noise { spectrum, scatter }
    }

    /// White noise as the fastest changes show it; motion has none of them.
    pub(super) fn of_differences(used: &Used, joint: usize, tau: &[f64]) -> Noise {
        // Fourth differences have 70 times the variance of white noise.
        let differences =
            tau.windows(5).map(|x| x[0] - 4.0 * x[1] + 6.0 * x[2] - 4.0 * x[3] + x[4]);
        let mut squares: Vec<f64> = differences.map(|x| x * x / 70.0).collect();
        squares.sort_by(f64::total_cmp);
        // The median of the squares of a normal deviate is 0.455 of its variance.
        let variance = squares.get(squares.len() / 2).map_or(0.0, |x| x / 0.455);
        let window = &used.window[joint];
        let part = window.iter().map(|w| w * w).sum::<f64>() / window.len().max(1) as f64;
        Noise {
            spectrum: vec![variance * part; used.spectrum.bins],
            scatter: vec![variance; tau.len()],
        }
    }

    /// The same of a mean of repetitions.
    pub(super) fn of_mean(mut self, repetitions: usize) -> Noise {
        let share = 1.0 / repetitions as f64;
        for x in self.spectrum.iter_mut().chain(&mut self.scatter) {
            *x *= share;
        }
        self
    }
}

/// Weights of a line about 0, squares of the sum 1.
pub(super) fn line(count: usize) -> Vec<f64> {
    let middle = 0.5 * (count as f64 - 1.0);
    let weights: Vec<f64> = (0..count).map(|k| k as f64 - middle).collect();
    let norm = weights.iter().map(|w| w * w).sum::<f64>().sqrt().max(1e-12);
    weights.iter().map(|w| w / norm).collect()
}

//! Series as real rows of a spectrum: noise that is coloured over time is not so from row to
//! row.

use std::sync::Arc;

use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

/// The transform of series of one length.
#[derive(Clone)]
pub(super) struct Spectrum {
    fft: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    is_filtered: bool,
    length: usize,
    /// Number of frequencies that are used, the mean among them.
    pub(super) bins: usize,
}

impl Spectrum {
    /// For series of `length` samples every `step` \[s\], up to the frequency `highest` \[Hz\].
    pub(super) fn new(length: usize, step: f64, highest: f64) -> Spectrum {
        let bins = (highest * step * length as f64) as usize + 1;
        Spectrum {
            fft: FftPlanner::new().plan_fft_forward(length),
            inverse: FftPlanner::new().plan_fft_inverse(length),
            is_filtered: false,
            length,
            bins: bins.clamp(1, length.div_ceil(2)),
        }
    }

    /// The same for series that pass a low-pass filter first, as motions did whose accelerations
    /// jump: what is behind the filter agrees on both sides of a jump.
    pub(super) fn filtered(self, is_filtered: bool) -> Spectrum {
        Spectrum { is_filtered, ..self }
    }

    /// Rows of a series within a window.
    pub(super) fn masked(&self, x: &[f64], window: &[f64]) -> Vec<f64> {
        if !self.is_filtered {
            return self.of(x.iter().zip(window).map(|(x, w)| x * w));
        }
        let mut values: Vec<Complex<f64>> = x.iter().map(|x| Complex::new(*x, 0.0)).collect();
        values.resize(self.length, Complex::new(0.0, 0.0));
        self.fft.process(&mut values);
        let n = self.length;
        for (k, value) in values.iter_mut().enumerate() {
            let bin = k.min(n - k);
            *value *= passed(bin as f64 / self.bins as f64) / n as f64;
        }
        self.inverse.process(&mut values);
        self.of(values.iter().zip(window).map(|(x, w)| x.re * w))
    }

    /// A periodic series up to the highest frequency, with two derivatives, per s and s²;
    /// `period` in s.
    pub(super) fn derivatives(&self, x: &[f64], period: f64) -> [Vec<f64>; 3] {
        let n = self.length;
        let mut values: Vec<Complex<f64>> = x.iter().map(|x| Complex::new(*x, 0.0)).collect();
        self.fft.process(&mut values);
        [0, 1, 2].map(|order| {
            let mut derived = values.clone();
            for (k, value) in derived.iter_mut().enumerate() {
                let bin = k.min(n - k);
                if bin >= self.bins {
                    *value = Complex::new(0.0, 0.0);
                    continue;
                }
                let sign = if 2 * k > n { -1.0 } else { 1.0 };
                let w = sign * std::f64::consts::TAU * bin as f64 / period;
                *value *= Complex::new(0.0, w).powi(order) / n as f64;
            }
            self.inverse.process(&mut derived);
            derived.iter().map(|x| x.re).collect()
        })
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        2 * self.bins - 1
    }

    /// The mean, then real and imaginary part of each frequency; white noise of some variance
    /// has the same in each row.
    pub(super) fn of(&self, x: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut values: Vec<Complex<f64>> = x.map(|x| Complex::new(x, 0.0)).collect();
        values.resize(self.length, Complex::new(0.0, 0.0));
        self.fft.process(&mut values);
        let scale = (2.0 / self.length as f64).sqrt();
        let mut rows = Vec::with_capacity(self.rows());
        rows.push(values[0].re * scale * std::f64::consts::FRAC_1_SQRT_2);
        for value in &values[1..self.bins] {
            rows.push(value.re * scale);
            rows.push(value.im * scale);
        }
        rows
    }

    /// The series whose product with another one is that of rows with the other one's.
    pub(super) fn back(&self, rows: &[f64]) -> Vec<f64> {
        let scale = (2.0 / self.length as f64).sqrt();
        let mut values = vec![Complex::new(0.0, 0.0); self.length];
        values[0].re = rows[0] * scale * std::f64::consts::FRAC_1_SQRT_2;
        for (value, row) in values[1..self.bins].iter_mut().zip(rows[1..].chunks_exact(2)) {
            *value = Complex::new(row[0] * scale, row[1] * scale);
        }
        self.inverse.process(&mut values);
        values.iter().map(|x| x.re).collect()
    }

    /// Mean power of a row at each frequency, over the neighbours within `reach`.
    pub(super) fn smoothed(&self, rows: &[f64], reach: usize) -> Vec<f64> {
        let mut sums = vec![0.0];
        let mut counts = vec![0.0];
        for bin in 0..self.bins {
            let (power, count) = match bin {
                0 => (rows[0] * rows[0], 1.0),
                _ => (rows[2 * bin - 1].powi(2) + rows[2 * bin].powi(2), 2.0),
            };
            sums.push(sums[bin] + power);
            counts.push(counts[bin] + count);
        }
        (0..self.bins)
            .map(|bin| {
                let (from, to) = (bin.saturating_sub(reach), (bin + reach + 1).min(self.bins));
                (sums[to] - sums[from]) / (counts[to] - counts[from])
            })
            .collect()
    }
}

/// What a filter passes of a frequency, of the highest one: all of the lower half.
fn passed(share: f64) -> f64 {
    const FLAT: f64 = 0.5;
    match share {
        x if x <= FLAT => 1.0,
        x if x >= 1.0 => 0.0,
        x => 0.5 + 0.5 * (std::f64::consts::PI * (x - FLAT) / (1.0 - FLAT)).cos(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_is_kept() {
        let x: Vec<f64> = (0..101).map(|i| (0.7 * f64::from(i)).sin() + 0.3).collect();
        let spectrum = Spectrum::new(101, 0.01, 1e9);
        let rows = spectrum.of(x.iter().copied());
        assert_eq!(rows.len(), 101);
        let power = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
        assert!((power(&rows) - power(&x)).abs() < 1e-9 * power(&x));
        let back = spectrum.back(&rows);
        assert!(back.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}

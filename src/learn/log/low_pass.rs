//! A low-pass filter without delay, and filters for its derivatives.
//!
//! The kernel is a sinc function with a Hann window, differentiated analytically. Its discrete
//! moments are corrected, so that parabolas are differentiated exactly at any sampling rate.

use std::f64::consts::PI;

/// Half length of the kernel in periods of the cut-off frequency.
const PERIODS: f64 = 2.0;

/// The filter for samples at equal intervals.
#[derive(Clone, Debug)]
pub struct LowPass {
    /// Number of samples to each side.
    pub half: usize,
    /// Weights of value, first and second derivative, oldest sample first.
    weights: [Vec<f64>; 3],
}

impl LowPass {
    /// The filter with the cut-off frequency `cutoff` \[Hz\] for samples every `step` \[s\].
    #[must_use]
    pub fn new(cutoff: f64, step: f64) -> LowPass {
        let half = (PERIODS / (cutoff * step)).ceil().max(3.0) as usize;
        let length = (half as f64 + 1.0) * step;
        let times: Vec<f64> = (0..=2 * half).map(|i| (i as f64 - half as f64) * step).collect();
        let orders: Vec<[f64; 3]> = times.iter().map(|t| kernel(*t, cutoff, length)).collect();
        let of = |order: usize| orders.iter().map(|all| all[order]).collect::<Vec<f64>>();
        let (mut value, mut first, mut second) = (of(0), of(1), of(2));

        let normalise = |weights: &mut [f64], by: f64| weights.iter_mut().for_each(|w| *w /= by);
        let sum: f64 = value.iter().sum();
        normalise(&mut value, sum);
        // The weighted sum of −t over past samples is the rate of a straight line.
        let slope: f64 = first.iter().zip(&times).map(|(w, t)| -w * t).sum();
        normalise(&mut first, slope);
        let mean: f64 = second.iter().sum();
        second.iter_mut().zip(&value).for_each(|(w, v)| *w -= mean * v);
        let bend: f64 = second.iter().zip(&times).map(|(w, t)| 0.5 * w * t * t).sum();
        normalise(&mut second, bend);
        // The kernel is reversed for the convolution.
        first.reverse();
        LowPass { half, weights: [value, first, second] }
    }

    /// Number of samples under the kernel.
    #[must_use]
    pub fn width(&self) -> usize {
        2 * self.half + 1
    }

    /// The weights of the derivative of order 0 to 2, oldest sample first.
    #[must_use]
    pub fn weights(&self, order: usize) -> &[f64] {
        &self.weights[order.min(2)]
    }

    /// The derivative of order 0 to 2 of `x` at all samples with a complete kernel; empty without
    /// any.
    #[must_use]
    pub fn filtered(&self, x: &[f64], order: usize) -> Vec<f64> {
        let weights = self.weights(order);
        let product = |part: &[f64]| part.iter().zip(weights).map(|(x, w)| x * w).sum();
        x.windows(self.width()).map(product).collect()
    }
}

/// Value and derivatives of the kernel \[1, 1/s, 1/s²\]; the window ends at `length`.
fn kernel(t: f64, cutoff: f64, length: f64) -> [f64; 3] {
    let a = 2.0 * PI * cutoff;
    let x = a * t;
    let [s, ds, dds] = if x.abs() < 1e-2 {
        // Series of sin x / x up to fourth order, to avoid cancellation.
        let x2 = x * x;
        [1.0 - x2 / 6.0 + x2 * x2 / 120.0, x * (-1.0 / 3.0 + x2 / 30.0), -1.0 / 3.0 + x2 / 10.0]
    } else {
        let (sin, cos) = x.sin_cos();
        [sin / x, (cos - sin / x) / x, -sin / x - 2.0 * (cos - sin / x) / (x * x)]
    };
    let b = PI / length;
    let (sin, cos) = (b * t).sin_cos();
    let [w, dw, ddw] = [0.5 + 0.5 * cos, -0.5 * b * sin, -0.5 * b * b * cos];
    [s * w, a * ds * w + s * dw, a * a * dds * w + 2.0 * a * ds * dw + s * ddw]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest relative error for a slow sine.
    const PASSED: f64 = 4e-3;
    /// Largest remaining share of a fast sine.
    const STOPPED: f64 = 1e-2;

    #[test]
    fn slow_sines_pass_with_their_derivatives_and_fast_ones_do_not() {
        let step = 0.01;
        let filter = LowPass::new(10.0, step);
        let sine = |f: f64| -> Vec<f64> {
            (0..400).map(|i| (2.0 * PI * f * step * f64::from(i) + 0.4).sin()).collect()
        };
        let w = 2.0 * PI * 2.0;
        let slow = sine(2.0);
        for (order, scale) in [1.0, w, w * w].into_iter().enumerate() {
            for (i, found) in filter.filtered(&slow, order).iter().enumerate() {
                let phase = w * step * (i + filter.half) as f64 + 0.4;
                let expected = scale * [phase.sin(), phase.cos(), -phase.sin()][order];
                assert!((found - expected).abs() < PASSED * scale, "{order}: {found} {expected}");
            }
        }
        assert!(filter.filtered(&sine(30.0), 0).iter().all(|x| x.abs() < STOPPED));
    }

    #[test]
    fn parabolas_are_exact() {
        let step = 0.02;
        let filter = LowPass::new(12.0, step);
        let x: Vec<f64> =
            (0..100).map(|i| step * f64::from(i)).map(|t| 1.0 + 2.0 * t + 3.0 * t * t).collect();
        for (i, acceleration) in filter.filtered(&x, 2).iter().enumerate() {
            let t = step * (i + filter.half) as f64;
            assert!((acceleration - 6.0).abs() < 1e-9);
            assert!((filter.filtered(&x, 1)[i] - (2.0 + 6.0 * t)).abs() < 1e-9);
        }
    }
}

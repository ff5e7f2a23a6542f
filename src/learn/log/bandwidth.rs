//! Bandwidth of a measured motion.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Steps of the search per octave.
const PER_OCTAVE: i32 = 4;
/// The highest frequency of the search, relative to the sampling rate.
const HIGHEST: f64 = 0.25;

/// The frequency \[Hz\] below which `share` of the power of `x` lies, sampled every `step` \[s\];
/// the lowest frequency of the search if there is no power.
#[must_use]
pub fn bandwidth(x: &[f64], step: f64, share: f64) -> f64 {
    let highest = HIGHEST / step;
    let duration = step * x.len() as f64;
    let octaves = (highest * duration).log2().max(1.0);
    let count = (octaves * f64::from(PER_OCTAVE)).ceil() as i32;
    let frequency = |k: i32| highest * 2.0_f64.powf(-f64::from(k) / f64::from(PER_OCTAVE));
    let all = passed(x, highest * step);
    (0..=count).rev().map(frequency).find(|f| passed(x, f * step) >= share * all).unwrap_or(highest)
}

/// Power after a second-order Butterworth low-pass filter; `cutoff` per sample.
fn passed(x: &[f64], cutoff: f64) -> f64 {
    let w = 2.0 * PI * cutoff;
    let (sin, cos) = w.sin_cos();
    let alpha = sin * FRAC_1_SQRT_2;
    let scale = 1.0 / (1.0 + alpha);
    let b = 0.5 * (1.0 - cos) * scale;
    let (a1, a2) = (-2.0 * cos * scale, (1.0 - alpha) * scale);
    let [mut x1, mut x2, mut y1, mut y2, mut power] = [0.0; 5];
    for x in x {
        let y = b * (x + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
        (x2, x1, y2, y1) = (x1, *x, y1, y);
        power += y * y;
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_is_as_fast_as_its_frequency() {
        for f in [0.5, 3.0, 11.0] {
            let x: Vec<f64> =
                (0..5000).map(|i| (2.0 * PI * f * 0.005 * f64::from(i)).sin()).collect();
            let found = bandwidth(&x, 0.005, 0.5);
            assert!((0.6..1.7).contains(&(found / f)), "{f}: {found}");
        }
    }
}

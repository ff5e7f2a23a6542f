//! A periodic motion as a Fourier series of each joint.
//!
//! ```text
//! q_i(t) = q_i0 + Σ_k a_ik sin(k ω t) + b_ik cos(k ω t)
//! ```
//!
//! Paes et al. 2014, equation 3, with the phases as sine and cosine.

use std::f64::consts::TAU;

use crate::arm::robot::MAX_DOF;

/// Position, rate and acceleration of all joints.
pub type State = [[f64; MAX_DOF]; 3];

/// The motion of all joints with a common base frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Base frequency \[Hz\].
    pub base_frequency: f64,
    /// Harmonics as multiples of it, ascending.
    pub harmonics: Vec<usize>,
    /// Offset of each joint \[rad\].
    pub offset: Vec<f64>,
    /// Sine and cosine amplitude of each harmonic, by joint \[rad\].
    pub amplitude: Vec<Vec<[f64; 2]>>,
}

impl Series {
    /// Duration of a repetition \[s\].
    #[must_use]
    pub fn period(&self) -> f64 {
        1.0 / self.base_frequency
    }

    /// The state at a time \[s\].
    #[must_use]
    pub fn at(&self, t: f64) -> State {
        let mut state = [[0.0; MAX_DOF]; 3];
        let waves: Vec<(f64, f64, f64)> = self
            .harmonics
            .iter()
            .map(|k| {
                let w = TAU * self.base_frequency * *k as f64;
                let (sin, cos) = (w * t).sin_cos();
                (w, sin, cos)
            })
            .collect();
        for (joint, offset) in self.offset.iter().enumerate() {
            state[0][joint] = *offset;
            for ([a, b], (w, sin, cos)) in self.amplitude[joint].iter().zip(&waves) {
                let value = a * sin + b * cos;
                state[0][joint] += value;
                state[1][joint] += w * (a * cos - b * sin);
                state[2][joint] -= w * w * value;
            }
        }
        state
    }

    /// The states at `count` times of one period.
    #[must_use]
    pub fn sampled(&self, count: usize) -> Vec<State> {
        let step = self.period() / count as f64;
        (0..count).map(|i| self.at(step * i as f64)).collect()
    }

    /// The same motion with its start moved later by `shift` \[s\].
    #[must_use]
    pub fn later(&self, shift: f64) -> Series {
        let mut later = self.clone();
        for pairs in &mut later.amplitude {
            for ([a, b], k) in pairs.iter_mut().zip(&self.harmonics) {
                let (sin, cos) = (TAU * self.base_frequency * *k as f64 * shift).sin_cos();
                (*a, *b) = (*a * cos - *b * sin, *a * sin + *b * cos);
            }
        }
        later
    }

    /// The same offsets with all amplitudes times `share`.
    #[must_use]
    pub fn scaled(&self, share: f64) -> Series {
        let mut scaled = self.clone();
        for pair in scaled.amplitude.iter_mut().flatten().flatten() {
            *pair *= share;
        }
        scaled
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_later_series_is_the_same_motion() {
        let series = Series {
            base_frequency: 0.1,
            harmonics: vec![1, 4],
            offset: vec![0.3],
            amplitude: vec![vec![[0.2, -0.4], [0.1, 0.05]]],
        };
        let later = series.later(2.3);
        for t in [0.0, 1.7, 8.8] {
            for (a, b) in series.at(t + 2.3).iter().zip(later.at(t)) {
                assert!((a[0] - b[0]).abs() < 1e-12);
            }
        }
    }
}

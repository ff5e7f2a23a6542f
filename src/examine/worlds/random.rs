//! Random numbers of all worlds: draws beyond those of the examination's generator.

use nalgebra::Vector3;
use std::f64::consts::TAU;

pub(super) use crate::examine::blind::random::Random as Rng;

/// Normal numbers are cut here, in standard deviations: no part is delivered that is worse.
const CUT: f64 = 2.5;

impl Rng {
    /// The stream of a purpose in a case.
    pub(super) fn stream(seed: u64, number: usize, purpose: &str) -> Rng {
        Rng::new(seed, number as u64, purpose)
    }

    /// Uniform in a range.
    pub(super) fn uniform(&mut self, range: (f64, f64)) -> f64 {
        self.between(range.0, range.1)
    }

    /// Log-uniform in a range of positive numbers.
    pub(super) fn log(&mut self, range: (f64, f64)) -> f64 {
        self.log_between(range.0, range.1)
    }

    /// Normal with a standard deviation, cut at 2.5 of them.
    pub(super) fn spread(&mut self, sd: f64) -> f64 {
        sd * self.normal().clamp(-CUT, CUT)
    }

    /// A whole number between two bounds, both included.
    pub(super) fn whole(&mut self, from: usize, to: usize) -> usize {
        from + self.below((to + 1).saturating_sub(from))
    }

    /// One of some values, of which there is at least one.
    pub(super) fn pick<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.below(values.len())]
    }

    /// The index of a weight, drawn in proportion to the weights.
    pub(super) fn weighted(&mut self, weights: &[f64]) -> usize {
        let mut rest = self.unit() * weights.iter().sum::<f64>();
        let passed = |weight: &f64| {
            rest -= weight;
            rest < 0.0
        };
        weights.iter().position(passed).unwrap_or(weights.len() - 1)
    }

    /// `count` different numbers of a list, rising; all of a shorter list.
    pub(super) fn choose(&mut self, from: &[usize], count: usize) -> Vec<usize> {
        let mut left = from.to_vec();
        while left.len() > count {
            left.remove(self.below(left.len()));
        }
        left
    }

    /// A uniform angle \[rad\] in −π to π.
    pub(super) fn angle(&mut self) -> f64 {
        TAU * (self.unit() - 0.5)
    }

    /// Three normal numbers.
    pub(super) fn normals(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.normal())
    }

    /// A direction, uniform on the sphere.
    pub(super) fn direction(&mut self) -> Vector3<f64> {
        self.normals().try_normalize(1e-9).unwrap_or_else(Vector3::z)
    }
}

/// A number in −1 to 1 that is a fixed function of two whole numbers.
pub(super) fn hashed(key: u64, index: u64) -> f64 {
    2.0 * Rng::new(key, index, "").unit() - 1.0
}

//! Random numbers by key: a draw depends on what it is for, not on what was drawn before it.
//!
//! PCG-XSH-RR (M. E. O'Neill, "PCG", Harvey Mudd College HMC-CS-2014-0905), its state from the key by
//! FNV-1a. Campaigns with equal keys have equal draws, so that they can be compared cycle by cycle.

use std::f64::consts::TAU;

const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0100_0000_01b3;
const PCG_FACTOR: u64 = 6_364_136_223_846_793_005;
/// Numbers drawn before the first use, so that keys that differ in one bit part.
const WARM_UP: usize = 4;

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub(super) struct Random {
    state: u64,
    step: u64,
}

impl Random {
    /// The stream of a purpose with some numbers, mostly that of a cycle.
    pub(super) fn of(seed: u64, purpose: &str, keys: &[u64]) -> Random {
        let numbers = [seed].into_iter().chain(keys.iter().copied());
        let bytes = purpose.bytes().chain([0]).chain(numbers.flat_map(u64::to_le_bytes));
        let hash =
            bytes.fold(FNV_OFFSET, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(FNV_PRIME));
        let mut stream = Random { state: hash, step: hash.rotate_left(29) | 1 };
        for _ in 0..WARM_UP {
            stream.bits();
        }
        stream
    }

    fn bits(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(PCG_FACTOR).wrapping_add(self.step);
        let folded = (((old >> 18) ^ old) >> 27) as u32;
        folded.rotate_right((old >> 59) as u32)
    }

    /// Uniform in 0 to 1, both excluded.
    pub(super) fn unit(&mut self) -> f64 {
        let high = f64::from(self.bits()) * f64::from(1_u32 << 21);
        let low = f64::from(self.bits() >> 11);
        (high + low + 0.5) / (1_u64 << 53) as f64
    }

    /// Uniform between two numbers.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Log-uniform between two positive numbers.
    pub(super) fn log_between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }

    pub(super) fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Uniform in 0 … count − 1; 0 for `count` = 0.
    pub(super) fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count.saturating_sub(1))
    }

    /// The index of a weight, drawn in proportion to the weights; 0 if there is none.
    pub(super) fn weighted(&mut self, weights: &[f64]) -> usize {
        let aim = self.unit() * weights.iter().sum::<f64>();
        let mut sum = 0.0;
        let reached = |weight: &f64| {
            sum += weight;
            aim < sum
        };
        weights.iter().position(reached).unwrap_or(weights.len().saturating_sub(1))
    }

    /// Standard normal (G. E. P. Box, M. E. Muller 1958).
    pub(super) fn normal(&mut self) -> f64 {
        (-2.0 * self.unit().ln()).sqrt() * (TAU * self.unit()).sin()
    }

    /// Gamma with mean 1 and a coefficient of variation of at most 1 (G. Marsaglia, W. W. Tsang 2000).
    pub(super) fn gamma(&mut self, cv: f64) -> f64 {
        let shape = 1.0 / (cv * cv).clamp(1e-6, 1.0);
        let d = shape - 1.0 / 3.0;
        loop {
            let x = self.normal();
            let v = (1.0 + x / (9.0 * d).sqrt()).powi(3);
            if v > 0.0 && self.unit().ln() < 0.5 * x * x + d - d * v + d * v.ln() {
                return d * v / shape;
            }
        }
    }

    /// Lognormal with mean 1 and a coefficient of variation.
    pub(super) fn lognormal(&mut self, cv: f64) -> f64 {
        let variance = (1.0 + cv * cv).ln();
        (variance.sqrt() * self.normal() - 0.5 * variance).exp()
    }
}

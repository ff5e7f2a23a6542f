//! Random numbers that do not depend on the version of a crate.
//!
//! Splitmix64: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number
//! generators", OOPSLA 2014.

use std::f64::consts::TAU;

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub(in crate::examine) struct Random {
    state: u64,
}

const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

impl Random {
    /// The stream of a purpose in a case; streams of different purposes are independent.
    pub(in crate::examine) fn new(seed: u64, case: u64, purpose: &str) -> Random {
        let mut state = seed;
        for word in [case, purpose.len() as u64].into_iter().chain(purpose.bytes().map(u64::from)) {
            state = mixed(state.wrapping_add(GOLDEN) ^ word.wrapping_mul(GOLDEN | 1));
        }
        Random { state }
    }

    pub(in crate::examine) fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(GOLDEN);
        mixed(self.state)
    }

    /// Uniform in \[0, 1).
    pub(in crate::examine) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform between two numbers.
    pub(in crate::examine) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Log-uniform between two positive numbers.
    pub(in crate::examine) fn log_between(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// +1 or −1.
    pub(in crate::examine) fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    pub(in crate::examine) fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Uniform in 0 … count − 1; 0 for `count` = 0.
    pub(in crate::examine) fn below(&mut self, count: usize) -> usize {
        if count == 0 { 0 } else { (self.unit() * count as f64) as usize }
    }

    /// Puts a list into random order (R. Fisher, F. Yates 1938).
    pub(in crate::examine) fn shuffle<T>(&mut self, list: &mut [T]) {
        for last in (1..list.len()).rev() {
            list.swap(last, self.below(last + 1));
        }
    }

    /// Index and name of one of the forms of a law.
    pub(in crate::examine) fn form<const N: usize>(
        &mut self,
        forms: [&'static str; N],
    ) -> (usize, &'static str) {
        let form = self.below(N);
        (form, forms[form])
    }

    /// Standard normal (G. E. P. Box, M. E. Muller 1958).
    pub(in crate::examine) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        radius * (TAU * self.unit()).cos()
    }

    /// Standard normal, truncated to ± `limit` by rejection.
    pub(in crate::examine) fn normal_within(&mut self, limit: f64) -> f64 {
        for _ in 0..64 {
            let x = self.normal();
            if x.abs() <= limit {
                return x;
            }
        }
        0.0
    }
}

fn mixed(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

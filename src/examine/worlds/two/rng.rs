//! Random numbers: xoshiro256++ (Blackman, Vigna 2019), seeded by `SplitMix64`.

use std::f64::consts::TAU;

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Rng {
    state: [u64; 4],
}

/// Increment of `SplitMix64` (golden ratio).
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;
/// Offset and prime of the FNV-1a hash.
const FNV: [u64; 2] = [0xcbf2_9ce4_8422_2325, 0x0000_0100_0000_01b3];
/// 2⁻⁵³: a step of the numbers in \[0, 1).
const STEP: f64 = 1.0 / 9_007_199_254_740_992.0;

fn mix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(GOLDEN);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

impl Rng {
    /// The stream for one purpose of one case.
    pub fn new(seed: u64, number: usize, purpose: &str) -> Self {
        let hash = purpose.bytes().fold(FNV[0], |h, b| (h ^ u64::from(b)).wrapping_mul(FNV[1]));
        let mut s = seed ^ hash.rotate_left(17) ^ (number as u64).wrapping_mul(GOLDEN);
        let state = [mix(&mut s), mix(&mut s), mix(&mut s), mix(&mut s)];
        Self { state }
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        let [a, b, c, d] = self.state;
        let out = a.wrapping_add(d).rotate_left(23).wrapping_add(a);
        let c2 = c ^ a;
        let d2 = d ^ b;
        self.state = [a ^ d2, b ^ c2, c2 ^ (b << 17), d2.rotate_left(45)];
        out
    }

    /// Uniform in \[0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * STEP
    }

    /// Uniform between two numbers.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Log-uniform between two positive numbers.
    pub fn log_range(&mut self, low: f64, high: f64) -> f64 {
        self.range(low.ln(), high.ln()).exp()
    }

    /// Standard normal (Box, Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        radius * (TAU * self.unit()).cos()
    }

    /// A whole number from 0 below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count.saturating_sub(1))
    }

    /// True with a probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// −1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// One of several values; the first where there is none at the drawn place.
    pub fn pick<T: Copy>(&mut self, values: &[T], fallback: T) -> T {
        values.get(self.below(values.len())).copied().unwrap_or(fallback)
    }
}

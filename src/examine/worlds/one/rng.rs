//! Random numbers: xoshiro256++ of D. Blackman and S. Vigna, seeded through splitmix64.

use std::f64::consts::TAU;

/// Draws of a normal number are cut here, in standard deviations: nothing absurd is drawn.
const NORMAL_CUT: f64 = 2.5;
/// Increment of splitmix64 (its authors' constant).
const SPLIT_STEP: u64 = 0x9e37_79b9_7f4a_7c15;
/// Size of one step of a number of 53 bits in 0 to 1.
const UNIT: f64 = 1.0 / 9_007_199_254_740_992.0;
/// Prime of the FNV-1a hash, which turns a purpose into a number.
const FNV_PRIME: u64 = 0x0100_0000_01b3;
/// Start of the FNV-1a hash.
const FNV_START: u64 = 0xcbf2_9ce4_8422_2325;

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Rng {
    state: [u64; 4],
}

/// One step of splitmix64.
const fn split(seed: &mut u64) -> u64 {
    *seed = seed.wrapping_add(SPLIT_STEP);
    let mut z = *seed;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A uniform number in −1 to 1 that is a fixed function of two whole numbers.
pub fn hashed(key: u64, index: u64) -> f64 {
    let mut seed = key ^ index.wrapping_mul(SPLIT_STEP);
    2.0 * ((split(&mut seed) >> 11) as f64 * UNIT) - 1.0
}

impl Rng {
    /// The stream of one purpose in one case.
    pub fn new(seed: u64, number: usize, purpose: &str) -> Self {
        let mut hash = FNV_START;
        for byte in purpose.bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(FNV_PRIME);
        }
        let mut start = seed;
        let mixed = split(&mut start) ^ (number as u64).wrapping_mul(SPLIT_STEP);
        let mut start = mixed ^ hash;
        let state = [split(&mut start), split(&mut start), split(&mut start), split(&mut start)];
        Self { state }
    }

    /// The next 64 bits.
    pub const fn next(&mut self) -> u64 {
        let s = &mut self.state;
        let out = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let t = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= t;
        s[3] = s[3].rotate_left(45);
        out
    }

    /// Uniform in 0 to 1.
    pub const fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 * UNIT
    }

    /// Uniform in a range.
    pub const fn uniform(&mut self, range: (f64, f64)) -> f64 {
        range.0 + (range.1 - range.0) * self.unit()
    }

    /// Log-uniform in a range of positive numbers.
    pub fn log(&mut self, range: (f64, f64)) -> f64 {
        range.0 * (range.1 / range.0).powf(self.unit())
    }

    /// Normal with mean 0 and deviation 1, cut at 2.5 (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.unit().max(UNIT).ln()).sqrt();
        (radius * (TAU * self.unit()).cos()).clamp(-NORMAL_CUT, NORMAL_CUT)
    }

    /// A whole number below `count`.
    pub const fn below(&mut self, count: usize) -> usize {
        if count == 0 { 0 } else { (self.next() % count as u64) as usize }
    }

    /// True with a probability.
    pub const fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// −1 or 1.
    pub const fn sign(&mut self) -> f64 {
        if self.chance(0.5) { -1.0 } else { 1.0 }
    }

    /// A uniform angle \[rad\] in −π to π.
    pub const fn angle(&mut self) -> f64 {
        TAU * (self.unit() - 0.5)
    }

    /// A direction, uniform on the sphere.
    pub fn direction(&mut self) -> nalgebra::Vector3<f64> {
        let z = self.uniform((-1.0, 1.0));
        let angle = self.angle();
        let r = (1.0 - z * z).max(0.0).sqrt();
        nalgebra::Vector3::new(r * angle.cos(), r * angle.sin(), z)
    }

    /// Index of a weight, drawn with probabilities in proportion to the weights.
    pub fn weighted(&mut self, weights: &[f64]) -> usize {
        let mut rest = self.unit() * weights.iter().sum::<f64>();
        for (index, weight) in weights.iter().enumerate() {
            if rest < *weight {
                return index;
            }
            rest -= weight;
        }
        weights.len().saturating_sub(1)
    }
}

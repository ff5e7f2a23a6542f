//! Random numbers: xoshiro256++ (Blackman, Vigna 2021), one stream for each purpose of a case.

use std::f64::consts::TAU;

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Rng {
    state: [u64; 4],
}

/// FNV-1a of 64 bit: offset basis.
const FNV_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
/// FNV-1a of 64 bit: prime.
const FNV_PRIME: u64 = 0x0100_0000_01b3;
/// Increment of splitmix64: the golden ratio times 2^64.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
/// 2^-53: the spacing of doubles in [0.5, 1).
const ULP: f64 = 1.0 / 9_007_199_254_740_992.0;

fn splitmix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(GOLDEN);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Rng {
    /// The stream of `purpose` in case `number` of `seed`.
    #[must_use]
    pub fn new(seed: u64, number: usize, purpose: &str) -> Self {
        let mut hash =
            purpose.bytes().fold(FNV_BASIS, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(FNV_PRIME));
        hash ^= seed.wrapping_mul(GOLDEN).rotate_left(17);
        hash ^= (number as u64).wrapping_mul(FNV_PRIME).rotate_left(41);
        let mut state = [0; 4];
        for word in &mut state {
            *word = splitmix(&mut hash);
        }
        Self { state }
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        let [a, b, c, d] = &mut self.state;
        let out = a.wrapping_add(*d).rotate_left(23).wrapping_add(*a);
        let shifted = *b << 17;
        *c ^= *a;
        *d ^= *b;
        *b ^= *c;
        *a ^= *d;
        *c ^= shifted;
        *d = d.rotate_left(45);
        out
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * ULP
    }

    /// Uniform between two bounds.
    pub fn range(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    /// Uniform in the logarithm between two positive bounds.
    pub fn log_range(&mut self, from: f64, to: f64) -> f64 {
        from * (to / from).powf(self.unit())
    }

    /// Standard normal (Box, Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        radius * (TAU * self.unit()).cos()
    }

    /// Normal, cut at 2.5 standard deviations: parts outside are not delivered.
    pub fn spread(&mut self, sd: f64) -> f64 {
        /// Cut in standard deviations.
        const CUT: f64 = 2.5;
        sd * self.normal().clamp(-CUT, CUT)
    }

    /// True with a probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// An integer below `count`; 0 for none.
    pub fn below(&mut self, count: usize) -> usize {
        let count = (count as u64).max(1);
        usize::try_from(self.bits() % count).unwrap_or(0)
    }

    /// An integer between two bounds, both included.
    pub fn between(&mut self, from: usize, to: usize) -> usize {
        from + self.below((to + 1).saturating_sub(from))
    }

    /// 1 or −1.
    pub fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// One of several values.
    pub fn pick<T: Copy>(&mut self, from: &[T], otherwise: T) -> T {
        from.get(self.below(from.len())).copied().unwrap_or(otherwise)
    }

    /// `count` different numbers out of a list, in the list's order.
    pub fn choose(&mut self, from: &[usize], count: usize) -> Vec<usize> {
        let mut left = from.to_vec();
        while left.len() > count.max(1) {
            let at = self.below(left.len());
            left.remove(at);
        }
        left
    }
}

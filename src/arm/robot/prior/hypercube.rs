//! A Latin hypercube of standard normal numbers.
//!
//! Each number takes each of the equally likely strata once, in a reproducible random order. Sums
//! of many numbers have a smaller sampling error than with independent draws.

/// Constants of the generator splitmix64 (G. Steele, D. Lea, C. Flood, "Fast splittable
/// pseudorandom number generators", OOPSLA 2014).
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;
const MIX: [u64; 2] = [0xbf58_476d_1ce4_e5b9, 0x94d0_49bb_1331_11eb];

struct SplitMix64(u64);

impl SplitMix64 {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(MIX[0]);
        z = (z ^ (z >> 27)).wrapping_mul(MIX[1]);
        z ^ (z >> 31)
    }

    /// A number below `end`.
    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }
}

/// `count` draws of `numbers` independent standard normal numbers, reproducible by `seed`:
/// `[number][draw]`.
#[must_use]
pub fn standard_normals(numbers: usize, count: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = SplitMix64(seed);
    let strata: Vec<f64> = (0..count).map(|i| quantile((i as f64 + 0.5) / count as f64)).collect();
    (0..numbers)
        .map(|_| {
            let mut order = strata.clone();
            for i in (1..count).rev() {
                order.swap(i, random.below(i + 1));
            }
            order
        })
        .collect()
}

/// Quantile of the standard normal distribution (P. Acklam's rational approximation, error below
/// 1.2e-9). An exact quantile would change all draws in the tenth digit.
fn quantile(p: f64) -> f64 {
    const A: [f64; 6] = [
        -3.969_683_028_665_376e1,
        2.209_460_984_245_205e2,
        -2.759_285_104_469_687e2,
        1.383_577_518_672_69e2,
        -3.066_479_806_614_716e1,
        2.506_628_277_459_239,
    ];
    const B: [f64; 5] = [
        -5.447_609_879_822_406e1,
        1.615_858_368_580_409e2,
        -1.556_989_798_598_866e2,
        6.680_131_188_771_972e1,
        -1.328_068_155_288_572e1,
    ];
    const C: [f64; 6] = [
        -7.784_894_002_430_293e-3,
        -3.223_964_580_411_365e-1,
        -2.400_758_277_161_838,
        -2.549_732_539_343_734,
        4.374_664_141_464_968,
        2.938_163_982_698_783,
    ];
    const D: [f64; 4] = [
        7.784_695_709_041_462e-3,
        3.224_671_290_700_398e-1,
        2.445_134_137_142_996,
        3.754_408_661_907_416,
    ];
    const TAIL: f64 = 0.024_25;
    let polynomial = |c: &[f64], x: f64| c.iter().fold(0.0, |sum, c| sum * x + c);
    if p < TAIL {
        let q = (-2.0 * p.ln()).sqrt();
        polynomial(&C, q) / (polynomial(&D, q) * q + 1.0)
    } else if p > 1.0 - TAIL {
        -quantile(1.0 - p)
    } else {
        let q = p - 0.5;
        let r = q * q;
        q * polynomial(&A, r) / (polynomial(&B, r) * r + 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_normal_distribution() {
        for (p, x) in
            [(0.5, 0.0), (0.975, 1.959_963_985), (0.01, -2.326_347_874), (0.8, 0.841_621_234)]
        {
            assert!((quantile(p) - x).abs() < 1e-7, "{p}");
        }
    }

    #[test]
    fn each_stratum_is_taken_once_and_numbers_are_independent() {
        let draws = standard_normals(3, 400, 7);
        for number in &draws {
            let mut sorted = number.clone();
            sorted.sort_by(f64::total_cmp);
            assert!(sorted.windows(2).all(|pair| pair[0] < pair[1]));
            let mean: f64 = number.iter().sum::<f64>() / 400.0;
            assert!(mean.abs() < 1e-12);
        }
        let product: f64 = draws[0].iter().zip(&draws[1]).map(|(a, b)| a * b).sum::<f64>() / 400.0;
        assert!(product.abs() < 0.15, "{product}");
        assert_eq!(draws, standard_normals(3, 400, 7));
    }
}

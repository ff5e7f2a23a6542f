//! Intervals of a shrink: blocks of the log drawn again and again, and other motions.
//!
//! With x = ln(1 − shrink) the half width is √((t·s)² + (z·m)²): s the deviation of x over draws of
//! long blocks (H. Künsch, "The jackknife and the bootstrap for general stationary observations",
//! Annals of Statistics 17, 1989), t Student's for so few of them, and m how much x differs from
//! one motion of a kind to another, which a single log cannot show. The upper side is wider: what
//! is left of a gap also holds what robots do differently from hour to hour.

/// A share with its 95 % interval \[1\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval {
    /// Its value.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Deviation of x from motion to motion, with which intervals of `examples/shrink_coverage.rs` hold
/// what is achieved as often as they say, and the x below which models differ too little for it.
const OF_MOTIONS: f64 = 0.3;
const ALIKE: f64 = 0.1;
/// Width of the upper side, of the lower one's.
const ABOVE: f64 = 1.5;
/// What is left of a gap at least: beyond it noise decides.
const LEFT: f64 = 1e-3;
/// 97.5 % of a normal distribution lie below.
const NORMAL: f64 = 1.959_964;
/// Quantiles that are one deviation from the middle of a normal distribution.
const DEVIATION: [f64; 2] = [0.1587, 0.8413];

/// The interval of `value`, with what it became when `blocks` blocks were drawn.
pub(super) fn interval(value: f64, drawn: &[f64], blocks: usize) -> Interval {
    let x = logarithm(value);
    let half =
        half_of_draws(value, drawn, blocks).hypot(NORMAL * OF_MOTIONS * (x.abs() / ALIKE).min(1.0));
    let end = |x: f64| 1.0 - x.exp();
    Interval { value, low: end(x + half).min(value), high: end(x - ABOVE * half).max(value) }
}

/// How many deviations over the draws a gap grows by where the shrink is below 0.
pub(super) fn growth(value: f64, drawn: &[f64], blocks: usize) -> f64 {
    NORMAL * logarithm(value) / half_of_draws(value, drawn, blocks).max(f64::MIN_POSITIVE)
}

/// Half of the width in x that the draws tell.
fn half_of_draws(value: f64, drawn: &[f64], blocks: usize) -> f64 {
    let x = logarithm(value);
    let mut all: Vec<f64> = drawn.iter().map(|value| logarithm(*value)).collect();
    all.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = (share * all.len().saturating_sub(1) as f64).round() as usize;
        all.get(place).copied().unwrap_or(x)
    };
    let count = blocks.max(2) as f64;
    let spread = 0.5 * (at(DEVIATION[1]) - at(DEVIATION[0])) * (count / (count - 1.0)).sqrt();
    student(count - 1.0) * spread
}

fn logarithm(value: f64) -> f64 {
    (1.0 - value).max(LEFT).ln()
}

/// The quantile 97.5 % of Student's distribution, by its expansion about the normal one
/// (M. Abramowitz, I. Stegun, Handbook of Mathematical Functions, 26.7.5).
fn student(freedom: f64) -> f64 {
    let z = NORMAL;
    let [z3, z5, z7] = [3, 5, 7].map(|power| z.powi(power));
    z + (z3 + z) / (4.0 * freedom)
        + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * freedom.powi(2))
        + (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * freedom.powi(3))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of printed tables.
    #[test]
    fn students_quantiles() {
        for (freedom, quantile) in [(4.0, 2.776), (9.0, 2.262), (30.0, 2.042)] {
            assert!((student(freedom) - quantile).abs() < 0.01, "{}", student(freedom));
        }
    }

    #[test]
    fn intervals_hold_their_value_and_widen_with_the_draws() {
        let near: Vec<f64> = (0..100).map(|k| 0.8 + 1e-4 * f64::from(k - 50)).collect();
        let far: Vec<f64> = (0..100).map(|k| 0.8 + 2e-3 * f64::from(k - 50)).collect();
        let [near, far] = [near, far].map(|drawn| interval(0.8, &drawn, 5));
        assert!(near.low < 0.8 && near.high > 0.8 && near.high < 1.0);
        assert!(far.low < near.low && far.high > near.high);
        // Models that are the same are so in any motion.
        let same = interval(0.0, &[0.0; 10], 5);
        assert_eq!([same.low, same.high], [0.0, 0.0]);
    }

    #[test]
    fn growth_is_in_deviations_of_the_draws() {
        let of = |value, spread: f64| {
            let drawn: Vec<f64> =
                (0..100).map(|k| value + spread * f64::from(k - 50) / 50.0).collect();
            growth(value, &drawn, 20)
        };
        assert!(of(0.2, 0.1) < 0.0 && of(-0.3, 0.1) > 1.28 && of(-0.3, 1.0) < 1.28);
        assert!(of(0.0, 0.0).abs() < 1e-9);
    }
}

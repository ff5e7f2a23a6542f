//! Confidence intervals of rates.

/// 97.5 % quantile of the standard normal distribution.
const NORMAL: f64 = 1.959_964;

/// The 95 % interval of the rate `hits` over `of` (E. B. Wilson, "Probable inference, the law of
/// succession, and statistical inference", 1927); \[0, 1\] for `of` = 0.
pub(super) fn interval(hits: usize, of: usize) -> [f64; 2] {
    if of == 0 {
        return [0.0, 1.0];
    }
    let n = of as f64;
    let rate = hits as f64 / n;
    let square = NORMAL * NORMAL;
    let middle = (rate + square / (2.0 * n)) / (1.0 + square / n);
    let half =
        NORMAL / (1.0 + square / n) * (rate * (1.0 - rate) / n + square / (4.0 * n * n)).sqrt();
    [(middle - half).max(0.0), (middle + half).min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROUNDED: f64 = 5e-4;

    /// Published examples of the interval.
    #[test]
    fn known_intervals() {
        for (hits, of, low, high) in [
            (0, 10, 0.0, 0.2775),
            (5, 10, 0.2366, 0.7634),
            (10, 10, 0.7225, 1.0),
            (1, 29, 0.0061, 0.1718),
        ] {
            let [a, b] = interval(hits, of);
            assert!(
                (a - low).abs() < ROUNDED && (b - high).abs() < ROUNDED,
                "{hits}/{of}: {a} {b}"
            );
        }
    }
}

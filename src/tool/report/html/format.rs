//! Formats figures as text.

/// Number of standard deviations to each side that contain 95 %.
pub(super) const INTERVAL: f64 = 1.96;

/// A number with `decimals` decimals and a minus sign; a dash if not finite.
pub(super) fn fixed(x: f64, decimals: usize) -> String {
    if !x.is_finite() {
        return "\u{2013}".to_owned();
    }
    let text = format!("{x:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|b| matches!(b, b'0' | b'.')) => digits.to_owned(),
        Some(digits) => format!("\u{2212}{digits}"),
        None => text,
    }
}

/// A share in %, one decimal.
pub(super) fn percent(share: f64) -> String {
    fixed(100.0 * share, 1)
}

/// s, three decimals.
pub(super) fn seconds(x: f64) -> String {
    fixed(x, 3)
}

/// J, one decimal.
pub(super) fn joules(x: f64) -> String {
    fixed(x, 1)
}

/// The saving relative to `before`, %; 0 if `before` is not positive.
pub(super) fn saved_percent(before: f64, after: f64) -> f64 {
    if before > 0.0 { 100.0 * (before - after) / before } else { 0.0 }
}

/// The smallest and the largest figure, or one figure if their texts are equal.
pub(super) fn range(values: impl IntoIterator<Item = f64>, decimals: usize) -> String {
    let (low, high) = values
        .into_iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let (low, high) = (fixed(low, decimals), fixed(high, decimals));
    if low == high { low } else { format!("{low}\u{2013}{high}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_no_negative_zero_and_no_nan() {
        assert_eq!(fixed(-0.04, 1), "0.0");
        assert_eq!(fixed(-0.06, 1), "\u{2212}0.1");
        assert_eq!(fixed(f64::NAN, 1), "\u{2013}");
        assert_eq!(range([0.25, 0.8, 0.3], 2), "0.25\u{2013}0.80");
        assert_eq!(range([0.251, 0.252], 2), "0.25");
        assert_eq!(range([], 2), "\u{2013}");
    }
}

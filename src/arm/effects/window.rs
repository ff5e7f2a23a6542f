//! Windows of time that come again in each period.

/// Whether a time is in a window, s; without a period it does not come again.
pub(super) fn within(t: f64, start: f64, end: f64, period: f64) -> bool {
    (start..=end).contains(&in_period(t, period))
}

/// The time since the start of the period, s.
pub(super) fn in_period(t: f64, period: f64) -> f64 {
    if period > 0.0 && t.is_finite() { t.rem_euclid(period) } else { t }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_come_again() {
        assert!(within(13.0, 2.5, 3.5, 10.0));
        assert!(!within(13.0, 2.5, 3.5, 0.0));
        assert!(!within(f64::INFINITY, 2.5, 3.5, 10.0));
    }
}

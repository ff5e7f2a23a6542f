//! Numbers as a controller stores and writes them.
//!
//! A `num` has single precision, and a controller that saves a module writes six to nine significant
//! digits. Such a number is the same number, although its text is another one.

/// Significant digits that controllers write.
const DIGITS: std::ops::RangeInclusive<usize> = 6..=9;

/// Whether two numbers are the same, or one is the other as a controller writes it. Whole numbers
/// are written with all digits.
pub(super) fn same(a: f64, b: f64) -> bool {
    if a == b || a.is_nan() && b.is_nan() {
        return true;
    }
    if a.fract() == 0.0 && b.fract() == 0.0 {
        return false;
    }
    let is_written = |from: f64, to: f64| {
        let stored = f64::from(from as f32);
        stored == f64::from(to as f32)
            || DIGITS
                .into_iter()
                .any(|digits| rounded(from, digits) == to || rounded(stored, digits) == to)
    };
    is_written(a, b) || is_written(b, a)
}

/// A text that is equal for numbers that differ only by the rounding of controllers, and nearly
/// always for no others.
pub(super) fn coarse(x: f64) -> String {
    let least = *DIGITS.start();
    let stored = f64::from(x as f32);
    let x = match stored {
        _ if x.fract() == 0.0 => x,
        stored if stored.is_finite() => rounded(stored, least),
        _ => rounded(x, least),
    };
    match x {
        // The usual form of an external axis that does not exist.
        9e9 => "9E9".to_owned(),
        // No negative zero.
        _ => format!("{}", x + 0.0),
    }
}

fn rounded(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits - 1).parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_of_controllers_is_no_change() {
        for (a, b) in [
            (0.866_025_403_78, 0.866_025),
            (0.866_025_403_78, 0.866_025_388),
            (123.456_789, 123.457),
            (0.1, f64::from(0.1_f32)),
            (-0.0, 0.0),
        ] {
            assert!(same(a, b) && same(b, a), "{a} {b}");
            assert_eq!(coarse(a), coarse(b));
        }
        for (a, b) in [(550.123, 550.124), (1234.567, 1234.568), (1_234_567.0, 1_234_570.0)] {
            assert!(!same(a, b), "{a} {b}");
        }
        assert_ne!(coarse(1_234_567.0), coarse(1_234_570.0));
        assert_eq!(coarse(9e9), "9E9");
    }
}

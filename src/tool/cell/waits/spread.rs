//! Medians, quantiles and spreads.

/// The deviation of a normal law over its median absolute deviation.
const PER_MAD: f64 = 1.4826;

/// Sorted finite values.
#[must_use]
pub fn sorted(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.into_iter().filter(|x| x.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// A quantile of sorted values, linear between them; NaN of none.
#[must_use]
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = share.clamp(0.0, 1.0) * last as f64;
    let low = at.floor() as usize;
    let high = (low + 1).min(last);
    sorted[low] + (at - low as f64) * (sorted[high] - sorted[low])
}

/// The median; NaN of none.
#[must_use]
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    quantile(&sorted(values), 0.5)
}

/// The standard deviation of a normal law with the same median absolute deviation; NaN of none.
#[must_use]
pub fn deviation(values: &[f64]) -> f64 {
    let middle = median(values.iter().copied());
    PER_MAD * median(values.iter().map(|x| (x - middle).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_linear_between_values() {
        let values = sorted([4.0, 1.0, 3.0, f64::NAN, 2.0]);
        assert_eq!([0.0, 0.5, 1.0].map(|share| quantile(&values, share)), [1.0, 2.5, 4.0]);
        assert!(quantile(&[], 0.5).is_nan());
        assert!((deviation(&[1.0, 2.0, 3.0, 4.0, 1e6]) - PER_MAD).abs() < 1e-12);
    }
}

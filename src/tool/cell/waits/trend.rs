//! How a wait's length changes over the hours (Theil 1950, Sen 1968).

use super::spread::{quantile, sorted};

/// Most values of which all pairs are taken.
const MAX_VALUES: usize = 300;
/// Standard deviations to each side that contain 95 %.
const INTERVAL: f64 = 1.96;

/// A slope with its 95 % interval, s/h.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trend {
    /// The median of the slopes of all pairs.
    pub per_hour_s: f64,
    /// See `per_hour_s`.
    pub low: f64,
    /// See `per_hour_s`.
    pub high: f64,
}

/// The trend of lengths, s, over times, h; `None` of fewer than three times.
#[must_use]
pub(super) fn trend(hours: &[f64], lengths: &[f64]) -> Option<Trend> {
    let step = hours.len().div_ceil(MAX_VALUES).max(1);
    let points: Vec<(f64, f64)> =
        hours.iter().copied().zip(lengths.iter().copied()).step_by(step).collect();
    let mut slopes = Vec::new();
    for (index, (x, y)) in points.iter().enumerate() {
        let later = points[index + 1..].iter().filter(|(other, _)| other > x);
        slopes.extend(later.map(|(other_x, other_y)| (other_y - y) / (other_x - x)));
    }
    let slopes = sorted(slopes);
    if slopes.len() < 3 {
        return None;
    }
    // Kendall's S has the variance n (n − 1) (2 n + 5) / 18.
    let n = points.len() as f64;
    let half =
        INTERVAL * (n * (n - 1.0) * (2.0 * n + 5.0) / 18.0).sqrt() / slopes.len() as f64 / 2.0;
    Some(Trend {
        per_hour_s: quantile(&slopes, 0.5),
        low: quantile(&slopes, 0.5 - half),
        high: quantile(&slopes, 0.5 + half),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stop_of_minutes_changes_no_trend() {
        let hours: Vec<f64> = (0..200).map(|i| f64::from(i) / 60.0).collect();
        let noise = |i: usize| ((i as f64 * 78.233).sin() * 43_758.545).fract();
        let mut lengths: Vec<f64> =
            hours.iter().enumerate().map(|(i, h)| 5.0 + 0.4 * h + 0.3 * noise(i)).collect();
        lengths[77] = 400.0;
        let found = trend(&hours, &lengths).expect("a trend");
        assert!(found.low < 0.4 && 0.4 < found.high, "{found:?}");
        assert!(found.low > 0.3 && found.high < 0.5, "{found:?}");
        assert_eq!(trend(&hours[..2], &lengths[..2]), None);
    }
}

//! Axes with round ticks.

/// A range with ticks at multiples of 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    low: f64,
    high: f64,
    step: f64,
    decimals: usize,
}

/// Rounding of a value in units of a step.
const ROUNDING: f64 = 1e-6;

impl Scale {
    /// The smallest scale that contains `low` to `high`, has about `count` ticks and ends at ticks.
    pub fn new(low: f64, high: f64, count: usize) -> Scale {
        let scale = Scale::exact(low, high, count);
        let step = scale.step;
        Scale {
            low: (scale.low / step + ROUNDING).floor() * step,
            high: (scale.high / step - ROUNDING).ceil() * step,
            ..scale
        }
    }

    /// The scale from `low` to `high` with about `count` ticks. Values that are not finite count as
    /// 0; an empty range is widened.
    pub fn exact(low: f64, high: f64, count: usize) -> Scale {
        let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
        let (low, high) = (finite(low).min(finite(high)), finite(low).max(finite(high)));
        // A smaller relative range is rounding.
        let least = 1e-9 * low.abs().max(high.abs()).max(1.0);
        let (low, high) = if high - low < least { (low - 0.5, high + 0.5) } else { (low, high) };
        let raw = (high - low) / count.max(1) as f64;
        let exponent = raw.log10().floor();
        let power = 10_f64.powf(exponent);
        let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * power >= raw * 0.999).unwrap_or(10.0);
        let step = factor * power;
        let decimals = if factor == 10.0 { -exponent - 1.0 } else { -exponent };
        Scale { low, high, step, decimals: decimals.clamp(0.0, 12.0) as usize }
    }

    /// The range of `values` and 0.
    pub fn with_zero(values: impl IntoIterator<Item = f64>, count: usize) -> Scale {
        let (low, high) = values
            .into_iter()
            .filter(|x| x.is_finite())
            .fold((0.0_f64, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
        Scale::new(low, high, count)
    }

    /// Relative position of `x`: 0 at the low end, 1 at the high end.
    pub fn share(&self, x: f64) -> f64 {
        (x - self.low) / (self.high - self.low)
    }

    /// The ticks with their labels.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let first = (self.low / self.step - ROUNDING).ceil();
        let last = (self.high / self.step + ROUNDING).floor();
        let count = (last - first).max(0.0) as usize;
        (0..=count)
            .map(|i| {
                // Avoids -0.
                let x = (first + i as f64) * self.step + 0.0;
                (x, format!("{x:.*}", self.decimals).replace('-', "\u{2212}"))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64) -> Vec<String> {
        Scale::new(low, high, 5).ticks().into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_hold_the_range() {
        assert_eq!(labels(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(-73.0, 41.0), ["\u{2212}100", "\u{2212}50", "0", "50"]);
        assert_eq!(labels(0.0, 0.004), ["0.000", "0.001", "0.002", "0.003", "0.004"]);
        assert_eq!(labels(0.0, 1234.0), ["0", "500", "1000", "1500"]);
        let exact = Scale::exact(0.3, 2.04, 4).ticks();
        assert_eq!(
            exact.into_iter().map(|(_, label)| label).collect::<Vec<_>>(),
            ["0.5", "1.0", "1.5", "2.0"]
        );
    }

    #[test]
    fn any_range_gives_a_scale_that_holds_it() {
        let ends = [-1e12, -3.7, -1e-7, 0.0, 2e-9, 0.3, 99.999, 5e9];
        for low in ends {
            for high in ends {
                for count in 1..9 {
                    let scale = Scale::new(low, high, count);
                    let slack = 1e-5 * scale.step;
                    assert!(scale.low <= low.min(high) + slack, "{low} {high} {scale:?}");
                    assert!(scale.high >= low.max(high) - slack, "{low} {high} {scale:?}");
                    assert!((2..=2 * count + 3).contains(&scale.ticks().len()), "{scale:?}");
                }
            }
        }
    }

    #[test]
    fn what_is_not_finite_gives_a_scale() {
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(Scale::new(x, x, 5).share(0.0).is_finite());
            assert!(Scale::with_zero([x, 2.0], 5).high >= 2.0);
        }
    }
}

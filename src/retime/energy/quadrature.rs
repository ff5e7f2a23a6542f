//! Time integrals of powers that are smooth except for a few kinks.
//!
//! Gauss–Legendre rules on intervals of adaptive length. Three of the five points form a rule of
//! degree 3; the difference of both rules estimates the error of an interval.

/// Longest initial interval, s: a kink near an end of a longer one could be missed.
const FIRST: f64 = 0.06;
/// Longest interval where powers hardly change, s.
const LONGEST: f64 = 0.24;
/// Change of a power (W) times the interval length (s) up to which the next interval may be longer,
/// J: missing a kink of this slope near an end costs a thousandth of it.
const QUIET_J: f64 = 4.0;
/// Most intervals of an integral; powers that slow change little in each.
const MOST: f64 = 2000.0;
/// Length below which an interval is not halved, s.
const FINE: f64 = 0.024;
/// Length up to which two points suffice, s.
const SHORT: f64 = 0.01;
/// Difference of the two rules above which an interval is halved, J; the error of the finer rule is
/// far smaller.
const UNEVEN_J: f64 = 0.01;
/// Difference below which the next interval is twice as long, J.
const EVEN_J: f64 = 0.5 * UNEVEN_J;

/// Points on [−1, 1] with their weights.
const TWO: [(f64, f64); 2] = [(-0.577_350_269_189_625_8, 1.0), (0.577_350_269_189_625_8, 1.0)];
const THREE: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];
const FIVE: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];
/// Weights of the rule of degree 3 at the first, third and fifth of the five points.
const OUTER: f64 = 1.0 / (3.0 * 0.906_179_845_938_664 * 0.906_179_845_938_664);
const CUBIC: [f64; 5] = [OUTER, 0.0, 2.0 - 2.0 * OUTER, 0.0, OUTER];

/// N powers over time, W.
pub(super) trait Powers<const N: usize> {
    /// The powers at these times (s).
    fn at<const K: usize>(&self, times: [f64; K]) -> [[f64; N]; K];
}

/// The integrals of `powers` (W) between two times (s), J.
pub(super) fn integral<const N: usize>(from: f64, to: f64, powers: &impl Powers<N>) -> [f64; N] {
    let mut sum = [0.0; N];
    let [first, longest] = [FIRST, LONGEST].map(|most| most.max((to - from) / MOST));
    let (mut begin, mut length) = (from, first);
    while begin < to {
        let left = to - begin;
        // Equal intervals on the rest, so that the last one is not short.
        let h = left / (left / length).ceil();
        if h <= FINE {
            let part = if h <= SHORT {
                rule(&TWO, begin, h, powers)
            } else {
                rule(&THREE, begin, h, powers)
            };
            add(&mut sum, &part);
            length *= 2.0;
        } else {
            let Estimate { part, off, change } = estimate(begin, h, powers);
            if off > UNEVEN_J {
                length = 0.5 * h;
                continue;
            }
            add(&mut sum, &part);
            let most = if change * h < QUIET_J { longest } else { first };
            length = if off < EVEN_J { (2.0 * h).min(most).max(h) } else { h };
        }
        begin = if h < left { begin + h } else { to };
    }
    sum
}

fn add<const N: usize>(sum: &mut [f64; N], part: &[f64; N]) {
    for (sum, part) in sum.iter_mut().zip(part) {
        *sum += part;
    }
}

fn rule<const N: usize, const K: usize>(
    points: &[(f64, f64); K],
    begin: f64,
    h: f64,
    powers: &impl Powers<N>,
) -> [f64; N] {
    let mut sum = [0.0; N];
    let values = powers.at(points.map(|(x, _)| begin + 0.5 * h * (1.0 + x)));
    for (power, (_, w)) in values.into_iter().zip(points) {
        add(&mut sum, &power.map(|power| 0.5 * h * w * power));
    }
    sum
}

/// The integrals by the five-point rule and their error estimate.
struct Estimate<const N: usize> {
    /// The integrals, J.
    part: [f64; N],
    /// Difference from the other rule, J.
    off: f64,
    /// The largest change of a power between the points, W.
    change: f64,
}

fn estimate<const N: usize>(begin: f64, h: f64, powers: &impl Powers<N>) -> Estimate<N> {
    let mut part = [0.0; N];
    let mut off = [0.0; N];
    let mut least = [f64::INFINITY; N];
    let mut most = [f64::NEG_INFINITY; N];
    let values = powers.at(FIVE.map(|(x, _)| begin + 0.5 * h * (1.0 + x)));
    for ((power, (_, w)), cubic) in values.into_iter().zip(FIVE).zip(CUBIC) {
        for (i, power) in power.into_iter().enumerate() {
            part[i] += 0.5 * h * w * power;
            off[i] += 0.5 * h * (w - cubic) * power;
            least[i] = least[i].min(power);
            most[i] = most[i].max(power);
        }
    }
    let off = off.iter().map(|off| off.abs()).sum();
    let change = (0..N).map(|i| most[i] - least[i]).fold(0.0, f64::max);
    Estimate { part, off, change }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// Powers with a count of their evaluations.
    struct Counted<F>(F, Cell<usize>);

    impl<const N: usize, F: Fn(f64) -> [f64; N]> Powers<N> for Counted<F> {
        fn at<const K: usize>(&self, times: [f64; K]) -> [[f64; N]; K] {
            self.1.set(self.1.get() + K);
            times.map(&self.0)
        }
    }

    /// Value and number of evaluations.
    fn counted(from: f64, to: f64, power: impl Fn(f64) -> f64) -> (f64, usize) {
        beside(from, to, |t| [power(t), 0.0])
    }

    /// The same for the first of two powers.
    fn beside(from: f64, to: f64, powers: impl Fn(f64) -> [f64; 2]) -> (f64, usize) {
        let counted = Counted(powers, Cell::new(0));
        let [sum, _] = integral(from, to, &counted);
        (sum, counted.1.get())
    }

    #[test]
    fn smooth_powers_take_few_points() {
        let (sum, count) = counted(0.0, 1.0, |t| 500.0 * t.powi(3) - 80.0 * t + 3.0);
        assert!((sum - (125.0 - 40.0 + 3.0)).abs() < 1e-9, "{sum}");
        assert!(count <= 90, "{count}");
    }

    #[test]
    fn kinks_shorten_the_intervals() {
        // Braking loss of a power that changes from braking to driving at 10 kW/s.
        for kink in [0.11, 0.29, 0.437, 0.5, 0.7723] {
            let driving = |t: f64| 1e4 * (t - kink);
            let (sum, count) = beside(0.0, 1.0, |t| [driving(t).max(0.0), driving(t)]);
            let exact = 5e3 * (1.0 - kink) * (1.0 - kink);
            assert!((sum - exact).abs() < 0.05, "{kink}: {sum} {exact}");
            assert!(count <= 130, "{count}");
        }
    }

    #[test]
    fn vibration_is_resolved() {
        let (sum, _) = counted(0.0, 2.0, |t| 300.0 * (60.0 * t).sin().powi(2));
        let exact = 300.0 * (1.0 - (240.0_f64).sin() / 240.0);
        assert!((sum - exact).abs() < 0.05, "{sum} {exact}");
    }

    #[test]
    fn an_empty_interval_has_no_integral() {
        assert_eq!(counted(0.3, 0.3, |_| 7.0), (0.0, 0));
    }
}

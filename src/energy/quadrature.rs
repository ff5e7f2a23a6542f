//! Integrals over time of powers that are smooth but for a few kinks.
//!
//! Gauss-Legendre rules on intervals that are as long as the powers are even. The rule with five
//! points holds three that make a rule of degree 3; the difference of both tells whether an
//! interval is too long.

/// Longest interval, s: a kink near its end may be passed over.
const LONGEST: f64 = 0.06;
/// Most intervals of one stretch: what is so slow changes little in each.
const MOST: f64 = 2000.0;
/// An interval that is not halved, s.
const FINE: f64 = 0.02;
/// An interval in which no power bends, s.
const SHORT: f64 = 0.006;
/// Difference of the two rules above which an interval is halved, J.
const UNEVEN_J: f64 = 0.001;
/// The same below which the next interval is twice as long, J: the difference grows at least 32
/// times where powers are smooth.
const EVEN_J: f64 = UNEVEN_J / 32.0;

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

/// The integrals of `powers` (W) over a stretch of time (s), J.
pub(super) fn integral<const N: usize>(
    from: f64,
    to: f64,
    mut powers: impl FnMut(f64) -> [f64; N],
) -> [f64; N] {
    let mut sum = [0.0; N];
    let longest = LONGEST.max((to - from) / MOST);
    let (mut begin, mut length) = (from, longest);
    while begin < to {
        let left = to - begin;
        // Equal intervals on what is left: no short one at the end.
        let h = left / (left / length).ceil();
        if h <= FINE {
            let part = if h <= SHORT {
                rule(&TWO, begin, h, &mut powers)
            } else {
                rule(&THREE, begin, h, &mut powers)
            };
            add(&mut sum, &part);
            length *= 2.0;
        } else {
            let (part, off) = judged(begin, h, &mut powers);
            if off > UNEVEN_J {
                length = 0.5 * h;
                continue;
            }
            add(&mut sum, &part);
            length = if off < EVEN_J { (2.0 * h).min(longest) } else { h };
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

fn rule<const N: usize>(
    points: &[(f64, f64)],
    begin: f64,
    h: f64,
    powers: &mut impl FnMut(f64) -> [f64; N],
) -> [f64; N] {
    let mut sum = [0.0; N];
    for (x, w) in points {
        add(&mut sum, &powers(begin + 0.5 * h * (1.0 + x)).map(|power| 0.5 * h * w * power));
    }
    sum
}

/// The rule with five points, and by how much the other one differs, J.
fn judged<const N: usize>(
    begin: f64,
    h: f64,
    powers: &mut impl FnMut(f64) -> [f64; N],
) -> ([f64; N], f64) {
    let mut sum = [0.0; N];
    let mut off = [0.0; N];
    for ((x, w), cubic) in FIVE.iter().zip(CUBIC) {
        let power = powers(begin + 0.5 * h * (1.0 + x));
        add(&mut sum, &power.map(|power| 0.5 * h * w * power));
        add(&mut off, &power.map(|power| 0.5 * h * (w - cubic) * power));
    }
    (sum, off.iter().map(|off| off.abs()).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Value and number of evaluations.
    fn counted(from: f64, to: f64, power: impl Fn(f64) -> f64) -> (f64, usize) {
        let mut count = 0;
        let [sum] = integral(from, to, |t| {
            count += 1;
            [power(t)]
        });
        (sum, count)
    }

    #[test]
    fn smooth_powers_take_few_points() {
        let (sum, count) = counted(0.0, 1.0, |t| 500.0 * t.powi(3) - 80.0 * t + 3.0);
        assert!((sum - (125.0 - 40.0 + 3.0)).abs() < 1e-9, "{sum}");
        assert!(count <= 90, "{count}");
    }

    #[test]
    fn kinks_are_looked_at_closely() {
        // Power that turns from braking to driving at 10 kW/s.
        for kink in [0.11, 0.29, 0.437, 0.5, 0.7723] {
            let (sum, count) = counted(0.0, 1.0, |t| 1e4 * (t - kink).max(0.0));
            let exact = 5e3 * (1.0 - kink) * (1.0 - kink);
            assert!((sum - exact).abs() < 0.05, "{kink}: {sum} {exact}");
            assert!(count <= 130, "{count}");
        }
    }

    #[test]
    fn vibration_is_not_passed_over() {
        let (sum, _) = counted(0.0, 2.0, |t| 300.0 * (60.0 * t).sin().powi(2));
        let exact = 300.0 * (1.0 - (240.0_f64).sin() / 240.0);
        assert!((sum - exact).abs() < 0.05, "{sum} {exact}");
    }

    #[test]
    fn nothing_is_the_integral_over_no_time() {
        assert_eq!(counted(0.3, 0.3, |_| 7.0), (0.0, 0));
    }
}

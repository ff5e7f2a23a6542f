//! Predictive density of a time from the same time in the cycles around it.
//!
//! `f(x) = (1 − ε) Σ_j m_j k((x − x_j)/h)/h + ε/T`: a kernel estimate with Student's law of three degrees
//! of freedom, so that a stop of minutes counts as one rare cycle, and a share ε spread over a cycle's
//! time T. Where a wait found what it waits for already there, only an upper bound of the time is known.
//! The masses `m_j` are then those of Kaplan and Meier (1958) for values that are censored from above.

use std::f64::consts::PI;

use super::spread::{median, quantile, sorted};

/// Share of times that are nothing like those around them.
const RARE: f64 = 0.02;
/// Least width of the kernel, s, and in steps of the clock: rounding of the robot's coming makes a wait
/// shorter and the time before it longer, which must tell nothing.
const LEAST_WIDTH_S: f64 = 0.005;
const LEAST_STEPS: f64 = 2.0;
/// Silverman's width for a normal law, and the quarter quantile of `|x_i − x_j|` over its deviation.
const SILVERMAN: f64 = 1.06;
const QUARTER: f64 = 0.4506;

/// A time, or what is known of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Known {
    /// s.
    Exact(f64),
    /// It is no later, s.
    AtMost(f64),
}

impl Known {
    /// It and its bound, later by `by`.
    pub(super) fn later(self, by: f64) -> Known {
        match self {
            Known::Exact(x) => Known::Exact(x + by),
            Known::AtMost(x) => Known::AtMost(x + by),
        }
    }

    fn value(self) -> f64 {
        match self {
            Known::Exact(x) | Known::AtMost(x) => x,
        }
    }
}

/// Width of the kernel for values that follow each other, of which `count` are seen at once, s.
///
/// The quarter quantile of the differences is that of one population where there are two.
pub(super) fn width(values: impl Iterator<Item = f64>, count: usize, step_s: f64) -> f64 {
    let values: Vec<f64> = values.collect();
    let differences = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let quarter = quantile(&sorted(differences), 0.25);
    let deviation = if quarter.is_finite() { quarter / QUARTER } else { 0.0 };
    (SILVERMAN * deviation * (count.max(2) as f64).powf(-0.2))
        .max(LEAST_WIDTH_S)
        .max(LEAST_STEPS * step_s)
}

/// How much later the times get per cycle: the median over pairs half the window apart. `times` are
/// positions and values in order of position, s per cycle.
pub(super) fn trend(times: &[(f64, Known)]) -> f64 {
    let half = times.len() / 2;
    let pairs = times.iter().zip(&times[half..]).filter_map(|(a, b)| match (a.1, b.1) {
        (Known::Exact(first), Known::Exact(last)) if b.0 > a.0 => {
            Some((last - first) / (b.0 - a.0))
        }
        _ => None,
    });
    let trend = median(pairs);
    if trend.is_finite() { trend } else { 0.0 }
}

/// ln of the density of a known time, or of the probability that it is early enough.
pub(super) fn log_density(x: Known, others: &mut [Known], width: f64, cycle_s: f64) -> f64 {
    let is_bounded = others.iter().any(|of| matches!(of, Known::AtMost(_)));
    others.sort_by(|a, b| {
        // Without bounds all masses are equal.
        if !is_bounded {
            return std::cmp::Ordering::Equal;
        }
        let exact_first = |of: &Known| matches!(of, Known::AtMost(_));
        b.value().total_cmp(&a.value()).then(exact_first(a).cmp(&exact_first(b)))
    });
    // What has a smaller value than all that were passed.
    let mut below = 1.0;
    let mut sum = 0.0;
    for (index, other) in others.iter().enumerate() {
        let Known::Exact(value) = other else { continue };
        let mass = below / (others.len() - index) as f64;
        below -= mass;
        let z = (x.value() - value) / width;
        sum += mass
            * match x {
                Known::Exact(_) => kernel(z) / width,
                Known::AtMost(_) => cumulative(z),
            };
    }
    match x {
        Known::Exact(_) => ((1.0 - RARE) * sum + RARE / cycle_s).ln(),
        Known::AtMost(_) => ((1.0 - RARE) * (sum + below) + 0.5 * RARE).ln(),
    }
}

/// Student's density with three degrees of freedom.
fn kernel(z: f64) -> f64 {
    let of = 1.0 + z * z / 3.0;
    2.0 / (PI * 3.0_f64.sqrt() * of * of)
}

/// Its integral.
fn cumulative(z: f64) -> f64 {
    let u = z / 3.0_f64.sqrt();
    0.5 + (u / (1.0 + u * u) + u.atan()) / PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernel_is_the_slope_of_its_integral() {
        for z in [-4.0, -0.5, 0.0, 1.0, 7.0] {
            let slope = (cumulative(z + 1e-5) - cumulative(z - 1e-5)) / 2e-5;
            assert!((slope - kernel(z)).abs() < 1e-8, "{z}");
        }
    }

    #[test]
    fn masses_are_those_of_kaplan_and_meier() {
        // Of 10, ≤ 8, 6 and ≤ 3: 10 has a quarter; 6 half of the rest; the other half is below.
        let others =
            [Known::AtMost(3.0), Known::Exact(10.0), Known::AtMost(8.0), Known::Exact(6.0)];
        let below = |x: f64| log_density(Known::AtMost(x), &mut others.clone(), 1e-4, 60.0).exp();
        assert!((below(9.0) - (0.98 * 0.75 + 0.01)).abs() < 1e-3);
        assert!((below(5.0) - (0.98 * 0.375 + 0.01)).abs() < 1e-3);
    }

    #[test]
    fn the_width_is_that_of_one_of_two_populations() {
        let jitter = |i: usize| 0.1 * ((i as f64 * 12.9898).sin() * 43_758.545).fract();
        let two = width((0..400).map(|i| jitter(i) + if i % 7 < 3 { 40.0 } else { 60.0 }), 40, 0.0);
        let one = width((0..400).map(jitter), 40, 0.0);
        assert!(two < 3.0 * one, "{two} {one}");
    }
}

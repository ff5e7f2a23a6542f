//! Intervals of a stream, chosen from the third derivative of the motion.
//!
//! The error of a quadratic spline with spacing h is at most h³ |q⃛| √3/216 (the peak of the third
//! Bernoulli polynomial over 3!). Spacing h = (ε 216/(√3 |q⃛|))^⅓ makes the error uniform.

use super::stream_reference::Reference;
use crate::retime::motion::stream::{DOF, Joints};

/// Error of a quadratic spline over h³ |q⃛|.
const ERROR_CONSTANT: f64 = 0.008_018_753_738_744_8;
/// Distance of the polygon of the points from the quadratic spline over h² |q̈⊥|, with q̈⊥ the
/// acceleration across the path.
const POLYGON_CONSTANT: f64 = 0.125;
/// Samples of the density per shortest interval.
const SAMPLES: f64 = 5.0;
/// Largest change of the spacing along the motion, s/s: neighbours differ by at most a third.
const SMOOTHNESS: f64 = 0.3;
/// Fewest intervals if the duration permits them: rest, motion, rest.
const FEWEST: f64 = 4.0;

/// Largest number of intervals, independent of the shortest one.
const MOST: f64 = 1e4;

/// Limits on the intervals of a stream and accepted errors of its motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spacing {
    /// Shortest interval, s.
    pub shortest: f64,
    /// The same where the polygon needs closer points, s.
    pub closest: f64,
    /// Longest interval, s; infinite if only the error limits it.
    pub longest: f64,
    /// Accepted error of the spline, in lever units.
    pub tolerance: f64,
    /// Accepted distance of the polygon of the points from the motion, in lever units.
    pub polygon: f64,
    /// Weight of each joint in the error: 1 for radians, its distance to the TCP for metres.
    pub lever: Joints,
}

impl Default for Spacing {
    fn default() -> Spacing {
        Spacing {
            shortest: 0.05,
            closest: 0.04,
            longest: f64::INFINITY,
            tolerance: 1e-4,
            polygon: f64::INFINITY,
            lever: [1.0; DOF],
        }
    }
}

/// Intervals, s, with the sum `duration` for a stream that follows `reference` in that time. None
/// is below the shortest (the closest where the polygon needs it), unless the whole duration is, or
/// much above the longest.
pub fn adaptive_intervals(reference: &Reference, duration: f64, spacing: &Spacing) -> Vec<f64> {
    let [shortest, closest] = [spacing.shortest, spacing.closest].map(|s| s.max(duration / MOST));
    if !(duration > 2.0 * shortest && duration.is_finite()) {
        return vec![duration];
    }
    let count = (duration / shortest * SAMPLES).ceil() as usize;
    let step = duration / count as f64;
    let longest = (duration / FEWEST).min(spacing.longest).max(shortest);
    let stretch = reference.duration() / duration;
    let velocity = |t: f64| reference.at(t * stretch).1.map(|v| v * stretch);
    let mut width: Vec<f64> = (0..count)
        .map(|i| {
            let t = (i as f64 + 0.5) * step;
            let [before, here, after] = [t - shortest, t, t + shortest].map(velocity);
            let jerk = (0..DOF)
                .map(|j| spacing.lever[j] * (after[j] - 2.0 * here[j] + before[j]))
                .map(|change| (change / (shortest * shortest)).powi(2))
                .sum::<f64>()
                .sqrt();
            let close = (spacing.tolerance / (ERROR_CONSTANT * jerk)).cbrt();
            let turn = turn(&spacing.lever, &here, &before, &after) / (2.0 * shortest);
            let beside = (spacing.polygon / (POLYGON_CONSTANT * turn)).sqrt();
            close.clamp(shortest, longest).min(beside.max(closest))
        })
        .collect();
    for i in 1..count {
        width[i] = width[i].min(width[i - 1] + SMOOTHNESS * step);
        let back = count - 1 - i;
        width[back] = width[back].min(width[back + 1] + SMOOTHNESS * step);
    }
    // Equal shares of Σ step/width, each at least 1, so that no interval is below the shortest one.
    let total: f64 = width.iter().map(|w| step / w).sum();
    let points = total.floor().max(1.0);
    let share = total / points;
    let (mut intervals, mut passed, mut begin) = (Vec::new(), 0.0, 0.0);
    for (i, w) in width.iter().enumerate() {
        let mass = step / w;
        let next = share * (intervals.len() + 1) as f64;
        if passed + mass >= next && (intervals.len() + 1) as f64 + 0.5 < points {
            let at = step * (i as f64 + (next - passed) / mass);
            intervals.push(at - begin);
            begin = at;
        }
        passed += mass;
    }
    intervals.push(duration - begin);
    intervals
}

/// The component of a velocity change across the velocity, weighted by the levers.
fn turn(lever: &Joints, here: &Joints, before: &Joints, after: &Joints) -> f64 {
    let change: Joints = std::array::from_fn(|j| lever[j] * (after[j] - before[j]));
    let along: Joints = std::array::from_fn(|j| lever[j] * here[j]);
    let dot = |a: &Joints, b: &Joints| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let square = dot(&along, &along);
    let share = if square > 0.0 { dot(&change, &along) / square } else { 0.0 };
    let across: Joints = std::array::from_fn(|j| change[j] - share * along[j]);
    dot(&across, &across).sqrt()
}

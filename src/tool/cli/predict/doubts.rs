//! Indications that a logged motion has unexpected units.

use crate::arm::robot::Model;
use crate::learn::log::Motion;

/// Tolerance outside a joint's range \[rad\].
const RANGE_TOLERANCE: f64 = 0.2;
/// Maximum ratio of logged speed to speed limit.
const MAX_SPEED_RATIO: f64 = 1.5;
/// Maximum row interval for differentiation \[s\].
const MAX_INTERVAL: f64 = 0.5;
/// Minimum ratio of the position change to the integral of the rates.
const MIN_TURN_RATIO: f64 = 0.05;
/// Figures from here on are shown with an exponent.
const HUGE: f64 = 1e9;

/// The warnings, each with a remedy.
pub(super) fn doubts(model: &Model, motion: &Motion) -> Vec<String> {
    let mut found: Vec<String> =
        (0..model.dof).filter_map(|joint| position(model, motion, joint)).collect();
    found.extend((0..model.dof).filter_map(|joint| speed(model, motion, joint)));
    found.extend(time(motion));
    found
}

fn position(model: &Model, motion: &Motion, joint: usize) -> Option<String> {
    let wider = model.limits.position_if.iter().filter(|wider| wider.joint == joint);
    let [low, high] = wider.fold(model.limits.position[joint], |[low, high], wider| {
        [low.min(wider.position[0]), high.max(wider.position[1])]
    });
    let (row, q) = farthest(&motion.q[joint])?;
    (q < low - RANGE_TOLERANCE || q > high + RANGE_TOLERANCE).then(|| {
        format!(
            "q{n} is {} rad in row {}, outside {low:.3} to {high:.3} rad; name the column q{n}_deg \
             if it is in degrees",
            figure(q),
            motion.rows[row],
            n = joint + 1
        )
    })
}

fn speed(model: &Model, motion: &Motion, joint: usize) -> Option<String> {
    let most = *model.limits.velocity.as_ref()?.get(joint)?;
    let (row, qd) = farthest(&motion.qd[joint])?;
    (qd.abs() > MAX_SPEED_RATIO * most).then(|| {
        format!(
            "joint {} turns at {} rad/s in row {}, the robot at most at {most:.3}; t is in \
             seconds, angles are in radians",
            joint + 1,
            figure(qd),
            motion.rows[row],
        )
    })
}

fn time(motion: &Motion) -> Option<String> {
    let mut intervals: Vec<f64> = motion.time.windows(2).map(|t| t[1] - t[0]).collect();
    let (mut turned, mut stated) = (0.0, 0.0);
    for (q, qd) in motion.q.iter().zip(&motion.qd) {
        for (i, interval) in intervals.iter().enumerate() {
            turned += (q[i + 1] - q[i]).abs();
            stated += 0.5 * (qd[i] + qd[i + 1]).abs() * interval;
        }
    }
    intervals.sort_by(f64::total_cmp);
    let middle = *intervals.get(intervals.len() / 2)?;
    let sparse = !motion.differentiated.is_empty() && middle > MAX_INTERVAL;
    (sparse || turned < MIN_TURN_RATIO * stated).then(|| {
        format!(
            "rows are {middle} s apart; t is in seconds, divide it by 1000 if it is in milliseconds"
        )
    })
}

fn figure(value: f64) -> String {
    if value.abs() < HUGE { format!("{value:.3}") } else { format!("{value:.3e}") }
}

/// The row of the largest absolute value, and the value.
fn farthest(values: &[f64]) -> Option<(usize, f64)> {
    values.iter().copied().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
}

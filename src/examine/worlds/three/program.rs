//! A random program of joint moves.

use super::arm::Arm;
use super::spatial::flange;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::program::Move;
use crate::examine::worlds::random::Rng;

/// Speeds of the controller \[m/s\].
const SPEEDS: [f64; 14] = [0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0];
/// Zones of the controller \[m\].
const ZONES: [f64; 9] = [0.001, 0.005, 0.01, 0.02, 0.03, 0.05, 0.08, 0.1, 0.15];
/// Parts into which a path is cut to find its length.
const PARTS: usize = 16;

/// Length of the tool's path \[m\] of a joint move.
pub(super) fn path(arm: &Arm, from: &Row, to: &Row) -> f64 {
    let at = |part: usize| {
        let share = part as f64 / PARTS as f64;
        let q: Row = std::array::from_fn(|i| from[i] + share * (to[i] - from[i]));
        flange(&arm.joints, &q).0
    };
    (0..PARTS).map(|part| (at(part + 1) - at(part)).norm()).sum()
}

/// An angle of two decimals of a degree, as taught points have.
fn taught(angle: f64) -> f64 {
    ((angle.to_degrees() * 100.0).round() / 100.0).to_radians()
}

fn pose(arm: &Arm, rng: &mut Rng) -> Row {
    let mut out = [0.0; MAX];
    for (i, value) in out.iter_mut().enumerate().take(arm.axes()) {
        *value = taught(arm.middle[i] + 0.9 * arm.span[i] * rng.between(-1.0, 1.0));
    }
    out
}

/// Random moves that end at their start; the last one stops.
pub(super) fn moves(arm: &Arm, rng: &mut Rng) -> Vec<Move> {
    let count = rng.whole(5, 12);
    let home = pose(arm, rng);
    let mut now = home;
    let mut out = Vec::new();
    for k in 1..=count {
        let mut to = if k == count { home } else { pose(arm, rng) };
        if k < count && rng.chance(0.35) {
            // Approach or retreat: a short move of some axes.
            to = now;
            for i in 1..arm.axes().min(5) {
                let (middle, span) = (arm.middle[i], arm.span[i]);
                let angle = to[i] + 0.3 * span * rng.between(-1.0, 1.0);
                to[i] = taught(angle.clamp(middle - span, middle + span));
            }
        }
        // Speeds that take 0.4 to 2 s.
        let wanted = path(arm, &now, &to) / rng.log_between(0.4, 2.0);
        let speed = SPEEDS.iter().copied().filter(|speed| *speed <= wanted).fold(0.1, f64::max);
        let stop = k == count || rng.chance(0.35);
        let zone = if stop { 0.0 } else { rng.pick(&ZONES) };
        let waits = stop && rng.chance(0.45);
        let wait = if waits { (rng.between(0.2, 1.5) * 10.0).round() / 10.0 } else { 0.0 };
        out.push(Move { to, speed, zone, wait });
        now = to;
    }
    out
}

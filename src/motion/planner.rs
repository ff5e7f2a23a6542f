//! The timing that the controller gives to a path.
//!
//! The fastest motion within the speeds, accelerations and torques, then a
//! moving average over the time in which the acceleration builds up
//! (docs/controller.md has the measurements).

use std::sync::Arc;

use super::controller::Planning;
use super::sampling::{self, Loaded, SpeedCap};
use super::smooth::{Cubic, moving_average};
use super::timed::TimedMotion;
use super::timing::grid::PathGrid;
use super::timing::limits::PathLimits;
use super::timing::profile::Profile;
use super::timing::reachability::time_optimal;
use crate::path::JointPath;
use crate::path::joint_path::{DOF, Joints};

/// Intervals of the grid for one path, besides those of its zones.
const INTERVALS: usize = 64;
/// Passes that lower the speed where the average breaks an acceleration limit.
const CORRECTIONS: usize = 3;
/// Halvings of the search for a speed that makes a move last as long as its `\T` says.
const HALVINGS: usize = 30;

/// What a path may not exceed under the settings in force.
#[derive(Clone, Debug)]
pub struct MotionLimits {
    /// rad/s².
    pub acceleration: Joints,
    /// Nm, infinite where the robot has no dynamics.
    pub torque: Joints,
}

/// Why a path has no timing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("no timing within the limits was found for the path")]
pub struct NoTiming;

/// The controller's motion along a path.
///
/// `caps` holds the speed limits by leg; `time` the duration that `\T` asks for.
///
/// # Errors
/// [`NoTiming`]: the robot can't even stand still within its torque limits.
pub fn plan(
    loaded: Loaded<'_>,
    path: &Arc<JointPath>,
    caps: &[SpeedCap],
    limits: &MotionLimits,
    planning: &Planning,
    time: Option<f64>,
) -> Result<TimedMotion, NoTiming> {
    let fastest = timing(loaded, path, caps, limits, planning)?;
    let duration = |pieces: &[Cubic]| pieces.last().map_or(0.0, |p| p.t + p.duration);
    let Some(time) = time else {
        return Ok(TimedMotion::Path(path.clone(), fastest));
    };
    if duration(&fastest) >= time {
        return Ok(TimedMotion::Path(path.clone(), fastest));
    }
    // Slower caps until it lasts as long as asked.
    let (mut low, mut high) = (0.0, 1.0);
    let mut best = fastest;
    let reference = path.length() / time;
    for _ in 0..HALVINGS {
        let share: f64 = 0.5 * (low + high);
        // Up to ten times the mean speed, over which a cap has no effect worth searching for.
        let cap = 10.0 * reference * share;
        let slowed: Vec<SpeedCap> = caps
            .iter()
            .enumerate()
            .map(|(leg, c)| {
                let rate = if path.legs().contains(&leg) {
                    let e = path.extent(leg);
                    (e.length / e.extent).max(1e-9)
                } else {
                    1.0
                };
                SpeedCap { tcp: c.tcp.min(cap * rate), orientation: c.orientation }
            })
            .collect();
        let pieces = timing(loaded, path, &slowed, limits, planning)?;
        if duration(&pieces) > time {
            low = share;
        } else {
            high = share;
        }
        best = pieces;
    }
    let stretch = time / duration(&best);
    Ok(TimedMotion::Path(path.clone(), stretched(best, stretch)))
}

/// The same motion in `factor` times the time; factors near 1 only.
fn stretched(pieces: Vec<Cubic>, factor: f64) -> Vec<Cubic> {
    let scale = |p: Cubic| {
        let [s, v, a, j] = p.state;
        Cubic {
            t: p.t * factor,
            duration: p.duration * factor,
            state: [s, v / factor, a / factor.powi(2), j / factor.powi(3)],
        }
    };
    pieces.into_iter().map(scale).collect()
}

fn timing(
    loaded: Loaded<'_>,
    path: &Arc<JointPath>,
    caps: &[SpeedCap],
    limits: &MotionLimits,
    planning: &Planning,
) -> Result<Vec<Cubic>, NoTiming> {
    let nodes = sampling::nodes(path, INTERVALS);
    let path_limits = PathLimits::new(limits.acceleration, limits.torque).map_err(|_| NoTiming)?;
    // The moving average must keep the programmed speeds too.
    let mut grid = sampling::grid(loaded, path, &nodes, caps)
        .map_err(|_| NoTiming)?
        .holding(0.5 * planning.ramp_s, 0.0);
    // Always as many passes: to stop at a threshold would make the time jump with the start.
    for _ in 0..CORRECTIONS {
        let profile = time_optimal(&grid, &path_limits).into_profile().ok_or(NoTiming)?;
        let pieces = smoothed(&profile, planning.ramp_s);
        grid = slowed(path, &grid, &pieces, limits).ok_or(NoTiming)?;
    }
    let profile = time_optimal(&grid, &path_limits).into_profile().ok_or(NoTiming)?;
    Ok(smoothed(&profile, planning.ramp_s))
}

fn smoothed(profile: &Profile, ramp: f64) -> Vec<Cubic> {
    let speeds: Vec<f64> = profile.b().iter().map(|b| b.max(0.0).sqrt()).collect();
    moving_average(profile.times(), &speeds, ramp)
}

/// The grid with lower speeds where the smoothed motion breaks an acceleration limit.
fn slowed(
    path: &Arc<JointPath>,
    grid: &PathGrid,
    pieces: &[Cubic],
    limits: &MotionLimits,
) -> Option<PathGrid> {
    let motion = TimedMotion::Path(path.clone(), pieces.to_vec());
    let s = grid.s();
    let mut ratio = vec![1.0_f64; grid.intervals()];
    for piece in pieces {
        // Inside the stretches: at their ends lie nodes, where rounding would decide the interval.
        for share in [0.25, 0.75] {
            let tau = share * piece.duration;
            let at = piece.at(tau)[0];
            let qdd = motion.at(piece.t + tau).qdd;
            let excess =
                (0..DOF).map(|j| qdd[j].abs() / limits.acceleration[j]).fold(0.0, f64::max);
            let k = s.partition_point(|x| *x <= at).clamp(1, ratio.len()) - 1;
            ratio[k] = ratio[k].max(excess);
        }
    }
    let mut ends = grid.ends().to_vec();
    for (k, pair) in ends.iter_mut().enumerate() {
        // A neighbourhood, since the average mixes neighbouring speeds.
        let lo = k.saturating_sub(1);
        let hi = (k + 1).min(ratio.len() - 1);
        let excess = ratio[lo].max(ratio[k]).max(ratio[hi]);
        if excess > 1.0 {
            let at = [s[k], s[k + 1]];
            for (end, at) in pair.iter_mut().zip(at) {
                let speed = motion.path_speed(motion.time_at(at));
                // At rest there is no speed to lower.
                if speed > 0.0 {
                    end.v_max = end.v_max.min(speed / excess.sqrt());
                }
            }
        }
    }
    PathGrid::new(s.to_vec(), ends).ok()
}

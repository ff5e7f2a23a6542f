//! The timing that the controller gives to a path.
//!
//! The fastest motion within the speeds, accelerations and torques, then a
//! moving average over the time in which the acceleration builds up
//! (docs/controller.md has the measurements).

use std::sync::Arc;

use super::averaged::Averaged;
use super::controller::Planning;
use super::sampling::{self, Loaded, SpeedCap};
use super::timed::TimedMotion;
use super::timing::grid::PathGrid;
use super::timing::limits::PathLimits;
use super::timing::profile::Profile;
use super::timing::reachability::time_optimal;
use crate::path::JointPath;
use crate::path::joint_path::Joints;

/// Intervals of the grid for one path, besides those of its zones.
const INTERVALS: usize = 48;
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
    let nodes = sampling::nodes(path, INTERVALS);
    let grid = sampling::grid(loaded, path, &nodes, caps).map_err(|_| NoTiming)?;
    let limits = PathLimits::new(limits.acceleration, limits.torque).map_err(|_| NoTiming)?;
    let fastest = time_optimal(&grid, &limits).into_profile().ok_or(NoTiming)?;
    let longer = planning.average.window - planning.average.closing;
    let profile = match time {
        Some(time) if fastest.duration() + longer < time => {
            slowed(&grid, &limits, fastest, time - longer)?
        }
        _ => fastest,
    };
    let timing = Averaged::new(path, profile, planning.average);
    Ok(TimedMotion::Path(path.clone(), Box::new(timing)))
}

/// The motion that takes `time` by an even lower speed, found by bisection of its cap.
fn slowed(
    grid: &PathGrid,
    limits: &PathLimits,
    fastest: Profile,
    time: f64,
) -> Result<Profile, NoTiming> {
    let speeds = fastest.b().iter().copied().fold(0.0, f64::max).sqrt();
    // Below the mean speed no cap lets the motion end in time.
    let (mut low, mut high) = (grid.length() / time, speeds);
    let mut best = fastest;
    for _ in 0..HALVINGS {
        let cap = 0.5 * (low + high);
        let profile = time_optimal(&grid.capped(cap), limits).into_profile().ok_or(NoTiming)?;
        if profile.duration() > time {
            low = cap;
        } else {
            high = cap;
            best = profile;
        }
    }
    best.scaled_to(time).ok_or(NoTiming)
}

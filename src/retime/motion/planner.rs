//! The timing of a path by the controller.
//!
//! The fastest motion within speeds, accelerations and torques, then a moving average over the rise
//! time of the acceleration (docs/controller.md has the measurements).

use std::sync::Arc;

use super::averaged::Averaged;
use super::controller::{MotionLimits, Planning};
use super::leg_times::{TimedLeg, timed_profile};
use super::pace::{Pace, pace};
use super::sampling::{self, Loaded, SpeedCap};
use super::tcp_limits;
use super::timed::TimedMotion;
use super::timing::limits::PathLimits;
use super::timing::profile::Profile;
use super::timing::reachability::time_optimal;
use crate::retime::path::JointPath;

/// Grid intervals of one path, in addition to those of its zones.
const INTERVALS: usize = 48;

/// A path has no timing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("no timing within the limits was found for the path")]
pub struct NoTiming;

/// The motion of the controller along a path and the limiting quantity of each leg.
///
/// `caps` are the speed limits per leg; `times` the `\T` per leg (s).
///
/// # Errors
/// [`NoTiming`]: the holding torque exceeds the torque limits.
pub fn plan(
    loaded: Loaded<'_>,
    path: &Arc<JointPath>,
    caps: &[SpeedCap],
    limits: &MotionLimits,
    planning: &Planning,
    times: &[Option<f64>],
) -> Result<(TimedMotion, Vec<Pace>), NoTiming> {
    let nodes = sampling::nodes(loaded.model, path, caps, INTERVALS);
    let limits = PathLimits::new(limits.acceleration, limits.torque).map_err(|_| NoTiming)?;
    let task = Task { loaded, path, nodes: &nodes, limits: &limits, planning, times };
    let mut planned = task.plan(caps)?;
    if !tcp_limits::limited(&caps[path.legs()]) {
        return Ok(planned);
    }
    // A leg whose excess a tighter limit does not lower keeps the limit of the round before: the
    // excess comes from the average over a place where the TCP turns back.
    let mut tightened = caps.to_vec();
    let mut before = tightened.clone();
    let mut hoped = vec![f64::INFINITY; caps.len()];
    let mut lowers = vec![true; caps.len()];
    for _ in 0..TIGHTENINGS {
        let worst = tcp_limits::worst(loaded.model, path, caps, &planned.0);
        let legs: Vec<usize> = path.legs().collect();
        let mut undone = false;
        for (i, leg) in legs.iter().enumerate() {
            if worst[i] > hoped[i] && lowers[i] {
                lowers[i] = false;
                tightened[*leg] = before[*leg];
                undone = true;
            }
        }
        let excess = |i: usize| {
            let excess = worst.get(i).copied().filter(|x| *x > 1.0 + TCP_TOLERANCE);
            excess.filter(|_| lowers[i])
        };
        if (0..worst.len()).all(|i| excess(i).is_none()) && !undone {
            break;
        }
        before.clone_from(&tightened);
        for (i, leg) in legs.iter().enumerate().filter(|(i, _)| lowers[*i]) {
            // Both legs of a corner affect its acceleration.
            let around = [i.checked_sub(1), Some(i), Some(i + 1)].into_iter().flatten();
            let Some(worst) = around.filter_map(excess).max_by(f64::total_cmp) else { continue };
            let factor = (1.0 - TIGHTER) / worst;
            let cap = &mut tightened[*leg];
            cap.path_acceleration = cap.path_acceleration.map(|x| x * factor);
            cap.world_acceleration *= factor;
            // At least half of what was asked, on a logarithmic scale.
            hoped[i] = excess(i).map_or(f64::INFINITY, |own| own * factor.sqrt());
        }
        planned = task.plan(&tightened)?;
    }
    Ok(planned)
}

/// Largest number of rounds that tighten the limits on the TCP acceleration.
const TIGHTENINGS: usize = 6;
/// Additional tightening per round, so that few rounds suffice.
const TIGHTER: f64 = 0.01;
/// Accepted relative excess of the TCP acceleration.
const TCP_TOLERANCE: f64 = 1e-3;

struct Task<'a> {
    loaded: Loaded<'a>,
    path: &'a Arc<JointPath>,
    nodes: &'a [f64],
    limits: &'a PathLimits,
    planning: &'a Planning,
    times: &'a [Option<f64>],
}

impl Task<'_> {
    fn plan(&self, caps: &[SpeedCap]) -> Result<(TimedMotion, Vec<Pace>), NoTiming> {
        let Task { path, limits, planning, .. } = self;
        let grid = sampling::grid(self.loaded, path, self.nodes, caps).map_err(|_| NoTiming)?;
        let fastest = time_optimal(&grid, limits).into_profile().ok_or(NoTiming)?;
        let asked = &self.times[path.legs()];
        let profile = if asked.iter().any(Option::is_some) {
            let legs = self.timed_legs();
            let profile = timed_profile(&grid, limits, &legs, fastest).ok_or(NoTiming)?;
            exact(profile, &legs)
        } else {
            fastest
        };
        let mut begin = 0.0;
        let last = path.legs().end - 1;
        let paces = path.legs().map(|leg| {
            let end = path.leg_end(leg);
            let took = profile.time_at(end) - profile.time_at(begin);
            let smoothing = self.smoothing(leg);
            let pace = match self.times[leg] {
                Some(time) if took + smoothing <= time * (1.0 + TIME_KEPT) => Pace::Time,
                _ if leg == last || took > 0.0 => {
                    pace(&grid, limits, &profile, begin..end, smoothing)
                }
                _ => Pace::None,
            };
            begin = end;
            pace
        });
        let paces = paces.collect();
        // Free the large grid before the average is computed.
        drop(grid);
        let timing = Averaged::new(path, profile, planning.average);
        Ok((TimedMotion::Path((*path).clone(), Box::new(timing)), paces))
    }

    /// Time that the average adds to a leg with a start or end at rest, s.
    fn smoothing(&self, leg: usize) -> f64 {
        let average = &self.planning.average;
        let legs = self.path.legs();
        let first = if leg == legs.start { 0.5 * average.window } else { 0.0 };
        let last = if leg + 1 == legs.end { 0.5 * average.window - average.closing } else { 0.0 };
        first + last
    }

    fn timed_legs(&self) -> Vec<TimedLeg> {
        let path = self.path;
        let leg = |leg: usize| TimedLeg {
            end: path.leg_end(leg),
            time: self.times[leg].map(|time| (time - self.smoothing(leg)).max(0.0)),
        };
        path.legs().map(leg).collect()
    }
}

/// Accepted relative excess over `\T`.
const TIME_KEPT: f64 = 1e-3;

/// The profile scaled to the exact time of its legs, if all are timed and it is not slower.
fn exact(profile: Profile, legs: &[TimedLeg]) -> Profile {
    let time: Option<f64> = legs.iter().map(|leg| leg.time).sum();
    match time {
        Some(time) if profile.duration() <= time => profile.scaled_to(time).unwrap_or(profile),
        _ => profile,
    }
}

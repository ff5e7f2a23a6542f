//! The limit that determines the speed of a movement.

use std::ops::Range;

use super::timing::grid::{PathGrid, SpeedBound};
use super::timing::limits::{PathLimits, RowKind, tightest_row};
use super::timing::profile::Profile;

/// The limit that holds over the longest time of a movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pace {
    /// The movement takes no time.
    None,
    /// A speed bound.
    Speed(SpeedBound),
    /// Joint accelerations and their rise time.
    Acceleration,
    /// Joint torques.
    Torque,
    /// `PathAccLim` or `WorldAccLim`.
    TcpAcceleration,
    /// Its `\T`.
    Time,
    /// The path cannot be followed: the time is an estimate.
    Estimated,
}

impl Pace {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Pace::None | Pace::Speed(SpeedBound::None) => "none",
            Pace::Speed(SpeedBound::Programmed) => "speed",
            Pace::Speed(SpeedBound::Reorientation) => "reorientation",
            Pace::Speed(SpeedBound::Joint) => "joint-speed",
            Pace::Speed(SpeedBound::Robot) => "robot-tcp-speed",
            Pace::Speed(SpeedBound::Zone) => "zone",
            Pace::Acceleration => "acceleration",
            Pace::Torque => "torque",
            Pace::TcpAcceleration => "tcp-acceleration",
            Pace::Time => "time",
            Pace::Estimated => "estimated",
        }
    }
}

/// Share of a speed bound from which it is reached.
const REACHED: f64 = 0.98;

/// The limit that holds over the longest time on the nodes in `range` of s; `smoothing` (s) is the
/// time that the rise of the acceleration adds.
pub fn pace(
    grid: &PathGrid,
    limits: &PathLimits,
    profile: &Profile,
    range: Range<f64>,
    smoothing: f64,
) -> Pace {
    let (s, b, t) = (profile.s(), profile.b(), profile.times());
    let first = s.partition_point(|x| *x <= range.start).saturating_sub(1);
    let last = s.partition_point(|x| *x < range.end).max(first + 1).min(grid.intervals());
    let mut spent: Vec<(Pace, f64)> = vec![(Pace::Acceleration, smoothing)];
    for k in first..last {
        let pair = &grid.ends()[k];
        let ends = [0, 1].map(|end| b[k + end].sqrt() / pair[end].v_max);
        let end = usize::from(ends[1] > ends[0]);
        let pace = if ends[end] >= REACHED {
            Pace::Speed(pair[end].v_bound)
        } else {
            match tightest_row(grid, limits, b, k) {
                RowKind::Acceleration => Pace::Acceleration,
                RowKind::Torque => Pace::Torque,
                RowKind::Tcp => Pace::TcpAcceleration,
            }
        };
        let time = t[k + 1] - t[k];
        match spent.iter_mut().find(|(found, _)| *found == pace) {
            Some((_, sum)) => *sum += time,
            None => spent.push((pace, time)),
        }
    }
    spent.iter().fold((Pace::None, 0.0), |most, now| if now.1 > most.1 { *now } else { most }).0
}

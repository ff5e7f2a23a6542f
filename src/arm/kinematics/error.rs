//! Why a pose has no joint angles.

use thiserror::Error;

use super::conf::Conf;

/// Degrees from which on angles are shown with an exponent.
const HUGE: f64 = 1e9;

fn degrees(angle: f64) -> String {
    let degrees = angle.to_degrees();
    if degrees.abs() < HUGE { format!("{degrees:.3}") } else { format!("{degrees:.3e}") }
}

/// A joint angle outside its range.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "joint {} would be at {} deg, outside {:.3} to {:.3} deg",
    .joint + 1, degrees(*.value), .range[0].to_degrees(), .range[1].to_degrees()
)]
pub struct LimitViolation {
    /// The joint, from 0.
    pub joint: usize,
    /// Its angle \[rad\].
    pub value: f64,
    /// Its range \[rad\].
    pub range: [f64; 2],
}

/// Why the inverse kinematics has no answer.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum IkError {
    /// The arm is too short or too long for the pose.
    #[error("the pose is out of reach: the wrist centre lies {:.1} mm {side} the arm's reach", .distance * 1e3)]
    Unreachable {
        /// Distance of the wrist centre from the reachable set \[m\].
        distance: f64,
        /// On which side.
        side: Side,
    },
    /// The pose is not one.
    #[error("the pose has a coordinate that is not a finite number; correct the target")]
    NotFinite,
    /// The pose can only be had outside a joint's range.
    #[error(transparent)]
    OutsideLimits(#[from] LimitViolation),
    /// No solution has the configuration.
    #[error(
        "no solution has the configuration {asked}; the pose has {}; ConfJ\\Off and ConfL\\Off take \
         the nearest",
        list(found)
    )]
    ConfigurationNotFound {
        /// The configuration asked for.
        asked: Conf,
        /// Those that the pose has, inside the joints' ranges.
        found: Vec<Conf>,
    },
    /// The search found nothing.
    #[error("no joint angles of {robot} have the pose: it is out of reach, or nearly so")]
    NotFound {
        /// The robot.
        robot: String,
    },
    /// The robot has fewer or more joints than a pose has coordinates.
    #[error("{robot} has not six joints, so poses have no joint angles; give jointtargets")]
    NoInverse {
        /// The robot.
        robot: String,
    },
}

/// Side of the reachable set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Too far away.
    Beyond,
    /// Too near.
    Inside,
}

impl std::fmt::Display for Side {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Side::Beyond => "beyond",
            Side::Inside => "inside",
        })
    }
}

fn list(found: &[Conf]) -> String {
    if found.is_empty() {
        return "none inside the joints' ranges".into();
    }
    found.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
}

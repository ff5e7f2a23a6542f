//! Reasons why a pose has no joint angles.

use thiserror::Error;

use super::conf::Conf;

/// Angles from this size on have an exponent in messages \[degrees\].
const EXPONENT_FROM: f64 = 1e9;

fn degrees(angle: f64) -> String {
    let degrees = angle.to_degrees();
    if degrees.abs() < EXPONENT_FROM { format!("{degrees:.3}") } else { format!("{degrees:.3e}") }
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

/// Reason why the inverse kinematics has no solution.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum IkError {
    /// The arm is too short or too long for the pose.
    #[error("the pose is out of reach: the wrist centre lies {:.1} mm {side} the arm's reach", .distance * 1e3)]
    Unreachable {
        /// Distance of the wrist centre from the reachable set \[m\].
        distance: f64,
        /// Its side.
        side: Side,
    },
    /// The pose is not finite.
    #[error("the pose has a coordinate that is not a finite number; correct the target")]
    NotFinite,
    /// All solutions of the pose are outside a joint range.
    #[error(transparent)]
    OutsideLimits(#[from] LimitViolation),
    /// No solution has the configuration.
    #[error(
        "no solution has the configuration {asked}; the pose has {}; ConfJ\\Off and ConfL\\Off take \
         the nearest",
        list(found)
    )]
    ConfigurationNotFound {
        /// The required configuration.
        asked: Conf,
        /// The configurations of the pose within the joint ranges.
        found: Vec<Conf>,
    },
    /// The numerical search found no solution.
    #[error("no joint angles of {robot} have the pose: it is out of reach, or nearly so")]
    NotFound {
        /// The robot.
        robot: String,
    },
    /// The robot does not have six joints.
    #[error("{robot} has not six joints, so poses have no joint angles; give jointtargets")]
    NoInverse {
        /// The robot.
        robot: String,
    },
}

/// Side of the reachable set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Too far.
    Beyond,
    /// Too close.
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

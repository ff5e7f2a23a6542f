//! Legs of a run: one movement each, with its ends solved.

use nalgebra::Isometry3;

use super::joint_path::{DOF, Joints};
use crate::arm::kinematics::Tcp;
use crate::rapid::ir::movement::{Speed, Zone};

/// The geometry of a leg.
#[derive(Clone, Debug)]
pub enum LegKind {
    /// Straight in joint space.
    Joint,
    /// Straight line of the TCP.
    Line,
    /// Circular arc of the TCP through this pose.
    Arc(Isometry3<f64>),
}

/// One movement of a run.
#[derive(Clone, Debug)]
pub struct Leg {
    /// Its geometry.
    pub kind: LegKind,
    /// Joints at its start, rad.
    pub start: Joints,
    /// Joints at its programmed end, rad, in the configuration that the program states. A Cartesian
    /// leg has to arrive in it.
    pub end: Joints,
    /// Where the TCP is fixed, m.
    pub tool: Tcp,
    /// Target pose of the TCP, seen from the robot's base frame or, of a stationary tool, from
    /// tool0; for a joint leg the pose at `end`.
    pub target: Isometry3<f64>,
    /// True where the wrist of a line or arc is interpolated axis by axis (`SingArea\Wrist`).
    pub axiswise: bool,
    /// Programmed speed.
    pub speed: Speed,
    /// Zone at its end.
    pub zone: Zone,
}

/// Largest difference of a joint between the programmed end and the end reached along a
/// line that still counts as the same, rad.
pub const SAME_JOINTS: f64 = 1e-3;

/// Why a run has no path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PathError {
    /// Part of a line can't be reached.
    #[error("the path leaves the robot's reach or limits {percent:.0} % along the move: {why}")]
    Unreachable {
        /// Index of the leg.
        leg: usize,
        /// How far along.
        percent: f64,
        /// From the inverse kinematics.
        why: String,
    },
    /// A line passes through or next to a singularity.
    #[error("the line passes a singularity {percent:.0} % along the move")]
    Singular {
        /// Index of the leg.
        leg: usize,
        /// How far along.
        percent: f64,
    },
    /// A line ends in another configuration than the target states.
    #[error("the line ends in another configuration than its target states (axis {joint})")]
    Configuration {
        /// Index of the leg.
        leg: usize,
        /// First axis that differs, from 1.
        joint: usize,
    },
    /// Three points of an arc on a line.
    #[error("the three points of the arc lie on a line or in one point")]
    FlatArc {
        /// Index of the leg.
        leg: usize,
    },
}

impl PathError {
    /// Index of the leg that fails.
    pub fn leg(&self) -> usize {
        match self {
            PathError::Unreachable { leg, .. }
            | PathError::Singular { leg, .. }
            | PathError::Configuration { leg, .. }
            | PathError::FlatArc { leg } => *leg,
        }
    }
}

/// The first joint (from 1) that differs by more than [`SAME_JOINTS`].
pub fn first_difference(a: &Joints, b: &Joints) -> Option<usize> {
    (0..DOF).find(|&j| (a[j] - b[j]).abs() > SAME_JOINTS).map(|j| j + 1)
}

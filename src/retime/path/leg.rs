//! Legs of a run: one movement each, with the joint angles of its ends.

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
    /// Joint angles at its start, rad.
    pub start: Joints,
    /// Joint angles at its programmed end, rad, in the programmed configuration. A Cartesian leg
    /// must arrive in this configuration.
    pub end: Joints,
    /// The TCP, m.
    pub tool: Tcp,
    /// Target pose of the TCP in the base frame or, for a stationary tool, in tool0; for a joint
    /// leg the pose at `end`.
    pub target: Isometry3<f64>,
    /// True if the wrist of a line or arc is interpolated axis by axis (`SingArea\Wrist`).
    pub axiswise: bool,
    /// Programmed speed.
    pub speed: Speed,
    /// Zone at its end.
    pub zone: Zone,
}

/// Largest joint difference between the programmed end and the end reached along a line, rad.
pub const SAME_JOINTS: f64 = 1e-3;

/// Reason why a run has no path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PathError {
    /// Part of a line cannot be reached.
    #[error("the path leaves the robot's reach or limits {percent:.0} % along the move: {why}")]
    Unreachable {
        /// Index of the leg.
        leg: usize,
        /// Position on the leg, percent.
        percent: f64,
        /// Message of the inverse kinematics.
        why: String,
    },
    /// A line passes through or near a singularity.
    #[error("the line passes a singularity {percent:.0} % along the move")]
    Singular {
        /// Index of the leg.
        leg: usize,
        /// Position on the leg, percent.
        percent: f64,
    },
    /// A line ends in another configuration than that of the target.
    #[error("the line ends in another configuration than its target states (axis {joint})")]
    Configuration {
        /// Index of the leg.
        leg: usize,
        /// First different axis, from 1.
        joint: usize,
    },
    /// The three points of an arc are collinear.
    #[error("the three points of the arc lie on a line or in one point")]
    FlatArc {
        /// Index of the leg.
        leg: usize,
    },
}

impl PathError {
    /// Index of the failed leg.
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

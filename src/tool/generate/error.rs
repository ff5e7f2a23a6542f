//! Errors of the generation.

use crate::arm::kinematics::{IkError, LimitViolation};
use crate::tool::emit::EmitError;

/// Errors of the generation.
#[derive(Debug, thiserror::Error)]
pub enum GenerateError {
    /// The robot has another number of joints, or its model is incomplete.
    #[error("{robot} {what}")]
    Robot {
        /// Its name.
        robot: String,
        /// The problem and its remedy.
        what: String,
    },
    /// Externally guided motion needs times.
    #[error("--as egm needs a timed trajectory: give a column t beside q1..q6")]
    EgmWithoutTime,
    /// A trajectory needs joint targets or EGM.
    #[error(
        "a timed trajectory becomes joint targets: give --as absj or egm, or leave out the column t"
    )]
    TimedPoses,
    /// A position is out of range.
    #[error("row {row}: {violation}; if the columns are degrees, name them q1_deg … q6_deg")]
    Range {
        /// Line of the file.
        row: usize,
        /// The violated limit.
        violation: LimitViolation,
    },
    /// A pose is out of reach, or not reachable in this configuration.
    #[error("row {row}: {error}")]
    Pose {
        /// Line of the file.
        row: usize,
        /// Why.
        error: IkError,
    },
    /// A name is not predefined in RAPID.
    #[error("row {row}: '{name}' is not a predefined {what} of RAPID; give {example}, or a number")]
    Name {
        /// Line of the file.
        row: usize,
        /// As given.
        name: String,
        /// `speed` or `zone`.
        what: &'static str,
        /// Valid names.
        example: &'static str,
    },
    /// A trajectory does not start or end at rest.
    #[error(
        "the trajectory {end} with {speed:.3} rad/s in joint {joint}; a program starts and ends at \
         rest: add a ramp"
    )]
    Moving {
        /// `starts` or `ends`.
        end: &'static str,
        /// From 1.
        joint: usize,
        /// rad/s.
        speed: f64,
    },
    /// A trajectory exceeds a limit.
    #[error("the trajectory can't be followed: {what}; make it {factor:.2} times as long or more")]
    TooFast {
        /// The exceeded limit.
        what: String,
        /// Minimum stretch of its times.
        factor: f64,
    },
    /// The point spacing is too coarse.
    #[error(
        "with points {spacing} s apart the robot would be {distance_mm:.2} mm from the trajectory; \
         give a smaller --spacing, or a smoother trajectory"
    )]
    Coarse {
        /// s.
        spacing: f64,
        /// mm.
        distance_mm: f64,
    },
    /// A template failed.
    #[error(transparent)]
    Emit(#[from] EmitError),
    /// The emitted text fails its verification.
    #[error("the generated program failed its verification, and nothing is written: {0}")]
    Verification(String),
}

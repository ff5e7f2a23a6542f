//! Errors of the generation.

use super::follow::FollowError;
use super::moves::MovesError;
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
    /// The trajectory cannot be followed.
    #[error(transparent)]
    Follow(#[from] FollowError),
    /// A point cannot be reached.
    #[error(transparent)]
    Moves(#[from] MovesError),
    /// A template failed.
    #[error(transparent)]
    Emit(#[from] EmitError),
    /// The emitted text fails its verification.
    #[error("nothing is written, as the emitted program did not hold: {0}")]
    Verification(String),
}

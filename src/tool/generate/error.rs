//! Why nothing is generated.

use super::follow::FollowError;
use super::moves::MovesError;
use crate::tool::emit::EmitError;

/// Why nothing is generated.
#[derive(Debug, thiserror::Error)]
pub enum GenerateError {
    /// The robot is of another kind, or lacks something.
    #[error("{robot} {what}")]
    Robot {
        /// Its name.
        robot: String,
        /// What is wrong, with the way out.
        what: String,
    },
    /// Externally guided motion needs times.
    #[error("--as egm needs a timed trajectory: give a column t beside q1..q6")]
    EgmWithoutTime,
    /// A trajectory becomes a stream.
    #[error(
        "a timed trajectory becomes joint targets: give --as absj or egm, or leave out the column t"
    )]
    TimedPoses,
    /// The trajectory can't be followed.
    #[error(transparent)]
    Follow(#[from] FollowError),
    /// A point can't be reached.
    #[error(transparent)]
    Moves(#[from] MovesError),
    /// A template failed.
    #[error(transparent)]
    Emit(#[from] EmitError),
    /// The emitted text does not do what it should.
    #[error("nothing is written, as the emitted program did not hold: {0}")]
    Verification(String),
}

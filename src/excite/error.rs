//! Why there is no excitation.

use thiserror::Error;

/// Input that no excitation can be designed for.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ExciteError {
    /// The robot lacks a limit.
    #[error("{name} has no {what}: give it in the robot file ([limits])")]
    Lacks {
        /// The robot.
        name: String,
        /// The limit.
        what: &'static str,
    },
    /// No motion keeps all limits.
    #[error(
        "no motion was found that keeps all limits and clear of itself, of planes and boxes: move these, or give a smaller --speed-share or --load"
    )]
    Nowhere,
    /// No room for a test at its pose.
    #[error(
        "there is no room to move around this pose within joint ranges, above the floor and clear of the arm: give another --start"
    )]
    NoRoom,
}

//! Errors of the design of excitation motions.

use thiserror::Error;

/// Error of the design of an excitation motion.
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
        "no motion was found that keeps all limits and clear of itself, of planes and boxes: move these, or allow lower speeds (--speed-share of joulepath excite, [limits] of the robot) or a smaller --load"
    )]
    Nowhere,
    /// No room for a stream test at its pose.
    #[error(
        "no test of at least 1.7 degrees keeps joint ranges, half of the speed and acceleration limits, clear of the floor and of the arm around this pose: give another --start"
    )]
    NoRoom,
}

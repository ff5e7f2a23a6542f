//! What makes an identification impossible.

use thiserror::Error;

/// Input that no model can be identified from.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum IdentifyError {
    /// The log is too short for its filter.
    #[error("the log has no piece of {seconds:.2} s without a gap: record longer")]
    Short {
        /// What is needed \[s\].
        seconds: f64,
    },
    /// Fewer equations than unknowns.
    #[error(
        "{equations} usable equations for {unknowns} parameters: record longer, or free fewer with --free"
    )]
    TooFew {
        /// Rows.
        equations: usize,
        /// Columns.
        unknowns: usize,
    },
    /// What is not free is not known.
    #[error(
        "{name} has no dynamics to start from: give its links, [[link]], in a robot file, or identify all with --free all"
    )]
    NoDynamics {
        /// The robot.
        name: String,
    },
    /// No body fits.
    #[error("no physically consistent model was found: the links of the robot file are no bodies, leave them out")]
    Inconsistent,
}

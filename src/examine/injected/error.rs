//! Logs to which no effect can be added.

use thiserror::Error;

use crate::learn::identify::IdentifyError;

/// Logs to which no effect can be added.
#[derive(Debug, Error)]
pub enum InjectError {
    /// No model can be identified from the log, or its torques cannot be read.
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    /// The log cannot be cut into three parts that excite all joints.
    #[error(
        "{robot}: no three parts of the log move all joints; give a longer log, or one in which \
         all joints move all the time"
    )]
    Short {
        /// Name of the robot.
        robot: String,
    },
    /// No effect has a visible size in any of the logs.
    #[error(
        "no effect can be seen in these logs with a usual size: give a log of a faster motion, or \
         of a robot whose torques are less noisy"
    )]
    Invisible,
    /// No logs.
    #[error("no logs are given: name robots and their logs")]
    NoLogs,
}

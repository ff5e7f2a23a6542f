//! Errors of a placement.

use crate::tool::retrofit::RetrofitError;

/// Why no placement can be searched for.
#[derive(Debug, thiserror::Error)]
pub enum PlaceError {
    /// An option that cannot be read.
    #[error(
        "--move {text}: {reason}; write it as NAME:AXIS=LOW..HIGH,… with the axes x, y, z (mm) and \
         rx, ry, rz (degrees), such as wobjTable:x=-200..200,rz=-30..30; NAME is a wobjdata, a \
         tooldata or base, or several of them with + between"
    )]
    Option {
        /// The option as given.
        text: String,
        /// What is wrong.
        reason: String,
    },
    /// A frame that cannot be moved.
    #[error("--move {name}: {reason}")]
    Frame {
        /// Its name.
        name: String,
        /// Why, and the way out.
        reason: String,
    },
    /// The program cannot be read.
    #[error(transparent)]
    Program(#[from] RetrofitError),
    /// The cycle moves nothing, or its energy is not known.
    #[error("{0}")]
    Cycle(String),
}

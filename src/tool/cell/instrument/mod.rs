//! Puts a recorder into a program, and takes it out.
//!
//! The original lines stay. Calls of the recorder stand on lines of their own, or, where several
//! statements share a line, between them.

mod check;
mod cost;
mod error;
mod hash;
mod insert;
mod recording;
mod remove;
mod sites;
mod watched;

pub use cost::Cost;
pub use error::InstrumentError;
pub use hash::program_hash;
pub use recording::{Instrumented, Late, Request, Samples, instrument};
pub use remove::{is_recorder, recorded_program, recorder_prefix, without_recorder};

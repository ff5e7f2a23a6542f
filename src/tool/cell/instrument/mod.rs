//! Puts a recorder into a program, and takes it out.
//!
//! The original lines stay. Calls of the recorder stand on lines of their own, or, where several
//! statements share a line, between them.

mod cost;
mod insert;
mod recording;
mod remove;
mod sites;

pub use cost::Cost;
pub use recording::{InstrumentError, Instrumented, Late, Request, Samples, instrument};
pub use remove::{is_recorder, recorder_prefix, without_recorder};

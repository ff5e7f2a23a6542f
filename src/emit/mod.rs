//! From streams to RAPID text, by templates.
//!
//! New modules are rendered whole; the original gets insertions only, so that
//! every byte of it stays.

pub mod names;
pub mod number;
pub mod stream_module;

pub use names::Names;
pub use stream_module::{Emitted, EmitError, EmittedStream, Site, emit};

//! The loop in the cell: what a recorder saw, which waits are slack, and what a retrofit saved.
//!
//! - [`events`]: the log that a recorder writes, and its cycles;
//! - [`prove`]: what a retrofit saved, measured.

pub mod events;
pub mod prove;

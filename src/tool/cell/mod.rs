//! The loop in the cell: what a recorder saw, which waits are slack, and what a retrofit saved.
//!
//! - [`events`]: the log that a recorder writes, and its cycles.
//! - [`waits`]: which waits are slack.

pub mod events;
pub mod waits;

//! The loop in the cell: what a recorder saw, which waits are slack, and what a retrofit saved.
//!
//! - [`instrument`]: puts a recorder into a program, and takes it out;
//! - [`events`]: the log that a recorder writes, and its cycles;
//! - [`waits`]: which waits are slack;
//! - [`slack`]: how much later the robot may come to its waits;
//! - [`prove`]: what a retrofit saved, measured.

pub mod events;
pub mod instrument;
pub mod prove;
pub mod slack;
pub mod waits;

pub use instrument::program_hash;

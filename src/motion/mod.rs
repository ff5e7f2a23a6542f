//! The virtual controller: how a program becomes a timed joint trajectory.

pub mod stream;

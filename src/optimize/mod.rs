//! The optimiser: timing on a fixed path and the streams that realise it.
//!
//! The problems are plain arrays: constraints know no solver, solvers know no robot.

pub mod grid;
pub mod limits;
pub mod path_energy;
pub mod profile;
pub mod reachability;

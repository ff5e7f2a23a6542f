//! Timing on a fixed path: the problem as plain arrays, and its fastest solution.
//!
//! Constraints know no solver, solvers know no robot.

pub mod grid;
pub mod limits;
pub mod profile;
pub mod reachability;
pub mod row;

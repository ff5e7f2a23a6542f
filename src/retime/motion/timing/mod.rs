//! Timing on a fixed path: the problem as plain arrays and its fastest solution. Limits are
//! independent of solvers, solvers of robots.

pub mod grid;
pub mod limits;
pub mod profile;
pub mod reachability;
pub mod row;

//! The optimiser: timing on a fixed path and the streams that realise it.
//!
//! The problems are plain arrays: constraints know no solver, solvers know no robot.

mod banded;
mod cone;
mod energy_cones;
pub mod energy_program;
pub mod grid;
pub mod limits;
pub mod path_energy;
pub mod plant;
pub mod profile;
pub mod reachability;
pub mod stream_fit;
pub mod stream_limits;
mod stream_points;
pub mod stream_polish;
pub mod stream_reference;
pub mod stream_spacing;

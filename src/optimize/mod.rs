//! The optimiser: timing on a fixed path and the streams that realise it.

mod banded;
mod cone;
pub mod corridor;
mod energy_cones;
pub mod energy_program;
pub mod idle;
pub mod path_energy;
pub mod profile;
pub mod reachability;
pub mod stream_fit;
pub mod stream_limits;
mod stream_points;
pub mod stream_reference;
pub mod stream_spacing;

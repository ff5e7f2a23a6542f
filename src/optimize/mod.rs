//! The optimiser: timing on a fixed path and the streams that realise it.

mod banded;
mod banded_program;
pub mod check;
mod cone;
pub mod corridor;
pub mod cost;
pub mod cycle;
mod energy_cones;
pub mod energy_program;
pub mod idle;
pub mod keep_out;
mod margins;
pub mod path_energy;
pub mod path_grid;
pub mod plant;
pub mod reason;
pub mod retime;
pub mod robot_plant;
pub mod site;
pub mod standstill;
pub mod stream_fit;
pub mod stream_limits;
mod stream_points;
pub mod stream_polish;
pub mod stream_reference;
pub mod stream_rounding;
pub mod stream_spacing;

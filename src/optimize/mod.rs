//! The optimiser: timing on a fixed path and the streams that realise it.

pub mod check;
mod cone;
pub mod corridor;
mod energy_cones;
pub mod energy_program;
pub mod path_energy;
pub mod reason;
pub mod site;

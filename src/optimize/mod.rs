//! The optimiser: timing on a fixed path and the streams that realise it.

pub mod check;
pub mod corridor;
pub mod path_energy;
pub mod reason;
pub mod site;

//! The optimiser: timing on a fixed path and the streams that realise it.

pub mod path_energy;

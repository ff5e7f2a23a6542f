//! Time and energy: paths, the virtual controller, energy, optimal timing and dwells.
//!
//! It depends on `rapid` and `arm`.

pub mod energy;
pub mod motion;
pub mod optimize;
pub mod path;

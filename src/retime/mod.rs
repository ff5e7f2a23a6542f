//! Time and energy: paths, the virtual controller, joules, optimal timing and idle phases.
//!
//! It uses `rapid` and `arm`.

pub mod energy;
pub mod motion;
pub mod optimize;
pub mod path;

//! When a movement happens, and what it costs.
//!
//! - [`path`]: the geometry of a run of movements, without time;
//! - [`motion`]: the virtual controller, which gives each movement its time;
//! - [`energy`]: joules of a simulated program, and their interval over plausible robots;
//! - [`optimize`]: speed profiles and streams of least energy, dwells.
//!
//! It uses `rapid` and `arm`.

pub mod energy;
pub mod motion;
pub mod optimize;
pub mod path;

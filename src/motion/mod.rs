//! The virtual controller: how a program becomes a timed joint trajectory.

pub mod averaged;
pub mod controller;
pub mod planner;
pub mod sampling;
pub mod stream;
pub mod timed;
pub mod timeline;
pub mod timing;
pub mod virtual_controller;

pub use timeline::Simulation;
pub use virtual_controller::{Options, simulate};

//! The virtual controller: from a program to a timed joint trajectory.

pub mod arrivals;
pub mod averaged;
pub mod controller;
pub mod joint_state;
mod late;
mod leg_times;
pub mod memo;
pub mod pace;
pub mod planner;
mod quintics;
mod run_plan;
pub mod sampling;
pub mod stream;
mod tcp_limits;
pub mod timed;
pub mod timeline;
pub mod timing;
pub mod virtual_controller;

pub use run_plan::Plans;
pub use timeline::Simulation;
pub use virtual_controller::{Options, Step, replay, simulate, unreached};

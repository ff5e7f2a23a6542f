//! What moving costs in torque: inverse dynamics, gravity, energies, friction.
//!
//! Algorithms read a [`Model`](crate::robot::Model), write into a scratch
//! [`Data`] and return values; none allocates. Results have [`MAX_DOF`]
//! entries, those beyond the robot's joints are 0. Gravity is 9.81 m/s² against
//! z of the base frame.
//!
//! [`MAX_DOF`]: crate::robot::MAX_DOF

mod data;
mod energy;
mod friction;
mod load;
mod rnea;

pub use data::Data;
pub use energy::{kinetic_energy, potential_energy};
pub use friction::friction;
pub use load::Load;
pub use rnea::{gravity, rnea};

/// Acceleration of free fall \[m/s²\].
pub const GRAVITY: f64 = 9.81;

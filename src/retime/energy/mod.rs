//! The energy of a cycle by cause, movement and wait.
//!
//! Electrical energy is the sum of six parts (docs/energy.md): rigid-body work, friction, copper
//! loss, drive loss, idle, brakes. The first four are the motion energy.

pub mod account;
pub mod along;
pub mod brakes;
pub mod change;
mod features;
mod mean;
pub mod moments;
pub mod parts;
mod peaks;
pub mod plausible;
pub mod power;
mod quadrature;
pub mod trajectory;

pub use account::{Account, Energies, account};
pub use parts::EnergyParts;

//! The robot: model with origin and prior of every number, kinematics, dynamics, effects.
//!
//! It depends on no other top-level module, in particular not on RAPID.

pub mod dynamics;
pub mod effects;
pub mod kinematics;
pub mod robot;

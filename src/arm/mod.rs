//! The robot: its model with the origin and spread of every number, kinematics, dynamics, effects.
//!
//! It uses no other wing: it knows no RAPID.

pub mod dynamics;
pub mod effects;
pub mod kinematics;
pub mod robot;

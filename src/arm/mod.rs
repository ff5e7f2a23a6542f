//! The robot: what it is, where it is, and the torques that it needs.
//!
//! - [`robot`]: the immutable model with the origin and spread of every number, and its files;
//! - [`kinematics`]: forward and inverse kinematics, configurations, clearance;
//! - [`dynamics`]: inverse and forward dynamics, regressor, base parameters, friction;
//! - [`effects`]: laws beyond rigid bodies and plain friction, one file each.
//!
//! It uses no other wing: it knows no RAPID.

pub mod dynamics;
pub mod effects;
pub mod kinematics;
pub mod robot;

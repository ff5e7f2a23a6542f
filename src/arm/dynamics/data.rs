//! Scratch memory of the algorithms.

use nalgebra::{Matrix3, Vector3};

use crate::arm::robot::MAX_DOF;

use super::spatial::{Force, Inertia, Motion};

/// Intermediate results, reusable for any robot; no result persists between calls.
#[derive(Clone, Debug, Default)]
pub struct Data {
    /// Rotation of each joint frame in its parent frame.
    pub(super) rotation: [Matrix3<f64>; MAX_DOF],
    /// Axis S of each joint, in the base frame like all following fields.
    pub(super) axis: [Motion; MAX_DOF],
    /// Inertia of each link, then of all links from it on.
    pub(super) inertia: [Inertia; MAX_DOF],
    /// Force on each link, then on all links from it on.
    pub(super) wrench: [Force; MAX_DOF],
    /// Derivative of the velocities from a joint on by its angle.
    pub(super) velocity_slope: [Motion; MAX_DOF],
    /// Derivative of the accelerations from a joint on by its angle.
    pub(super) acceleration_slope: [Motion; MAX_DOF],
    /// D: derivative of the moment by the angular velocity.
    pub(super) turning: [Matrix3<f64>; MAX_DOF],
    /// Linear momentum of each link, then of all links from it on.
    pub(super) momentum: [Vector3<f64>; MAX_DOF],
}

impl Data {
    /// Fresh scratch memory.
    #[must_use]
    pub fn new() -> Data {
        Data::default()
    }
}

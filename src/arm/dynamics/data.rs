//! Scratch memory of the algorithms.

use nalgebra::{Matrix3, Vector3};

use crate::arm::robot::MAX_DOF;

use super::spatial::{Force, Inertia, Motion};

/// Intermediate results. One serves any robot; nothing in it outlives a call.
#[derive(Clone, Debug)]
pub struct Data {
    /// Rotation of each joint's frame in its parent's.
    pub(super) rotation: [Matrix3<f64>; MAX_DOF],
    /// Each joint's axis S, in the base frame as all that follows.
    pub(super) axis: [Motion; MAX_DOF],
    /// Inertia of each link, then of all links from it on.
    pub(super) inertia: [Inertia; MAX_DOF],
    /// Force on each link, then on all links from it on.
    pub(super) wrench: [Force; MAX_DOF],
    /// Change of the velocities from a joint on with its angle.
    pub(super) velocity_slope: [Motion; MAX_DOF],
    /// Change of the accelerations from a joint on with its angle.
    pub(super) acceleration_slope: [Motion; MAX_DOF],
    /// D: the moment that a change of the angular velocity brings about.
    pub(super) turning: [Matrix3<f64>; MAX_DOF],
    /// Linear momentum of each link, then of all links from it on.
    pub(super) momentum: [Vector3<f64>; MAX_DOF],
}

impl Data {
    /// Fresh scratch memory.
    #[must_use]
    pub fn new() -> Data {
        Data {
            rotation: [Matrix3::zeros(); MAX_DOF],
            axis: [Motion::zero(); MAX_DOF],
            inertia: [Inertia::zero(); MAX_DOF],
            wrench: [Force::zero(); MAX_DOF],
            velocity_slope: [Motion::zero(); MAX_DOF],
            acceleration_slope: [Motion::zero(); MAX_DOF],
            turning: [Matrix3::zeros(); MAX_DOF],
            momentum: [Vector3::zeros(); MAX_DOF],
        }
    }
}

impl Default for Data {
    fn default() -> Data {
        Data::new()
    }
}

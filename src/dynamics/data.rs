//! Scratch memory of the algorithms.

use nalgebra::{Matrix3, Vector3};

use crate::robot::MAX_DOF;

/// Intermediate results, in the joints' frames. One serves any robot; nothing in
/// it outlives a call.
#[derive(Clone, Debug)]
pub struct Data {
    /// Rotation of each joint's frame in its parent's.
    pub(super) rotation: [Matrix3<f64>; MAX_DOF],
    /// Force on each link, through its joint \[N\].
    pub(super) force: [Vector3<f64>; MAX_DOF],
    /// Moment on each link about its joint's origin \[Nm\].
    pub(super) moment: [Vector3<f64>; MAX_DOF],
}

impl Data {
    /// Fresh scratch memory.
    #[must_use]
    pub fn new() -> Data {
        Data {
            rotation: [Matrix3::zeros(); MAX_DOF],
            force: [Vector3::zeros(); MAX_DOF],
            moment: [Vector3::zeros(); MAX_DOF],
        }
    }
}

impl Default for Data {
    fn default() -> Data {
        Data::new()
    }
}

//! Forward kinematics.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

use crate::robot::{MAX_DOF, Model};

/// Pose of tool0 in the base frame at the joint angles `q` \[rad\], one for each
/// joint (a missing one is 0).
#[must_use]
pub fn fk(model: &Model, q: &[f64]) -> Isometry3<f64> {
    let frames = Frames::at(model, q);
    frames.flange(model)
}

/// Every joint's frame in the base frame.
pub(super) struct Frames {
    /// Origins \[m\].
    pub(super) origin: [Vector3<f64>; MAX_DOF],
    /// Axes of rotation, unit vectors.
    pub(super) axis: [Vector3<f64>; MAX_DOF],
    /// Rotation of the last joint's frame.
    last: Matrix3<f64>,
}

impl Frames {
    pub(super) fn at(model: &Model, q: &[f64]) -> Frames {
        let angles = model.kinematics.to_serial(q);
        let mut origin = [Vector3::zeros(); MAX_DOF];
        let mut axis = [Vector3::zeros(); MAX_DOF];
        let mut rotation = Matrix3::identity();
        let mut position = Vector3::zeros();
        for (i, joint) in model.kinematics.joints.iter().enumerate().take(MAX_DOF) {
            position += rotation * joint.translation;
            rotation *= joint.rotation_at(angles[i]);
            origin[i] = position;
            axis[i] = rotation * joint.axis.into_inner();
        }
        Frames { origin, axis, last: rotation }
    }

    /// Pose of tool0 in the base frame.
    pub(super) fn flange(&self, model: &Model) -> Isometry3<f64> {
        let last = model.dof.clamp(1, MAX_DOF) - 1;
        let rotation = Rotation3::from_matrix_unchecked(self.last);
        let frame = Isometry3::from_parts(
            Translation3::from(self.origin[last]),
            UnitQuaternion::from_rotation_matrix(&rotation),
        );
        frame * model.kinematics.flange
    }
}

//! Forward kinematics.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

use crate::arm::robot::{MAX_DOF, Model, Rotations};

/// Pose of tool0 in the base frame at the joint angles `q` \[rad\], one per joint (default 0).
#[must_use]
pub fn fk(model: &Model, q: &[f64]) -> Isometry3<f64> {
    let frames = Frames::at(model, q);
    frames.flange(model)
}

/// All joint frames in the base frame.
pub(super) struct Frames {
    /// Origins \[m\].
    pub(super) origin: [Vector3<f64>; MAX_DOF],
    /// Axes of rotation, unit vectors.
    pub(super) axis: [Vector3<f64>; MAX_DOF],
    /// Rotation of the last joint frame.
    last: Matrix3<f64>,
}

impl Frames {
    pub(super) fn at(model: &Model, q: &[f64]) -> Frames {
        Frames::from_rotations(model, &model.kinematics.rotations(q))
    }

    /// From the rotation of each joint frame in its parent frame.
    pub(super) fn from_rotations(model: &Model, rotations: &Rotations) -> Frames {
        let mut origin = [Vector3::zeros(); MAX_DOF];
        let mut axis = [Vector3::zeros(); MAX_DOF];
        let mut rotation = Matrix3::identity();
        let mut position = Vector3::zeros();
        for (i, joint) in model.kinematics.joints.iter().enumerate().take(MAX_DOF) {
            position += rotation * joint.translation;
            rotation *= rotations[i];
            origin[i] = position;
            axis[i] = rotation * joint.axis.into_inner();
        }
        Frames { origin, axis, last: rotation }
    }

    /// A point of tool0 in the base frame, both in m.
    pub(super) fn point(&self, model: &Model, at: &Vector3<f64>) -> Vector3<f64> {
        let last = model.dof.clamp(1, MAX_DOF) - 1;
        let flange = &model.kinematics.flange;
        self.origin[last] + self.last * (flange.rotation * at + flange.translation.vector)
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

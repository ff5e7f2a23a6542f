//! Square matrices over the joints.

use nalgebra::SMatrix;

use crate::arm::robot::{Coupling, MAX_DOF, Model};

/// A matrix with one row and column per joint; entries beyond the joints of the robot are 0.
pub type JointMatrix = SMatrix<f64, MAX_DOF, MAX_DOF>;

/// The matrix at the reported joints from that at the serial ones, Tᵀ A T with `q_serial = T q`.
pub(super) fn from_serial(model: &Model, mut matrix: JointMatrix) -> JointMatrix {
    if model.kinematics.coupling == Coupling::Parallelogram {
        for row in 0..model.dof {
            matrix[(row, 1)] -= matrix[(row, 2)];
        }
        for column in 0..model.dof {
            matrix[(1, column)] -= matrix[(2, column)];
        }
    }
    matrix
}

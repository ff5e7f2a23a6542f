//! The tool centre point (TCP) of a held or stationary tool.

use nalgebra::{Isometry3, Matrix3, SMatrix, SVector, Vector6};

use crate::arm::robot::{Model, Rotations};

use super::fk::fk;
use super::jacobian::{Tip, jacobian, jacobian_dot, twist};

/// The TCP. Its pose and velocity are relative to the base frame if the robot holds the tool, and
/// relative to tool0 if the tool is stationary and the robot holds the work object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tcp {
    /// The robot holds the tool: the TCP in tool0.
    Held(Isometry3<f64>),
    /// The tool is stationary: the TCP in the base frame.
    Stationary(Isometry3<f64>),
}

impl Tcp {
    /// The pose of the TCP if tool0 has the pose `flange` in the base frame.
    #[must_use]
    pub fn pose(&self, flange: &Isometry3<f64>) -> Isometry3<f64> {
        match self {
            Tcp::Held(tool) => flange * tool,
            Tcp::Stationary(tool) => flange.inverse() * tool,
        }
    }

    /// The pose of tool0 in the base frame if the TCP has the pose `tcp`.
    #[must_use]
    pub fn flange(&self, tcp: &Isometry3<f64>) -> Isometry3<f64> {
        match self {
            Tcp::Held(tool) => tcp * tool.inverse(),
            Tcp::Stationary(tool) => tool * tcp.inverse(),
        }
    }

    /// TCP velocity per joint velocity at `q` \[rad\]: 6 × N, linear \[m/rad\] over angular \[1\].
    #[must_use]
    pub fn jacobian<const N: usize>(&self, model: &Model, q: &[f64; N]) -> SMatrix<f64, 6, N> {
        match self {
            Tcp::Held(tool) => jacobian(model, q, tool),
            Tcp::Stationary(tool) => {
                let flange = fk(model, q);
                let into = flange.rotation.inverse().to_rotation_matrix().into_inner();
                -turned(&into, &jacobian(model, q, &(flange.inverse() * tool)))
            }
        }
    }

    /// TCP velocity at `q` \[rad\] with joint velocities `qd`, per second or per unit of a path:
    /// linear \[m\] over angular \[rad\].
    #[must_use]
    pub fn twist<const N: usize>(
        &self,
        model: &Model,
        q: &[f64; N],
        qd: &[f64; N],
    ) -> Vector6<f64> {
        self.twist_of(model, q, &model.kinematics.rotations(q), qd)
    }

    /// The same with known joint rotations at `q`.
    #[must_use]
    pub fn twist_of<const N: usize>(
        &self,
        model: &Model,
        q: &[f64; N],
        rotations: &Rotations,
        qd: &[f64; N],
    ) -> Vector6<f64> {
        match self {
            Tcp::Held(tool) => twist(model, rotations, qd, tool),
            Tcp::Stationary(_) => {
                self.jacobian(model, q) * SVector::<f64, N>::from_column_slice(qd)
            }
        }
    }

    /// Derivative of [`jacobian`](Self::jacobian) along the motion with joint velocities `qd`.
    #[must_use]
    pub fn jacobian_dot<const N: usize>(
        &self,
        model: &Model,
        q: &[f64; N],
        qd: &[f64; N],
    ) -> SMatrix<f64, 6, N> {
        match self {
            Tcp::Held(tool) => jacobian_dot(model, q, qd, Tip::Held(tool)),
            Tcp::Stationary(tool) => {
                // J = −Rᵀ J_b with J_b for the point of the work object at the tool; R' = ω × R.
                let flange = fk(model, q);
                let into = flange.rotation.inverse().to_rotation_matrix().into_inner();
                let own = jacobian(model, q, &(flange.inverse() * tool));
                let turning = own.fixed_rows::<3>(3) * SVector::<f64, N>::from_column_slice(qd);
                let rate = jacobian_dot(model, q, qd, Tip::Fixed(tool.translation.vector));
                turned(&(into * turning.cross_matrix()), &own) - turned(&into, &rate)
            }
        }
    }
}

/// Rotates both halves of each column.
fn turned<const N: usize>(by: &Matrix3<f64>, matrix: &SMatrix<f64, 6, N>) -> SMatrix<f64, 6, N> {
    let mut turned = SMatrix::<f64, 6, N>::zeros();
    for half in [0, 3] {
        let rows = by * matrix.fixed_rows::<3>(half);
        turned.fixed_rows_mut::<3>(half).copy_from(&rows);
    }
    turned
}

impl Default for Tcp {
    /// tool0.
    fn default() -> Tcp {
        Tcp::Held(Isometry3::identity())
    }
}

//! Lines and arcs whose wrist is interpolated axis by axis: `SingArea\Wrist`.
//!
//! The TCP stays on its curve while axes 4 to 6 turn at constant rates from their angles at the start
//! to those at the end; in between the orientation of the tool differs from the programmed one (ABB,
//! RAPID overview, "Positioning during program execution").

use nalgebra::{Matrix3, Vector3, Vector6};

use super::curve::CurvePoint;
use super::joint_path::{Joints, PathPoint};
use crate::arm::kinematics::{Tcp, fk};
use crate::arm::robot::Model;

/// Newton steps before a position counts as not reachable.
const STEPS: usize = 20;
/// Error of the TCP position at which the iteration has converged, m.
const CONVERGED: f64 = 1e-12;
/// Joints that place the TCP.
const ARM: usize = 3;

/// Wrist angles (rad) that are linear in the parameter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wrist {
    /// At 0.
    pub(super) start: [f64; 3],
    /// Per parameter.
    pub(super) rate: [f64; 3],
}

impl Wrist {
    /// From the wrist of one position of the joints to that of another, over `length`.
    pub(super) fn new(start: &Joints, end: &Joints, length: f64) -> Wrist {
        let start3 = [start[3], start[4], start[5]];
        Wrist {
            start: start3,
            rate: std::array::from_fn(|j| (end[ARM + j] - start[ARM + j]) / length),
        }
    }

    /// Joints (rad) at the parameter `x` with the TCP at `position` (m, base frame), nearest to
    /// `near`; `None` if the iteration does not converge.
    pub(super) fn solve(
        &self,
        model: &Model,
        tool: &Tcp,
        position: &Vector3<f64>,
        x: f64,
        near: &Joints,
    ) -> Option<Joints> {
        let mut q = *near;
        for j in 0..3 {
            q[ARM + j] = self.start[j] + self.rate[j] * x;
        }
        for _ in 0..STEPS {
            let error = position - tool.pose(&fk(model, &q)).translation.vector;
            if error.norm() < CONVERGED {
                return Some(q);
            }
            let step = arm(&tool.jacobian(model, &q)).lu().solve(&error)?;
            for j in 0..ARM {
                q[j] += step[j];
            }
        }
        let error = position - tool.pose(&fk(model, &q)).translation.vector;
        (error.norm() < NEAR_ENOUGH).then_some(q)
    }

    /// Joints and their derivatives at the joints `q` that [`Wrist::solve`] gave for a place of
    /// the curve; `None` where the arm is singular.
    pub(super) fn derivatives(
        &self,
        model: &Model,
        tool: &Tcp,
        at: &CurvePoint,
        q: Joints,
    ) -> Option<PathPoint> {
        let jacobian = tool.jacobian(model, &q);
        let lu = arm(&jacobian).lu();
        let [w4, w5, w6] = self.rate;
        let carried = jacobian * Vector6::new(0.0, 0.0, 0.0, w4, w5, w6);
        let rate = lu.solve(&(at.linear - carried.fixed_rows::<3>(0)))?;
        let q1 = [rate.x, rate.y, rate.z, w4, w5, w6];
        let bias = tool.jacobian_dot(model, &q, &q1) * Vector6::from(q1);
        let bend = lu.solve(&(at.linear_rate - bias.fixed_rows::<3>(0)))?;
        Some(PathPoint { q, q1, q2: [bend.x, bend.y, bend.z, 0.0, 0.0, 0.0] })
    }
}

/// Largest error that rounding may leave after the last Newton step, m.
const NEAR_ENOUGH: f64 = 1e-9;

/// The part of a Jacobian by which the arm moves the TCP.
fn arm(jacobian: &nalgebra::Matrix6<f64>) -> Matrix3<f64> {
    jacobian.fixed_view::<3, 3>(0, 0).into_owned()
}

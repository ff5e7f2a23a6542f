//! Lines and arcs with axis-wise interpolation of the wrist: `SingArea\Wrist`.
//!
//! The TCP stays on its curve while axes 4 to 6 turn at constant rates from their start to
//! their end angles; the orientation of the tool in between differs from the programmed one (ABB,
//! RAPID overview, "Positioning during program execution").

use nalgebra::{Matrix3, Vector3, Vector6};

use super::curve::CurvePoint;
use super::joint_path::{Joints, PathPoint};
use crate::arm::kinematics::{Tcp, fk};
use crate::arm::robot::Model;

/// Largest number of Newton steps.
const STEPS: usize = 20;
/// TCP position error at which the iteration has converged, m.
const CONVERGED: f64 = 1e-12;
/// Number of joints that position the TCP.
const ARM: usize = 3;

/// Wrist angles (rad), linear in the path parameter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wrist {
    /// Angles at 0.
    pub(super) start: [f64; 3],
    /// Derivative by the parameter.
    pub(super) rate: [f64; 3],
}

impl Wrist {
    /// From the wrist angles of `start` to those of `end` over `length`.
    pub(super) fn new(start: &Joints, end: &Joints, length: f64) -> Wrist {
        Wrist {
            start: [start[3], start[4], start[5]],
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
        (error.norm() < ACCEPTED).then_some(q)
    }

    /// Joint angles and derivatives at a curve point with the solution `q` of [`Wrist::solve`];
    /// `None` if the arm is singular.
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

/// Largest accepted error after the last Newton step, m.
const ACCEPTED: f64 = 1e-9;

/// The part of a Jacobian that maps the arm joints to the TCP velocity.
fn arm(jacobian: &nalgebra::Matrix6<f64>) -> Matrix3<f64> {
    jacobian.fixed_view::<3, 3>(0, 0).into_owned()
}

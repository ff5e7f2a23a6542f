//! Geometric Jacobian and its derivative.

use nalgebra::{Isometry3, SMatrix, Vector3, Vector6};

use crate::arm::robot::{Coupling, Model, Rotations};

use super::fk::Frames;

/// TCP velocity per joint velocity: 6 × N, linear \[m/rad\] over angular \[1\], both in the base
/// frame, at the origin of `tool` (pose in tool0). `N` is the number of joints.
#[must_use]
pub fn jacobian<const N: usize>(
    model: &Model,
    q: &[f64; N],
    tool: &Isometry3<f64>,
) -> SMatrix<f64, 6, N> {
    let frames = Frames::at(model, q);
    let tip = frames.point(model, &tool.translation.vector);
    let mut j = SMatrix::zeros();
    for i in 0..N.min(model.dof) {
        let linear = frames.axis[i].cross(&(tip - frames.origin[i]));
        set_column(&mut j, i, linear, frames.axis[i]);
    }
    couple(model, &mut j);
    j
}

/// Velocity of the origin of `tool` (pose in tool0), linear over angular, in the base frame.
pub(super) fn twist(
    model: &Model,
    rotations: &Rotations,
    qd: &[f64],
    tool: &Isometry3<f64>,
) -> Vector6<f64> {
    let frames = Frames::from_rotations(model, rotations);
    let rates = model.kinematics.to_serial(qd);
    let tip = frames.point(model, &tool.translation.vector);
    let mut moving = Vector3::zeros();
    let mut turning = Vector3::zeros();
    for (i, rate) in rates.iter().enumerate().take(model.dof) {
        let turn = frames.axis[i] * *rate;
        moving += turn.cross(&(tip - frames.origin[i]));
        turning += turn;
    }
    Vector6::new(moving.x, moving.y, moving.z, turning.x, turning.y, turning.z)
}

/// Reference point of a Jacobian.
#[derive(Clone, Copy)]
pub(super) enum Tip<'a> {
    /// The origin of a frame in tool0.
    Held(&'a Isometry3<f64>),
    /// A fixed point in the base frame \[m\].
    Fixed(Vector3<f64>),
}

/// Derivative J' of [`jacobian`] along the motion with joint velocities `qd`, such that
/// x'' = J q'' + J' q'. `qd` is per second or per unit of a path, as is J'.
pub(super) fn jacobian_dot<const N: usize>(
    model: &Model,
    q: &[f64; N],
    qd: &[f64; N],
    at: Tip<'_>,
) -> SMatrix<f64, 6, N> {
    let dof = N.min(model.dof);
    let frames = Frames::at(model, q);
    let rates = model.kinematics.to_serial(qd);
    let tip = match at {
        Tip::Held(tool) => frames.point(model, &tool.translation.vector),
        Tip::Fixed(point) => point,
    };

    // Velocities of the joint origins and axes.
    let mut turning = Vector3::zeros();
    let mut moving = Vector3::zeros();
    let mut last = Vector3::zeros();
    let mut origin_rate = [Vector3::zeros(); N];
    let mut axis_rate = [Vector3::zeros(); N];
    for i in 0..dof {
        moving += turning.cross(&(frames.origin[i] - last));
        last = frames.origin[i];
        origin_rate[i] = moving;
        axis_rate[i] = turning.cross(&frames.axis[i]);
        turning += frames.axis[i] * rates[i];
    }
    let tip_rate = match at {
        Tip::Held(_) => moving + turning.cross(&(tip - last)),
        Tip::Fixed(_) => Vector3::zeros(),
    };

    let mut j = SMatrix::zeros();
    for i in 0..dof {
        let linear = axis_rate[i].cross(&(tip - frames.origin[i]))
            + frames.axis[i].cross(&(tip_rate - origin_rate[i]));
        set_column(&mut j, i, linear, axis_rate[i]);
    }
    couple(model, &mut j);
    j
}

fn set_column<const N: usize>(
    j: &mut SMatrix<f64, 6, N>,
    column: usize,
    linear: Vector3<f64>,
    angular: Vector3<f64>,
) {
    j.fixed_view_mut::<3, 1>(0, column).copy_from(&linear);
    j.fixed_view_mut::<3, 1>(3, column).copy_from(&angular);
}

/// From serial to reported joints: q3 moves joint 3, q2 moves joints 2 and 3 oppositely.
fn couple<const N: usize>(model: &Model, j: &mut SMatrix<f64, 6, N>) {
    if model.kinematics.coupling == Coupling::Parallelogram && N > 2 {
        let forearm = j.column(2).into_owned();
        let mut upper_arm = j.column_mut(1);
        upper_arm -= forearm;
    }
}

//! Closed-form inverse kinematics of an ortho-parallel arm with a spherical wrist: eight branches.
//! Symbols as in [`Opw`]; θ are OPW angles.

use std::f64::consts::PI;

use nalgebra::{Isometry3, Matrix3, Rotation3, Vector3};

use crate::arm::robot::{Coupling, Model, Opw};

use super::error::{IkError, Side};

/// Accepted excess of a pose over the reach \[m\]. Rounding of targets with few digits is left to
/// the caller.
const REACH_SLACK: f64 = 1e-9;
/// |sin θ5| below which axes 4 and 6 are collinear; with the arm stretched as well, θ5 has only
/// half of the digits.
const WRIST_SINGULAR: f64 = 1e-7;

/// Distance from axis 1 below which a wrist centre is on it \[m\].
const ON_AXIS: f64 = 1e-9;

/// One branch of the inverse kinematics.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    /// Joint angles, each in (−π, π] \[rad\].
    pub(super) q: [f64; 6],
    /// Whether the wrist centre is behind axis 1.
    pub(super) back: bool,
    /// Signed elbow angle \[rad\].
    pub(super) elbow: f64,
    /// In a wrist singularity: the relation of joints 4 and 6.
    pub(super) locked: Option<Locked>,
}

/// In a wrist singularity, q6 follows q4: `q6 = offset − slope · q4`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Locked {
    pub(super) offset: f64,
    pub(super) slope: f64,
}

pub(super) fn is_finite(pose: &Isometry3<f64>) -> bool {
    let numbers = pose.translation.vector.iter().chain(pose.rotation.coords.iter());
    numbers.into_iter().all(|number| number.is_finite())
}

/// The branches of an OPW arm; `q1` as for [`arms`].
pub(super) fn closed(
    model: &Model,
    opw: &Opw,
    pose: &Isometry3<f64>,
    q1: f64,
) -> Result<Vec<Branch>, IkError> {
    let rotation = pose.rotation.to_rotation_matrix().into_inner();
    let mut found = Vec::with_capacity(8);
    for arm in arms(opw, pose, &rotation, q1)?.into_iter().flatten() {
        wrist(model, opw, &rotation, &arm, |branch| found.push(branch));
    }
    Ok(found)
}

/// Calls `take` with the branches that may be nearer to `q_ref` than the least distance it has
/// returned; the wrist is solved only if the first three joints are not farther already. Distances
/// are sums of squares modulo full turns.
pub(super) fn near(
    model: &Model,
    opw: &Opw,
    pose: &Isometry3<f64>,
    q_ref: &[f64; 6],
    mut take: impl FnMut(Branch) -> f64,
) -> Result<(), IkError> {
    if !is_finite(pose) {
        return Err(IkError::NotFinite);
    }
    let rotation = pose.rotation.to_rotation_matrix().into_inner();
    let mut arms = arms(opw, pose, &rotation, q_ref[0])?.map(|arm| {
        arm.map(|arm| {
            let [theta1, theta2, theta3] = arm.theta;
            let q = to_joints(model, opw, [theta1, theta2, theta3, 0.0, 0.0, 0.0]);
            let off = |j: usize| wrap(q[j] - q_ref[j]).powi(2);
            ((0..3).map(off).sum::<f64>(), arm)
        })
    });
    let distance = |arm: &Option<(f64, Arm)>| arm.map_or(f64::INFINITY, |(distance, _)| distance);
    arms.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let mut least = f64::INFINITY;
    for (distance, arm) in arms.into_iter().flatten() {
        if distance > least {
            break;
        }
        wrist(model, opw, &rotation, &arm, |branch| least = take(branch));
    }
    Ok(())
}

/// The branches of the first three joints for the wrist centre of a pose. `q1` \[rad\] is the angle
/// of joint 1 for a wrist centre on axis 1, where any angle is a solution.
fn arms(
    opw: &Opw,
    pose: &Isometry3<f64>,
    rotation: &Matrix3<f64>,
    q1: f64,
) -> Result<[Option<Arm>; 4], IkError> {
    let centre = pose.translation.vector - opw.c4 * rotation.column(2);
    let [front, back] = facings(opw, &centre, q1);
    match (front, back) {
        (Err(a), Err(b)) => {
            let (distance, side) = if b.0 < a.0 { b } else { a };
            Err(IkError::Unreachable { distance, side })
        }
        (front, back) => {
            let [a, b] = front.map_or([None; 2], |arms| arms.map(Some));
            let [c, d] = back.map_or([None; 2], |arms| arms.map(Some));
            Ok([a, b, c, d])
        }
    }
}

/// First three angles of one branch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arm {
    /// θ1 to θ3 \[rad\].
    pub(super) theta: [f64; 3],
    /// Whether the wrist centre is behind axis 1.
    back: bool,
    /// Signed elbow angle \[rad\].
    elbow: f64,
}

/// Distance \[m\] and side of an unreachable wrist centre.
type Miss = (f64, Side);

/// Both elbows with axis 1 facing the wrist centre, then facing away; `q1` as for [`arms`].
pub(super) fn facings(opw: &Opw, centre: &Vector3<f64>, q1: f64) -> [Result<[Arm; 2], Miss>; 2] {
    let beyond_b = centre.xy().norm_squared() - opw.b * opw.b;
    if beyond_b < -REACH_SLACK * opw.b.abs() {
        let miss = (opw.b.abs() - centre.xy().norm(), Side::Inside);
        return [Err(miss), Err(miss)];
    }
    let radius = beyond_b.max(0.0).sqrt();
    [(radius, false), (-radius, true)].map(|(reach, back)| {
        let towards = if centre.xy().norm() < ON_AXIS {
            opw.signs[0] * q1 - opw.offsets[0]
        } else {
            centre.y.atan2(centre.x)
        };
        let theta1 = towards - opw.b.atan2(reach);
        let elbows = arm(opw, reach - opw.a1, centre.z - opw.c1)?;
        let arm = |[theta2, theta3, elbow]: [f64; 3]| Arm {
            theta: [theta1, theta2, theta3],
            back,
            elbow,
        };
        Ok(elbows.map(arm))
    })
}

/// θ2, θ3 and the elbow angle of both elbows for a wrist centre at (u, v) from axis 2, u forward
/// and v up; otherwise the distance to the reachable ring.
fn arm(opw: &Opw, u: f64, v: f64) -> Result<[[f64; 3]; 2], Miss> {
    let k = opw.a2.hypot(opw.c3);
    let psi3 = opw.a2.atan2(opw.c3);
    let distance = u.hypot(v);
    if distance > opw.c2 + k + REACH_SLACK {
        return Err((distance - opw.c2 - k, Side::Beyond));
    }
    if distance < (opw.c2 - k).abs() - REACH_SLACK {
        return Err(((opw.c2 - k).abs() - distance, Side::Inside));
    }
    let cos = (u * u + v * v - opw.c2 * opw.c2 - k * k) / (2.0 * opw.c2 * k);
    let bend = cos.clamp(-1.0, 1.0).acos();
    Ok([bend, -bend].map(|phi| {
        let theta2 = u.atan2(v) - (k * phi.sin()).atan2(opw.c2 + k * phi.cos());
        [theta2, phi - psi3, phi]
    }))
}

/// Both wrist solutions for the first three angles.
fn wrist(
    model: &Model,
    opw: &Opw,
    rotation: &Matrix3<f64>,
    arm: &Arm,
    mut push: impl FnMut(Branch),
) {
    let Arm { theta: [theta1, theta2, theta3], back, elbow } = *arm;
    let mut push = |q, locked| push(Branch { q, back, elbow, locked });
    let r = forearm([theta1, theta2, theta3]).matrix().transpose() * rotation;
    let sin = r.m13.hypot(r.m23);
    let theta5 = sin.atan2(r.m33);
    if sin < WRIST_SINGULAR {
        // θ6 = sum ∓ θ4, upper sign for θ5 = 0, lower for θ5 = π.
        let sum = r.m21.atan2(r.m22);
        let sign = if r.m33 > 0.0 { -1.0 } else { 1.0 };
        for (theta5, theta4) in [(theta5, 0.0), (-theta5, PI)] {
            let theta6 = sum + sign * theta4;
            let q = to_joints(model, opw, [theta1, theta2, theta3, theta4, theta5, theta6]);
            let slope = -sign * opw.signs[3] * opw.signs[5];
            push(q, Some(Locked { offset: q[5] + slope * q[3], slope }));
        }
        return;
    }
    let theta4 = r.m23.atan2(r.m13);
    let theta6 = r.m32.atan2(-r.m31);
    for (theta5, half) in [(theta5, 0.0), (-theta5, PI)] {
        let theta = [theta1, theta2, theta3, theta4 + half, theta5, theta6 + half];
        push(to_joints(model, opw, theta), None);
    }
}

/// Rotation of the forearm, its z along axis 4.
pub(super) fn forearm([theta1, theta2, theta3]: [f64; 3]) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::z_axis(), theta1)
        * Rotation3::from_axis_angle(&Vector3::y_axis(), theta2 + theta3)
}

/// The joint angles from OPW angles, each in (−π, π] \[rad\].
pub(super) fn to_joints(model: &Model, opw: &Opw, theta: [f64; 6]) -> [f64; 6] {
    let mut q = theta;
    for (i, angle) in q.iter_mut().enumerate() {
        *angle = opw.signs[i] * (*angle + opw.offsets[i]);
    }
    if model.kinematics.coupling == Coupling::Parallelogram {
        q[2] += q[1];
    }
    q.map(wrap)
}

/// The equivalent angle in (−π, π] \[rad\].
pub(super) fn wrap(angle: f64) -> f64 {
    let turned = angle - 2.0 * PI * (angle / (2.0 * PI)).round();
    if turned <= -PI { turned + 2.0 * PI } else { turned }
}

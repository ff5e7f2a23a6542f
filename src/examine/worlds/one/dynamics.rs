//! Lagrange's equations in closed form. The rows of the Jacobians of every centre of mass and their
//! exact derivatives by the angles give the torques by virtual work:
//! `τ = Σ Jᵥᵀ m (Jᵥq̈ + J̇ᵥq̇ − g) + J_ωᵀ (I ω̇ + ω × Iω)` (L. Sciavicco, B. Siciliano, Modelling and
//! Control of Robot Manipulators, 2000, chapter 4).

use super::arm::{Arm, GRAVITY};
use crate::examine::worlds::model::{Body, M3, MAX, Row, V3};

/// Where the joints are, world frame.
#[derive(Clone, Debug)]
pub(super) struct Pose {
    /// Origins of the joints \[m\].
    pub(super) origin: [V3; MAX],
    pub(super) axis: [V3; MAX],
    pub(super) turn: [M3; MAX],
    /// The flange \[m\].
    pub(super) flange: V3,
}

/// Gravity as a vector \[m/s²\], world frame.
pub(super) fn down() -> V3 {
    V3::new(0.0, 0.0, -GRAVITY)
}

/// Turn about a unit axis (Rodrigues).
pub(super) fn turn(axis: &V3, angle: f64) -> M3 {
    let k = axis.cross_matrix();
    M3::identity() + k * angle.sin() + k * k * (1.0 - angle.cos())
}

/// The pose at the angles \[rad\].
pub(super) fn pose(arm: &Arm, q: &Row) -> Pose {
    let mut out = Pose {
        origin: [V3::zeros(); MAX],
        axis: [V3::zeros(); MAX],
        turn: [M3::identity(); MAX],
        flange: V3::zeros(),
    };
    let mut p = V3::zeros();
    let mut r = M3::identity();
    for (j, joint) in arm.joints.iter().enumerate() {
        p += r * joint.origin;
        r = r * joint.rotation * turn(&joint.axis, q[j]);
        out.origin[j] = p;
        out.axis[j] = r * joint.axis;
        out.turn[j] = r;
    }
    out.flange = p + r * arm.flange;
    out
}

/// Rows of the Jacobian of a point that moves with link `link` \[m\].
pub(super) fn jacobian(pose: &Pose, link: usize, point: &V3) -> [V3; MAX] {
    let mut rows = [V3::zeros(); MAX];
    for i in 0..=link.min(MAX - 1) {
        rows[i] = pose.axis[i].cross(&(point - pose.origin[i]));
    }
    rows
}

/// Adds the torques \[Nm\] that move one body on link `link`.
fn add_body(
    body: &Body,
    link: usize,
    pose: &Pose,
    motion: (&Row, &Row),
    tau: &mut Row,
    gravity: &V3,
) {
    let (v, a) = motion;
    let point = pose.origin[link] + pose.turn[link] * body.com;
    let rows = jacobian(pose, link, &point);
    let mut linear = -gravity;
    let mut omega = V3::zeros();
    let mut angular = V3::zeros();
    for i in 0..=link {
        linear += rows[i] * a[i];
        angular += pose.axis[i] * a[i] + omega.cross(&pose.axis[i]) * v[i];
        omega += pose.axis[i] * v[i];
    }
    // ∂Jᵢ/∂qⱼ = z_min(i,j) × J_max(i,j): summed from the last joint to the first.
    let mut outer = V3::zeros();
    for i in (0..=link).rev() {
        let own = rows[i] * v[i];
        linear += pose.axis[i].cross(&(own + outer * 2.0)) * v[i];
        outer += own;
    }
    let world = pose.turn[link] * body.inertia * pose.turn[link].transpose();
    let force = linear * body.mass;
    let moment = world * angular + omega.cross(&(world * omega));
    for i in 0..=link {
        tau[i] += rows[i].dot(&force) + pose.axis[i].dot(&moment);
    }
}

/// Torques \[Nm\] of bodies, each on a link, under a gravity \[m/s²\].
pub(super) fn torques<'a>(
    bodies: impl Iterator<Item = (usize, &'a Body)>,
    pose: &Pose,
    motion: (&Row, &Row),
    gravity: &V3,
) -> Row {
    let mut tau = [0.0; MAX];
    for (link, body) in bodies {
        add_body(body, link, pose, motion, &mut tau, gravity);
    }
    tau
}

/// Torques \[Nm\] of the links of an arm, without rotors and friction.
pub(super) fn inverse(arm: &Arm, pose: &Pose, v: &Row, a: &Row) -> Row {
    torques(arm.bodies.iter().enumerate(), pose, (v, a), &down())
}

/// What gravity alone needs \[Nm\], under a gravity \[m/s²\].
pub(super) fn gravity_torques(arm: &Arm, pose: &Pose, gravity: &V3) -> Row {
    let rest = [0.0; MAX];
    torques(arm.bodies.iter().enumerate(), pose, (&rest, &rest), gravity)
}

/// Diagonal of the mass matrix \[kg m²\], without rotors.
pub(super) fn inertias(arm: &Arm, pose: &Pose) -> Row {
    let mut out = [0.0; MAX];
    for (link, body) in arm.bodies.iter().enumerate() {
        let point = pose.origin[link] + pose.turn[link] * body.com;
        let rows = jacobian(pose, link, &point);
        let world = pose.turn[link] * body.inertia * pose.turn[link].transpose();
        for i in 0..=link {
            out[i] +=
                body.mass * rows[i].norm_squared() + pose.axis[i].dot(&(world * pose.axis[i]));
        }
    }
    out
}

/// The model that a person has: links, rotors (where it has them) and plain friction \[Nm\]. `signs`
/// are the directions of motion.
pub(super) fn model(arm: &Arm, motion: (&Row, &Row, &Row), signs: &Row, rotors: bool) -> Row {
    let (q, v, a) = motion;
    let mut tau = inverse(arm, &pose(arm, q), v, a);
    for j in 0..arm.count() {
        let rotor = if rotors { arm.rotor[j] * a[j] } else { 0.0 };
        tau[j] += rotor + arm.coulomb[j] * signs[j] + arm.viscous[j] * v[j];
    }
    tau
}

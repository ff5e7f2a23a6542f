//! The regressor: τ = Y(q, q̇, q̈) π is linear in the inertial parameters.
//!
//! Linear form of Gautier and Khalil: per link the mass, the first moments m c and the moments of
//! inertia about the joint origin. The wrench of body j, linear in its ten parameters, is projected
//! onto the axes of all previous joints, which are transformed into the frame of body j.

use nalgebra::Vector3;

use crate::arm::robot::{Coupling, GRAVITY, MAX_DOF, Model};

use super::parameters::RIGID;

/// One row of ten numbers per joint and link.
#[derive(Clone, Debug, Default)]
pub struct Regressor {
    /// `rows[joint][link]`: joint torque \[Nm\] per unit of each link parameter, in the order of
    /// [`link_parameters`](super::link_parameters).
    pub rows: [[[f64; RIGID]; MAX_DOF]; MAX_DOF],
}

impl Regressor {
    /// All zero.
    #[must_use]
    pub fn new() -> Regressor {
        Regressor::default()
    }
}

/// Writes the regressor of the rigid bodies for the motion `q` \[rad\], `qd` \[rad/s\], `qdd`
/// \[rad/s²\]; the inputs have one entry per joint (missing ones are 0).
pub fn regressor(model: &Model, out: &mut Regressor, q: &[f64], qd: &[f64], qdd: &[f64]) {
    let geometry = &model.kinematics;
    let [q, qd, qdd] = [q, qd, qdd].map(|values| geometry.to_serial(values));
    let mut w = Vector3::zeros();
    let mut wd = Vector3::zeros();
    let mut a = model.kinematics.up() * GRAVITY;
    // The axes of all joints up to this one: direction, and velocity of the frame origin of this
    // body per unit rotation.
    let mut axes = [(Vector3::zeros(), Vector3::zeros()); MAX_DOF];
    for (j, joint) in geometry.joints.iter().take(MAX_DOF).enumerate() {
        let r = joint.rotation_at(q[j]);
        let p = joint.translation;
        let axis = joint.axis.into_inner();
        a = r.tr_mul(&(a + wd.cross(&p) + w.cross(&w.cross(&p))));
        let carried = r.tr_mul(&w);
        wd = r.tr_mul(&wd) + carried.cross(&axis) * qd[j] + axis * qdd[j];
        w = carried + axis * qd[j];
        for (direction, velocity) in &mut axes[..j] {
            *velocity = r.tr_mul(&(*velocity + direction.cross(&p)));
            *direction = r.tr_mul(direction);
        }
        axes[j] = (axis, Vector3::zeros());
        for (i, (direction, velocity)) in axes[..=j].iter().enumerate() {
            out.rows[i][j] = row(direction, velocity, &a, &w, &wd);
        }
    }
    if geometry.coupling == Coupling::Parallelogram {
        let (before, after) = out.rows.split_at_mut(2);
        for (driven, fore) in before[1].iter_mut().flatten().zip(after[0].iter().flatten()) {
            *driven -= fore;
        }
    }
}

/// z · moment + s · force of a body for each unit parameter.
#[inline]
fn row(
    z: &Vector3<f64>,
    s: &Vector3<f64>,
    a: &Vector3<f64>,
    w: &Vector3<f64>,
    wd: &Vector3<f64>,
) -> [f64; RIGID] {
    // s · (ω̇ × c + ω × (ω × c)) = c · (s × ω̇ + (s × ω) × ω)
    let first = s.cross(wd) + s.cross(w).cross(w) + a.cross(z);
    let u = z.cross(w);
    [
        s.dot(a),
        first.x,
        first.y,
        first.z,
        z.x * wd.x + u.x * w.x,
        z.y * wd.y + u.y * w.y,
        z.z * wd.z + u.z * w.z,
        z.x * wd.y + z.y * wd.x + u.x * w.y + u.y * w.x,
        z.x * wd.z + z.z * wd.x + u.x * w.z + u.z * w.x,
        z.y * wd.z + z.z * wd.y + u.y * w.z + u.z * w.y,
    ]
}

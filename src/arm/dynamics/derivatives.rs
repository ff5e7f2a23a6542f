//! Analytic derivatives of the inverse dynamics.
//!
//! J. Carpentier, N. Mansard, "Analytical Derivatives of Rigid Body Dynamics Algorithms", Robotics:
//! Science and Systems 2018, in the base frame, where joint k moves all later bodies as one:
//!
//! ```text
//! ∂f_j/∂q_k = S_k ×* f_j + Y_j dA_k + B_j dV_k      dV_k = v_p × S_k
//! ∂f_j/∂q̇_k = 2 Y_j dV_k + B_j S_k                  dA_k = a_p × S_k + v_p × dV_k
//! ```
//!
//! for bodies j ≥ k, with p the parent of k. For a rigid body, B x depends only on the angular part
//! α of x: its moment is D α and its force 2 α × h, where h is the linear momentum,
//! D = −2 (\[ω\] Σ + \[m c\] \[v\]), and Σ = ½ tr(I) − I the second moments of mass about the
//! origin. So B of several bodies is a sum of 3 × 3 matrices.

use nalgebra::{Matrix3, Vector3};

use crate::arm::robot::{GRAVITY, MAX_DOF, Model};

use super::data::Data;
use super::joint_matrix::{self, JointMatrix};
use super::load::Load;
use super::motor_side::{add_rotors, rotor_torques};
use super::rnea::links;
use super::spatial::{Force, Inertia, Motion};

/// Inverse dynamics with its derivatives; rows are torques.
#[derive(Clone, Debug)]
pub struct Derivatives {
    /// Torque of each joint \[Nm\], as from [`rnea`](super::rnea).
    pub tau: [f64; MAX_DOF],
    /// ∂τ/∂q \[Nm/rad\].
    pub dq: JointMatrix,
    /// ∂τ/∂q̇ \[Nm s/rad\].
    pub dqd: JointMatrix,
    /// ∂τ/∂q̈ = M(q) \[kg m²\].
    pub mass: JointMatrix,
}

/// Torques and their derivatives for the motion `q` \[rad\], `qd` \[rad/s\], `qdd` \[rad/s²\] with
/// `load` at the flange: rigid bodies and reflected rotors, no friction. The inputs have one entry
/// per joint (missing ones are 0). All zero if the robot has no dynamics.
pub fn rnea_derivatives(
    model: &Model,
    data: &mut Data,
    load: &Load,
    q: &[f64],
    qd: &[f64],
    qdd: &[f64],
) -> Derivatives {
    let mut out = Derivatives {
        tau: [0.0; MAX_DOF],
        dq: JointMatrix::zeros(),
        dqd: JointMatrix::zeros(),
        mass: JointMatrix::zeros(),
    };
    let Some(loaded) = load.on(model) else { return out };
    let geometry = &model.kinematics;
    let [angles, rates, accelerations] = [q, qd, qdd].map(|values| geometry.to_serial(values));
    let n = links(model);

    let mut rotation = Matrix3::identity();
    let mut origin = Vector3::zeros();
    let mut v = Motion::default();
    let mut a = Motion { angular: Vector3::zeros(), linear: model.kinematics.up() * GRAVITY };
    for i in 0..n {
        let joint = &geometry.joints[i];
        let link = if i + 1 == n { &loaded } else { &model.links[i] };
        origin += rotation * joint.translation;
        rotation *= joint.rotation_at(angles[i]);
        let z = rotation * joint.axis.into_inner();
        let s = Motion { angular: z, linear: origin.cross(&z) };
        let dv = v.cross(&s);
        data.axis[i] = s;
        data.velocity_slope[i] = dv;
        data.acceleration_slope[i] = a.cross(&s) + v.cross(&dv);
        v = v + s * rates[i];
        a = a + s * accelerations[i] + dv * rates[i];

        let com = origin + rotation * link.com;
        let about_com = rotation * link.inertia * rotation.transpose();
        let y = Inertia::of_body(link.mass, &com, &about_com);
        let h = y.times(&v);
        data.wrench[i] = y.times(&a) + v.cross_force(&h);
        data.momentum[i] = h.force;
        data.turning[i] = turning(&y, &v);
        data.inertia[i] = y;
    }
    for k in (0..n).rev() {
        if k + 1 < n {
            data.inertia[k] += data.inertia[k + 1];
            data.wrench[k] += data.wrench[k + 1];
            data.turning[k] += data.turning[k + 1];
            data.momentum[k] += data.momentum[k + 1];
        }
        fill(data, k, &mut out);
    }
    out.tau = geometry.from_serial_torque(out.tau);
    for matrix in [&mut out.dq, &mut out.dqd, &mut out.mass] {
        *matrix = joint_matrix::from_serial(model, *matrix);
    }
    add_rotors(model, &mut out.mass);
    for (sum, rotor) in out.tau.iter_mut().zip(rotor_torques(model, qdd)) {
        *sum += rotor;
    }
    out
}

/// Row and column k up to the diagonal, from the sums over the bodies from k on.
fn fill(data: &Data, k: usize, out: &mut Derivatives) {
    let (y, s) = (&data.inertia[k], &data.axis[k]);
    let (d, h) = (&data.turning[k], &data.momentum[k]);
    let bend = |alpha: &Vector3<f64>| Force { moment: d * alpha, force: alpha.cross(h) * 2.0 };
    let (dv, da) = (&data.velocity_slope[k], &data.acceleration_slope[k]);
    out.tau[k] = s.dot(&data.wrench[k]);

    let mass = y.times(s);
    let by_angle = s.cross_force(&data.wrench[k]) + y.times(da) + bend(&dv.angular);
    let by_rate = y.times(&(*dv * 2.0)) + bend(&s.angular);
    // Sᵀ B as a covector on angular velocities.
    let bent = d.tr_mul(&s.angular) + h.cross(&s.linear) * 2.0;
    for i in 0..=k {
        let other = &data.axis[i];
        let m = other.dot(&mass);
        out.mass[(i, k)] = m;
        out.mass[(k, i)] = m;
        out.dq[(i, k)] = other.dot(&by_angle);
        out.dqd[(i, k)] = other.dot(&by_rate);
        if i < k {
            let (dv, da) = (&data.velocity_slope[i], &data.acceleration_slope[i]);
            out.dq[(k, i)] = da.dot(&mass) + bent.dot(&dv.angular);
            out.dqd[(k, i)] = 2.0 * dv.dot(&mass) + bent.dot(&other.angular);
        }
    }
}

/// D of one body.
fn turning(y: &Inertia, v: &Motion) -> Matrix3<f64> {
    let about = &y.about_origin;
    let half = 0.5 * (about[(0, 0)] + about[(1, 1)] + about[(2, 2)]);
    let second = Matrix3::from_diagonal_element(half) - about;
    // [m c] [v] = v (m c)ᵀ − (m c · v) 1
    let pull =
        v.linear * y.first.transpose() - Matrix3::from_diagonal_element(y.first.dot(&v.linear));
    (v.angular.cross_matrix() * second + pull) * -2.0
}

//! Inverse dynamics by the principle of virtual work, in the base frame.
//!
//! With the Jacobian `J = z_i × (c − o_i)` of a body's centre of mass c for the axes `z_i` through
//! `o_i`, and its angular momentum `L = I ω`, inertial and gravity forces do the same virtual work
//! as the joint torques:
//!
//! ```text
//! τ_i = Σ_bodies J_i · m (J q̈ + J̇ q̇ + g) + z_i · d(I ω)/dt
//! ```
//!
//! It needs neither a recursion over links nor link frames (T. R. Kane, D. A. Levinson, "Dynamics:
//! Theory and Applications", 1985).

use nalgebra::{Matrix3, Vector3};

use crate::arm::robot::{Geometry, MAX_DOF};

/// A number for each joint; surplus entries are 0.
pub(super) type Joints = [f64; MAX_DOF];

/// Adds numbers of each joint.
pub(super) fn add(sum: &mut Joints, part: &Joints) {
    for (sum, part) in sum.iter_mut().zip(part) {
        *sum += part;
    }
}

/// The first of `values` as a number for each joint; missing ones are 0.
pub(super) fn of_slice(values: &[f64]) -> Joints {
    std::array::from_fn(|joint| values.get(joint).copied().unwrap_or_default())
}

/// Gravitational acceleration \[m/s²\].
pub(super) const GRAVITY: f64 = 9.81;

/// A rigid body in the frame of the joint that it moves with.
#[derive(Clone, Debug)]
pub(super) struct Body {
    /// Index of the joint, from 0.
    pub(super) joint: usize,
    /// Mass \[kg\].
    pub(super) mass: f64,
    /// Centre of mass \[m\].
    pub(super) com: Vector3<f64>,
    /// Inertia about the centre of mass \[kg m²\].
    pub(super) inertia: Matrix3<f64>,
}

/// Axes of a moving arm in the base frame.
pub(super) struct Axes {
    dof: usize,
    origins: [Vector3<f64>; MAX_DOF],
    directions: [Vector3<f64>; MAX_DOF],
    rotations: [Matrix3<f64>; MAX_DOF],
    qd: Joints,
    qdd: Joints,
    /// Time derivatives of `origins` and `directions`.
    origin_rates: [Vector3<f64>; MAX_DOF],
    direction_rates: [Vector3<f64>; MAX_DOF],
    /// Angular velocity and acceleration of the link after each joint.
    spin: [Vector3<f64>; MAX_DOF],
    spin_rate: [Vector3<f64>; MAX_DOF],
}

impl Axes {
    /// The axes of the serial chain at the angles `q` \[rad\] with rates and accelerations.
    pub(super) fn at(geometry: &Geometry, q: &Joints, qd: &Joints, qdd: &Joints) -> Axes {
        let zero = [Vector3::zeros(); MAX_DOF];
        let mut axes = Axes {
            dof: geometry.joints.len().min(MAX_DOF),
            origins: zero,
            directions: zero,
            rotations: [Matrix3::identity(); MAX_DOF],
            qd: *qd,
            qdd: *qdd,
            origin_rates: zero,
            direction_rates: zero,
            spin: zero,
            spin_rate: zero,
        };
        let mut rotation = Matrix3::identity();
        let mut origin = Vector3::zeros();
        for (i, joint) in geometry.joints.iter().take(MAX_DOF).enumerate() {
            origin += rotation * joint.translation;
            rotation *= joint.rotation_at(q[i]);
            axes.origins[i] = origin;
            axes.rotations[i] = rotation;
            axes.directions[i] = rotation * joint.axis.into_inner();
        }
        for i in 0..axes.dof {
            let carried: Vector3<f64> = (0..i).map(|k| axes.directions[k] * qd[k]).sum();
            axes.origin_rates[i] = axes.velocity(i, &axes.origins[i]);
            axes.direction_rates[i] = carried.cross(&axes.directions[i]);
            axes.spin[i] = carried + axes.directions[i] * qd[i];
            axes.spin_rate[i] = (0..=i)
                .map(|k| axes.directions[k] * qdd[k] + axes.direction_rates[k] * qd[k])
                .sum();
        }
        axes
    }

    /// Velocity of a point that moves with the joints before `count`.
    fn velocity(&self, count: usize, point: &Vector3<f64>) -> Vector3<f64> {
        (0..count).map(|k| self.directions[k].cross(&(point - self.origins[k])) * self.qd[k]).sum()
    }

    /// Transforms a point from a joint's frame to the base frame.
    pub(super) fn point(&self, joint: usize, local: &Vector3<f64>) -> Vector3<f64> {
        self.origins[joint] + self.rotations[joint] * local
    }

    /// Adds the torques that move a body; `up` is the acceleration opposite to gravity \[m/s²\].
    pub(super) fn add_body(&self, body: &Body, up: &Vector3<f64>, tau: &mut Joints) {
        let k = body.joint;
        let centre = self.point(k, &body.com);
        let velocity = self.velocity(k + 1, &centre);
        let mut acceleration = *up;
        let mut jacobian = [Vector3::zeros(); MAX_DOF];
        for i in 0..=k {
            let arm = centre - self.origins[i];
            jacobian[i] = self.directions[i].cross(&arm);
            let rate = self.direction_rates[i].cross(&arm)
                + self.directions[i].cross(&(velocity - self.origin_rates[i]));
            acceleration += jacobian[i] * self.qdd[i] + rate * self.qd[i];
        }
        let force = acceleration * body.mass;
        let turned = &self.rotations[k];
        let inertia = turned * body.inertia * turned.transpose();
        let spin = &self.spin[k];
        let moment = inertia * self.spin_rate[k] + spin.cross(&(inertia * spin));
        for i in 0..=k {
            tau[i] += jacobian[i].dot(&force) + self.directions[i].dot(&moment);
        }
    }

    /// Adds the torques that balance a force on a point of a joint's frame, both in the base frame
    /// \[N, m\].
    pub(super) fn add_force(
        &self,
        joint: usize,
        point: &Vector3<f64>,
        force: &Vector3<f64>,
        tau: &mut Joints,
    ) {
        for i in 0..=joint {
            tau[i] -= self.directions[i].cross(&(point - self.origins[i])).dot(force);
        }
    }
}

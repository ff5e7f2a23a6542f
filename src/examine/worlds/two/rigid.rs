//! Rigid-body dynamics of a serial arm in coordinates of the base.
//!
//! All spatial quantities are taken about the origin of the base, so that composite inertias and
//! forces add without transformations (R. Featherstone, Rigid Body Dynamics Algorithms, 2008).

use crate::examine::worlds::model::{Body, Joint, M3, MAX, Row, V3};
use nalgebra::{Rotation3, SMatrix, SVector, Unit};

/// Gravity \[m/s²\].
pub(super) const GRAVITY: f64 = 9.81;

pub(super) fn joined(a: &Body, b: &Body) -> Body {
    let mass = a.mass + b.mass;
    let com = (a.com * a.mass + b.com * b.mass) / mass;
    let inertia =
        a.inertia + b.inertia + steiner(&(a.com - com)) * a.mass + steiner(&(b.com - com)) * b.mass;
    Body { mass, com, inertia }
}

/// `c·c 1 − c cᵀ`: inertia of a unit mass at `c`.
pub(super) fn steiner(c: &V3) -> M3 {
    M3::identity() * c.norm_squared() - c * c.transpose()
}

/// A serial arm.
#[derive(Clone, Debug)]
pub(super) struct Arm {
    pub(super) joints: Vec<Joint>,
    /// Its bodies, one for each joint.
    pub(super) bodies: Vec<Body>,
    /// Gravity in the frame of the base \[m/s²\].
    pub(super) gravity: V3,
    /// Reflected rotor inertias \[kg m²\].
    pub(super) rotor: Row,
    /// Origin of the flange in the frame of the last joint \[m\].
    pub(super) flange: V3,
}

/// Where the bodies are: all in the frame of the base.
#[derive(Clone, Debug)]
pub(super) struct Pose {
    pub(super) n: usize,
    pub(super) axis: [V3; MAX],
    /// `origin × axis`: velocity at the base's origin per joint rate.
    pub(super) moment: [V3; MAX],
    pub(super) last: M3,
    /// The flange \[m\].
    pub(super) flange: V3,
    mass: [f64; MAX],
    first: [V3; MAX],
    second: [M3; MAX],
}

impl Arm {
    pub(super) fn n(&self) -> usize {
        self.joints.len()
    }

    /// Places the bodies at joint angles \[rad\].
    pub(super) fn pose(&self, q: &Row) -> Pose {
        let zero = V3::zeros();
        let mut pose = Pose {
            n: self.n(),
            axis: [zero; MAX],
            moment: [zero; MAX],
            last: M3::identity(),
            flange: zero,
            mass: [0.0; MAX],
            first: [zero; MAX],
            second: [M3::zeros(); MAX],
        };
        let mut place = zero;
        let mut turn = M3::identity();
        for (i, (joint, body)) in self.joints.iter().zip(&self.bodies).enumerate() {
            place += turn * joint.origin;
            turn *= joint.rotation;
            pose.axis[i] = turn * joint.axis;
            pose.moment[i] = place.cross(&pose.axis[i]);
            turn *= about(&joint.axis, q[i]);
            let com = place + turn * body.com;
            pose.mass[i] = body.mass;
            pose.first[i] = com * body.mass;
            pose.second[i] = turn * body.inertia * turn.transpose() + steiner(&com) * body.mass;
        }
        pose.last = turn;
        pose.flange = place + turn * self.flange;
        pose
    }

    /// Torques of the links for a motion \[Nm\]; without rotors and friction.
    pub(super) fn inverse(&self, pose: &Pose, qd: &Row, qdd: &Row) -> Row {
        let n = pose.n;
        let (mut w, mut v) = (V3::zeros(), V3::zeros());
        let (mut wd, mut vd) = (V3::zeros(), -self.gravity);
        let mut moments = [V3::zeros(); MAX];
        let mut forces = [V3::zeros(); MAX];
        for i in 0..n {
            let (z, m) = (pose.axis[i], pose.moment[i]);
            w += z * qd[i];
            v += m * qd[i];
            wd += z * qdd[i] + w.cross(&z) * qd[i];
            vd += m * qdd[i] + (w.cross(&m) + v.cross(&z)) * qd[i];
            let linear = v * pose.mass[i] + w.cross(&pose.first[i]);
            let angular = pose.second[i] * w + pose.first[i].cross(&v);
            forces[i] = vd * pose.mass[i] + wd.cross(&pose.first[i]) + w.cross(&linear);
            moments[i] = pose.second[i] * wd
                + pose.first[i].cross(&vd)
                + w.cross(&angular)
                + v.cross(&linear);
        }
        let mut out = [0.0; MAX];
        let (mut f, mut t) = (V3::zeros(), V3::zeros());
        for i in (0..n).rev() {
            f += forces[i];
            t += moments[i];
            out[i] = pose.axis[i].dot(&t) + pose.moment[i].dot(&f);
        }
        out
    }

    /// The inverse dynamics at angles, rates and accelerations, links only \[Nm\].
    pub(super) fn torques(&self, q: &Row, qd: &Row, qdd: &Row) -> Row {
        self.inverse(&self.pose(q), qd, qdd)
    }
}

impl Pose {
    /// Mass matrix of the links \[kg m²\] by composite bodies; the unused diagonal is 1.
    pub(super) fn mass_matrix(&self) -> SMatrix<f64, MAX, MAX> {
        let mut out = SMatrix::<f64, MAX, MAX>::identity();
        let mut mass = 0.0;
        let mut first = V3::zeros();
        let mut second = M3::zeros();
        for i in (0..self.n).rev() {
            mass += self.mass[i];
            first += self.first[i];
            second += self.second[i];
            let torque = second * self.axis[i] + first.cross(&self.moment[i]);
            let force = self.moment[i] * mass + self.axis[i].cross(&first);
            for j in 0..=i {
                let value = self.axis[j].dot(&torque) + self.moment[j].dot(&force);
                out[(i, j)] = value;
                out[(j, i)] = value;
            }
        }
        out
    }

    /// Joint torques of a force \[N\] on the flange: `Jᵀ f`.
    pub(super) fn of_force(&self, force: &V3) -> Row {
        let torque = self.flange.cross(force);
        let mut out = [0.0; MAX];
        for i in 0..self.n {
            out[i] = self.axis[i].dot(&torque) + self.moment[i].dot(force);
        }
        out
    }

    /// Velocity of the flange \[m/s\].
    pub(super) fn flange_velocity(&self, qd: &Row) -> V3 {
        let mut v = V3::zeros();
        for i in 0..self.n {
            v += (self.moment[i] + self.axis[i].cross(&self.flange)) * qd[i];
        }
        v
    }
}

/// Solves `a x = b` for a symmetric positive matrix (Cholesky); 0 where it is not positive.
pub(super) fn solve(a: &SMatrix<f64, MAX, MAX>, b: &Row) -> Row {
    let right = SVector::<f64, MAX>::from_row_slice(b);
    a.cholesky().map_or([0.0; MAX], |factor| factor.solve(&right).into())
}

/// Turn about a unit axis (Rodrigues).
pub(super) fn about(axis: &V3, angle: f64) -> M3 {
    Rotation3::from_axis_angle(&Unit::new_unchecked(*axis), angle).into_inner()
}

/// Rotation of roll, pitch, yaw (about fixed x, then y, then z).
pub(super) fn from_rpy(rpy: &V3) -> M3 {
    Rotation3::from_euler_angles(rpy.x, rpy.y, rpy.z).into_inner()
}

//! Rigid-body dynamics of a serial arm in coordinates of the base.
//!
//! All spatial quantities are taken about the origin of the base, so that composite inertias and
//! forces add without transformations (R. Featherstone, Rigid Body Dynamics Algorithms, 2008).

use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, Unit, Vector3};

/// Most joints an arm has.
pub const MAX: usize = 7;
/// One value for each joint; those beyond the arm's joints are 0.
pub type Joints = [f64; MAX];
/// Gravity \[m/s²\].
pub const GRAVITY: f64 = 9.81;

/// A joint, as in a URDF.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Origin in the frame of the joint before \[m\].
    pub origin: Vector3<f64>,
    /// Roll, pitch, yaw \[rad\].
    pub rpy: Vector3<f64>,
    /// The same as a matrix.
    pub rotation: Matrix3<f64>,
    /// Axis in the joint's own frame.
    pub axis: Vector3<f64>,
}

/// A rigid body in the frame of its joint.
#[derive(Clone, Debug)]
pub struct Body {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\].
    pub com: Vector3<f64>,
    /// Inertia about the centre of mass \[kg m²\].
    pub inertia: Matrix3<f64>,
}

impl Body {
    /// Both bodies as one.
    pub fn with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        let com = (self.com * self.mass + other.com * other.mass) / mass;
        let inertia = self.inertia
            + other.inertia
            + steiner(&(self.com - com)) * self.mass
            + steiner(&(other.com - com)) * other.mass;
        Self { mass, com, inertia }
    }
}

/// `c·c 1 − c cᵀ`: inertia of a unit mass at `c`.
pub fn steiner(c: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * c.norm_squared() - c * c.transpose()
}

/// A serial arm.
#[derive(Clone, Debug)]
pub struct Arm {
    /// Its joints.
    pub joints: Vec<Joint>,
    /// Its bodies, one for each joint.
    pub bodies: Vec<Body>,
    /// Gravity in the frame of the base \[m/s²\].
    pub gravity: Vector3<f64>,
    /// Reflected rotor inertias \[kg m²\].
    pub rotor: Joints,
    /// Origin of the flange in the frame of the last joint \[m\].
    pub flange: Vector3<f64>,
}

/// Where the bodies are: all in the frame of the base.
#[derive(Clone, Debug)]
pub struct Pose {
    /// Number of joints.
    pub n: usize,
    /// Axes.
    pub axis: [Vector3<f64>; MAX],
    /// `origin × axis`: velocity at the base's origin per joint rate.
    pub moment: [Vector3<f64>; MAX],
    /// Orientation of the last frame.
    pub last: Matrix3<f64>,
    /// The flange \[m\].
    pub flange: Vector3<f64>,
    mass: [f64; MAX],
    first: [Vector3<f64>; MAX],
    second: [Matrix3<f64>; MAX],
}

impl Arm {
    /// Number of joints.
    pub fn n(&self) -> usize {
        self.joints.len()
    }

    /// Places the bodies at joint angles \[rad\].
    pub fn pose(&self, q: &Joints) -> Pose {
        let zero = Vector3::zeros();
        let mut pose = Pose {
            n: self.n(),
            axis: [zero; MAX],
            moment: [zero; MAX],
            last: Matrix3::identity(),
            flange: zero,
            mass: [0.0; MAX],
            first: [zero; MAX],
            second: [Matrix3::zeros(); MAX],
        };
        let mut place = zero;
        let mut turn = Matrix3::identity();
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
    pub fn inverse(&self, pose: &Pose, qd: &Joints, qdd: &Joints) -> Joints {
        let n = pose.n;
        let (mut w, mut v) = (Vector3::zeros(), Vector3::zeros());
        let (mut wd, mut vd) = (Vector3::zeros(), -self.gravity);
        let mut moments = [Vector3::zeros(); MAX];
        let mut forces = [Vector3::zeros(); MAX];
        for i in 0..n {
            let (z, m) = (pose.axis[i], pose.moment[i]);
            w += z * qd[i];
            v += m * qd[i];
            wd += z * qdd[i] + w.cross(&z) * qd[i];
            vd += m * qdd[i] + (w.cross(&m) + v.cross(&z)) * qd[i];
            let linear = v * pose.mass[i] + w.cross(&pose.first[i]);
            let angular = pose.second[i] * w + pose.first[i].cross(&v);
            forces[i] = vd * pose.mass[i] + wd.cross(&pose.first[i]) + w.cross(&linear);
            moments[i] =
                pose.second[i] * wd + pose.first[i].cross(&vd) + w.cross(&angular) + v.cross(&linear);
        }
        let mut out = [0.0; MAX];
        let (mut f, mut t) = (Vector3::zeros(), Vector3::zeros());
        for i in (0..n).rev() {
            f += forces[i];
            t += moments[i];
            out[i] = pose.axis[i].dot(&t) + pose.moment[i].dot(&f);
        }
        out
    }

    /// The inverse dynamics at angles, rates and accelerations, links only \[Nm\].
    pub fn torques(&self, q: &Joints, qd: &Joints, qdd: &Joints) -> Joints {
        self.inverse(&self.pose(q), qd, qdd)
    }
}

impl Pose {
    /// Mass matrix of the links \[kg m²\] by composite bodies; the unused diagonal is 1.
    pub fn mass_matrix(&self) -> SMatrix<f64, MAX, MAX> {
        let mut out = SMatrix::<f64, MAX, MAX>::identity();
        let mut mass = 0.0;
        let mut first = Vector3::zeros();
        let mut second = Matrix3::zeros();
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
    pub fn of_force(&self, force: &Vector3<f64>) -> Joints {
        let torque = self.flange.cross(force);
        let mut out = [0.0; MAX];
        for i in 0..self.n {
            out[i] = self.axis[i].dot(&torque) + self.moment[i].dot(force);
        }
        out
    }

    /// Velocity of the flange \[m/s\].
    pub fn flange_velocity(&self, qd: &Joints) -> Vector3<f64> {
        let mut v = Vector3::zeros();
        for i in 0..self.n {
            v += (self.moment[i] + self.axis[i].cross(&self.flange)) * qd[i];
        }
        v
    }
}

/// Solves `a x = b` for a symmetric positive matrix (Cholesky); 0 where it is not positive.
pub fn solve(a: &SMatrix<f64, MAX, MAX>, b: &Joints) -> Joints {
    let right = SVector::<f64, MAX>::from_row_slice(b);
    a.cholesky().map_or([0.0; MAX], |factor| factor.solve(&right).into())
}

/// Turn about a unit axis (Rodrigues).
pub fn about(axis: &Vector3<f64>, angle: f64) -> Matrix3<f64> {
    Rotation3::from_axis_angle(&Unit::new_unchecked(*axis), angle).into_inner()
}

/// Rotation of roll, pitch, yaw (about fixed x, then y, then z).
pub fn from_rpy(rpy: &Vector3<f64>) -> Matrix3<f64> {
    Rotation3::from_euler_angles(rpy.x, rpy.y, rpy.z).into_inner()
}

//! The chain of joints, and the OPW form that most industrial arms have.
//!
//! OPW: M. Brandstötter, A. Angerer, M. Hofbaur, "An analytical solution of the
//! inverse kinematics problem of industrial serial manipulators with an
//! ortho-parallel basis and a spherical wrist", Austrian Robotics Workshop 2014;
//! the letters are theirs.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};

/// The largest number of joints a model may have.
pub const MAX_DOF: usize = 7;

/// Acceleration of free fall \[m/s²\].
pub const GRAVITY: f64 = 9.81;

/// Below this, a coordinate of an axis or an origin is rounding of a zero.
const ROUNDING: f64 = 1e-15;

/// One revolute joint, placed in its parent's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Origin of the joint's frame in the parent's frame \[m\].
    pub translation: Vector3<f64>,
    /// Rotation of the joint's frame at angle 0 in the parent's frame.
    pub rotation: Rotation3<f64>,
    /// Axis of rotation, the same in the joint's frame and at angle 0.
    pub axis: Unit<Vector3<f64>>,
}

impl Joint {
    /// Rotation of the joint's frame in the parent's frame at the angle `q` \[rad\].
    #[must_use]
    #[inline]
    pub fn rotation_at(&self, q: f64) -> Matrix3<f64> {
        let (sin, cos) = q.sin_cos();
        let a = &self.axis;
        let v = a.scale(1.0 - cos);
        let turn = Matrix3::new(
            cos + v.x * a.x,
            v.x * a.y - sin * a.z,
            v.x * a.z + sin * a.y,
            v.y * a.x + sin * a.z,
            cos + v.y * a.y,
            v.y * a.z - sin * a.x,
            v.z * a.x - sin * a.y,
            v.z * a.y + sin * a.x,
            cos + v.z * a.z,
        );
        // Most chains are drawn with frames that are parallel at angle 0.
        if *self.rotation.matrix() == Matrix3::identity() {
            return turn;
        }
        self.rotation.matrix() * turn
    }
}

/// Parameters of an ortho-parallel basis with a spherical wrist \[m, rad\].
///
/// The OPW angle of a joint is `signs · q − offsets`. At OPW angle 0 of all
/// joints the arm points straight up along z of the base.
#[derive(Clone, Debug, PartialEq)]
pub struct Opw {
    /// Axis 2 before axis 1.
    pub a1: f64,
    /// Offset of the forearm from axis 3; negative: axis 4 lies above axis 3
    /// when the forearm is level.
    pub a2: f64,
    /// Lateral offset of the arm from axis 1.
    pub b: f64,
    /// Height of axis 2.
    pub c1: f64,
    /// Upper arm.
    pub c2: f64,
    /// Forearm, to the wrist centre.
    pub c3: f64,
    /// Wrist centre to flange.
    pub c4: f64,
    /// Zero offsets of the joints.
    pub offsets: [f64; 6],
    /// Senses of rotation, +1 or −1.
    pub signs: [f64; 6],
}

/// An arm of the OPW form up to axis 5, whose axis 6 does not meet the crossing of axes 4 and 5.
#[derive(Clone, Debug, PartialEq)]
pub struct OffsetWrist {
    /// The arm if its axis 6 went through the crossing of axes 4 and 5, and its flange
    /// lay there (`c4` = 0).
    pub arm: Opw,
    /// That flange, at angle 0 of that axis 6, in the frame of joint 5.
    pub crossing: Isometry3<f64>,
}

/// How the joint angles that a controller reports turn the serial chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coupling {
    /// Each joint turns its own link.
    None,
    /// A parallelogram drives the forearm: axis 3 is reported as its angle to
    /// the base, so that the serial angle is q3 − q2.
    Parallelogram,
}

/// A rotation for each joint.
pub type Rotations = [Matrix3<f64>; MAX_DOF];

/// The chain from base to flange.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// Joints from the base on.
    pub joints: Vec<Joint>,
    /// tool0 in the last joint's frame; z points out of the flange.
    pub flange: Isometry3<f64>,
    /// The OPW parameters of the chain, where it has that form; a chain that is given
    /// joint by joint may have it too.
    pub opw: Option<Opw>,
    /// The form of a chain of six joints whose wrist axes do not meet in one point.
    pub offset_wrist: Option<OffsetWrist>,
    /// Coupling of joints 2 and 3.
    pub coupling: Coupling,
    /// The base frame in the world: where the robot stands, and how it is mounted.
    pub base: Isometry3<f64>,
}

impl Geometry {
    /// The serial angles of the reported ones, both \[rad\]; entries beyond the
    /// robot's joints are 0. Velocities and accelerations map the same way.
    #[must_use]
    pub fn to_serial(&self, q: &[f64]) -> [f64; MAX_DOF] {
        let mut serial = [0.0; MAX_DOF];
        for (to, from) in serial.iter_mut().zip(q).take(self.joints.len()) {
            *to = *from;
        }
        if self.coupling == Coupling::Parallelogram {
            serial[2] -= serial[1];
        }
        serial
    }

    /// Rotation of each joint's frame in its parent's at the reported angles `q` \[rad\].
    #[must_use]
    pub fn rotations(&self, q: &[f64]) -> Rotations {
        let mut rotations = [Matrix3::zeros(); MAX_DOF];
        self.turn(q, &mut rotations);
        rotations
    }

    /// Writes [`rotations`](Self::rotations) at `q` \[rad\] into `rotations`.
    #[inline]
    pub fn turn(&self, q: &[f64], rotations: &mut Rotations) {
        let angles = self.to_serial(q);
        for ((rotation, joint), angle) in rotations.iter_mut().zip(&self.joints).zip(angles) {
            *rotation = joint.rotation_at(angle);
        }
    }

    /// The torques at the reported joints of those at the serial ones (the
    /// transpose of [`to_serial`](Self::to_serial)) \[Nm\].
    #[must_use]
    pub fn from_serial_torque(&self, mut tau: [f64; MAX_DOF]) -> [f64; MAX_DOF] {
        if self.coupling == Coupling::Parallelogram {
            tau[1] -= tau[2];
        }
        tau
    }

    /// Unit vector against gravity, in the base frame.
    #[must_use]
    pub fn up(&self) -> Vector3<f64> {
        self.base.rotation.inverse() * Vector3::z()
    }
}

impl Opw {
    /// The chain of this arm. At angle 0 of all joints, every joint's frame is
    /// parallel to the base frame; the frames of joints 4 to 6 lie in the wrist
    /// centre.
    pub(super) fn chain(&self) -> (Vec<Joint>, Isometry3<f64>) {
        let steps = [
            (Vector3::zeros(), Vector3::z()),
            (Vector3::new(self.a1, self.b, self.c1), Vector3::y()),
            (Vector3::new(0.0, 0.0, self.c2), Vector3::y()),
            (Vector3::new(self.a2, 0.0, self.c3), Vector3::z()),
            (Vector3::zeros(), Vector3::y()),
            (Vector3::zeros(), Vector3::z()),
        ];
        let mut turned = Rotation3::identity();
        let mut joints = Vec::with_capacity(steps.len());
        for (i, (translation, axis)) in steps.into_iter().enumerate() {
            joints.push(Joint {
                translation: tidy(turned * translation),
                rotation: Rotation3::identity(),
                axis: Unit::new_normalize(tidy(turned * axis) * self.signs[i]),
            });
            turned *= Rotation3::from_axis_angle(&Unit::new_unchecked(axis), -self.offsets[i]);
        }
        let flange = Isometry3::from_parts(
            Translation3::from(tidy(turned * Vector3::new(0.0, 0.0, self.c4))),
            UnitQuaternion::from_rotation_matrix(&turned),
        );
        (joints, flange)
    }
}

fn tidy(v: Vector3<f64>) -> Vector3<f64> {
    v.map(|x| if x.abs() < ROUNDING { 0.0 } else { x })
}

//! The chain of joints, and the OPW form of most industrial arms.
//!
//! OPW: M. Brandstötter, A. Angerer, M. Hofbaur, "An analytical solution of the inverse kinematics
//! problem of industrial serial manipulators with an ortho-parallel basis and a spherical wrist",
//! Austrian Robotics Workshop 2014, with its symbols.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};

/// The largest number of joints a model may have.
pub const MAX_DOF: usize = 7;

/// Acceleration of free fall \[m/s²\].
pub const GRAVITY: f64 = 9.81;

/// Coordinates below this are rounding errors of zero.
const ROUNDING: f64 = 1e-15;

/// A revolute joint with its placement in the parent frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Origin of the joint frame in the parent frame \[m\].
    pub translation: Vector3<f64>,
    /// Rotation of the joint frame at angle 0 in the parent frame.
    pub rotation: Rotation3<f64>,
    /// Axis of rotation in the joint frame.
    pub axis: Unit<Vector3<f64>>,
}

impl Joint {
    /// Rotation of the joint frame in the parent frame at the angle `q` \[rad\].
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
        // Most chains have parallel frames at angle 0.
        if *self.rotation.matrix() == Matrix3::identity() {
            return turn;
        }
        self.rotation.matrix() * turn
    }
}

/// Parameters of an ortho-parallel basis with a spherical wrist \[m, rad\].
///
/// The OPW angle of a joint is `signs · q − offsets`. At OPW angles 0 the arm points along z of
/// the base.
#[derive(Clone, Debug, PartialEq)]
pub struct Opw {
    /// Distance from axis 1 forwards to axis 2.
    pub a1: f64,
    /// Offset of the forearm from axis 3; negative if axis 4 is above axis 3 with level forearm.
    pub a2: f64,
    /// Lateral offset of the arm from axis 1.
    pub b: f64,
    /// Height of axis 2.
    pub c1: f64,
    /// Length of the upper arm.
    pub c2: f64,
    /// Length of the forearm to the wrist centre.
    pub c3: f64,
    /// Distance from wrist centre to flange.
    pub c4: f64,
    /// Zero offsets of the joints.
    pub offsets: [f64; 6],
    /// Senses of rotation, +1 or −1.
    pub signs: [f64; 6],
}

/// An arm of OPW form up to axis 5 whose axis 6 misses the intersection of axes 4 and 5.
#[derive(Clone, Debug, PartialEq)]
pub struct OffsetWrist {
    /// The arm with an axis 6 through the intersection of axes 4 and 5 and its flange there
    /// (`c4` = 0).
    pub arm: Opw,
    /// That flange at angle 0 of that axis 6, in the frame of joint 5.
    pub crossing: Isometry3<f64>,
}

/// Relation of the reported joint angles to those of the serial chain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coupling {
    /// Each joint turns its own link.
    #[default]
    None,
    /// A parallelogram drives the forearm: the reported angle of axis 3 is relative to the base,
    /// so the serial angle is q3 − q2.
    Parallelogram,
}

/// One rotation per joint.
pub type Rotations = [Matrix3<f64>; MAX_DOF];

/// The chain from base to flange.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// Joints from the base on.
    pub joints: Vec<Joint>,
    /// tool0 in the frame of the last joint; z points out of the flange.
    pub flange: Isometry3<f64>,
    /// The OPW parameters if the chain has that form; also for a chain given joint by joint.
    pub opw: Option<Opw>,
    /// The form of a six-joint chain with wrist axes that do not meet in one point.
    pub offset_wrist: Option<OffsetWrist>,
    /// Coupling of joints 2 and 3.
    pub coupling: Coupling,
    /// The base frame in the world frame.
    pub base: Isometry3<f64>,
}

impl Geometry {
    /// The serial angles of the reported ones, both \[rad\]; entries beyond the joints are 0.
    /// Velocities and accelerations map in the same way.
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

    /// Rotation of each joint frame in its parent frame at the reported angles `q` \[rad\].
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

    /// Torques at the reported joints from those at the serial ones \[Nm\], the transpose of
    /// [`to_serial`](Self::to_serial).
    #[must_use]
    pub fn from_serial_torque(&self, mut tau: [f64; MAX_DOF]) -> [f64; MAX_DOF] {
        if self.coupling == Coupling::Parallelogram {
            tau[1] -= tau[2];
        }
        tau
    }

    /// Unit vector against gravity in the base frame.
    #[must_use]
    pub fn up(&self) -> Vector3<f64> {
        self.base.rotation.inverse() * Vector3::z()
    }
}

impl Opw {
    /// The chain of this arm. At joint angles 0 all joint frames are parallel to the base frame;
    /// the frames of joints 4 to 6 are in the wrist centre.
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

//! The chain of joints, and the OPW form that most industrial arms have.
//!
//! OPW: M. Brandstötter, A. Angerer, M. Hofbaur, "An analytical solution of the
//! inverse kinematics problem of industrial serial manipulators with an
//! ortho-parallel basis and a spherical wrist", Austrian Robotics Workshop 2014;
//! the letters are theirs.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};

use super::MAX_DOF;
use super::error::RobotError;
use super::fields::{ANGLE, Accepts, Fields, LENGTH};
use super::ortho_parallel::{offset_wrist, recognise};
use super::provenance::Origin;

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

/// An arm of the OPW form up to axis 5, which axis 6 passes at a distance.
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
    /// What else is known of a chain of six joints without that form.
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

    /// The same into memory that is there.
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

    pub(super) fn read(
        fields: Option<Fields>,
        joints: Vec<Fields>,
        origins: &mut Vec<Origin>,
    ) -> Result<Option<Geometry>, RobotError> {
        let mut opw = None;
        let mut flange = None;
        let mut base = None;
        let mut coupling = Coupling::None;
        if let Some(mut fields) = fields {
            opw = fields.table("opw")?.map(|table| Opw::read(table, origins)).transpose()?;
            flange = fields.table("flange")?.map(|table| pose(table, origins)).transpose()?;
            base = fields.table("base")?.map(|table| pose(table, origins)).transpose()?;
            let words = [("none", Coupling::None), ("parallelogram", Coupling::Parallelogram)];
            coupling = fields.choice("coupling", &words)?.unwrap_or(Coupling::None);
            let place = fields.place();
            origins.extend(fields.finish()?);
            if opw.is_some() && (!joints.is_empty() || flange.is_some()) {
                return Err(RobotError::Value {
                    place,
                    key: "kinematics.opw".into(),
                    value: "{…}".into(),
                    must: "alone: the flange is part of opw, [[joint]] is the other form".into(),
                });
            }
            if coupling == Coupling::Parallelogram && opw.is_none() && joints.len() < 3 {
                return Err(RobotError::Value {
                    place,
                    key: "kinematics.coupling".into(),
                    value: "\"parallelogram\"".into(),
                    must: "\"none\" for a robot of fewer than 3 joints".into(),
                });
            }
        }
        let base = base.unwrap_or_else(Isometry3::identity);
        if let Some(opw) = opw {
            let (joints, flange) = opw.chain();
            let (opw, offset_wrist) = (Some(opw), None);
            return Ok(Some(Geometry { joints, flange, opw, offset_wrist, coupling, base }));
        }
        let joints =
            joints.into_iter().map(|table| joint(table, origins)).collect::<Result<Vec<_>, _>>()?;
        if joints.is_empty() {
            return Ok(None);
        }
        let flange = flange.unwrap_or_else(Isometry3::identity);
        let opw = recognise(&joints, &flange);
        let offset_wrist = if opw.is_none() { offset_wrist(&joints) } else { None };
        Ok(Some(Geometry { joints, flange, opw, offset_wrist, coupling, base }))
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

    fn read(mut fields: Fields, origins: &mut Vec<Origin>) -> Result<Opw, RobotError> {
        let mut lengths = [0.0; 7];
        for (length, key) in lengths.iter_mut().zip(["a1", "a2", "b", "c1", "c2", "c3", "c4"]) {
            let value = fields.number(key, LENGTH)?;
            *length = fields.required(key, value)?;
        }
        let [a1, a2, b, c1, c2, c3, c4] = lengths;
        if c2 <= 0.0 || a2.hypot(c3) <= 0.0 {
            return Err(RobotError::Value {
                place: fields.place(),
                key: "kinematics.opw".into(),
                value: format!("{{ c2 = {c2}, c3 = {c3}, … }}"),
                must: "an arm with c2 > 0 and a forearm".into(),
            });
        }
        let offsets = fields.array::<6>("offsets", ANGLE)?;
        let offsets = fields.required("offsets", offsets)?;
        let signs = fields.array::<6>("signs", Accepts::Finite)?;
        let signs = fields.required("signs", signs)?;
        if signs.iter().any(|sign| sign.abs() != 1.0) {
            return Err(RobotError::Value {
                place: fields.place(),
                key: fields.path("signs"),
                value: format!("{signs:?}"),
                must: "1 or -1 for each joint".into(),
            });
        }
        origins.extend(fields.finish()?);
        Ok(Opw { a1, a2, b, c1, c2, c3, c4, offsets, signs })
    }
}

fn tidy(v: Vector3<f64>) -> Vector3<f64> {
    v.map(|x| if x.abs() < ROUNDING { 0.0 } else { x })
}

fn joint(mut fields: Fields, origins: &mut Vec<Origin>) -> Result<Joint, RobotError> {
    let origin = fields.array::<3>("origin", LENGTH)?;
    let origin = fields.required("origin", origin)?;
    let [roll, pitch, yaw] = fields.array::<3>("rpy", ANGLE)?.unwrap_or_default();
    let axis = fields.array::<3>("axis", Accepts::Between(-1e9, 1e9, "a direction"))?;
    let axis = fields.required("axis", axis)?;
    let Some(axis) = Unit::try_new(Vector3::from(axis), 1e-9) else {
        return Err(RobotError::Value {
            place: fields.place(),
            key: fields.path("axis"),
            value: "[0, 0, 0]".into(),
            must: "a direction".into(),
        });
    };
    origins.extend(fields.finish()?);
    Ok(Joint {
        translation: Vector3::from(origin),
        rotation: Rotation3::from_euler_angles(roll, pitch, yaw),
        axis,
    })
}

fn pose(mut fields: Fields, origins: &mut Vec<Origin>) -> Result<Isometry3<f64>, RobotError> {
    let origin = fields.array::<3>("origin", LENGTH)?.unwrap_or_default();
    let [roll, pitch, yaw] = fields.array::<3>("rpy", ANGLE)?.unwrap_or_default();
    origins.extend(fields.finish()?);
    Ok(Isometry3::from_parts(
        Translation3::from(Vector3::from(origin)),
        UnitQuaternion::from_euler_angles(roll, pitch, yaw),
    ))
}

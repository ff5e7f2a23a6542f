//! Reads `[kinematics]` and `[[joint]]` of a robot file.

use nalgebra::{Isometry3, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};

use super::error::RobotError;
use super::fields::{ANGLE, Accepts, Fields, LENGTH};
use super::geometry::{Coupling, Geometry, Joint, Opw};
use super::ortho_parallel::{offset_wrist, recognise};

impl Geometry {
    /// The geometry in the table `kinematics` of a robot and its tables of joints.
    pub(super) fn read(
        robot: &mut Fields,
        joints: Vec<Fields>,
    ) -> Result<Option<Geometry>, RobotError> {
        let words = [("none", Coupling::None), ("parallelogram", Coupling::Parallelogram)];
        let place = robot.place_of("kinematics");
        let kinematics = robot.part("kinematics", |fields| {
            let opw = fields.part("opw", Opw::read)?;
            let flange = fields.part("flange", pose)?;
            let base = fields.part("base", pose)?;
            Ok((opw, flange, base, fields.choice("coupling", &words)?.unwrap_or_default()))
        })?;
        let (opw, flange, base, coupling) = kinematics.unwrap_or_default();
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
        let base = base.unwrap_or_else(Isometry3::identity);
        if let Some(opw) = opw {
            let (joints, flange) = opw.chain();
            let (opw, offset_wrist) = (Some(opw), None);
            return Ok(Some(Geometry { joints, flange, opw, offset_wrist, coupling, base }));
        }
        let joints = joints.into_iter().map(|table| robot.read_whole(table, joint));
        let joints = joints.collect::<Result<Vec<_>, _>>()?;
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
    fn read(fields: &mut Fields) -> Result<Opw, RobotError> {
        let mut lengths = [0.0; 7];
        for (length, key) in lengths.iter_mut().zip(["a1", "a2", "b", "c1", "c2", "c3", "c4"]) {
            *length = fields.must(key, |f, key| f.number(key, LENGTH))?;
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
        let offsets = fields.must("offsets", |f, key| f.array(key, ANGLE))?;
        let signs: [f64; 6] = fields.must("signs", |f, key| f.array(key, Accepts::Finite))?;
        if signs.iter().any(|sign| sign.abs() != 1.0) {
            return Err(RobotError::Value {
                place: fields.place(),
                key: fields.path("signs"),
                value: format!("{signs:?}"),
                must: "1 or -1 for each joint".into(),
            });
        }
        Ok(Opw { a1, a2, b, c1, c2, c3, c4, offsets, signs })
    }
}

fn joint(fields: &mut Fields) -> Result<Joint, RobotError> {
    let origin: [f64; 3] = fields.must("origin", |f, key| f.array(key, LENGTH))?;
    let [roll, pitch, yaw] = fields.array::<3>("rpy", ANGLE)?.unwrap_or_default();
    let direction = Accepts::Between(-1e9, 1e9, "a direction");
    let axis: [f64; 3] = fields.must("axis", |f, key| f.array(key, direction))?;
    let Some(axis) = Unit::try_new(Vector3::from(axis), 1e-9) else {
        return Err(RobotError::Value {
            place: fields.place(),
            key: fields.path("axis"),
            value: "[0, 0, 0]".into(),
            must: "a direction".into(),
        });
    };
    Ok(Joint {
        translation: Vector3::from(origin),
        rotation: Rotation3::from_euler_angles(roll, pitch, yaw),
        axis,
    })
}

fn pose(fields: &mut Fields) -> Result<Isometry3<f64>, RobotError> {
    let origin = fields.array::<3>("origin", LENGTH)?.unwrap_or_default();
    let [roll, pitch, yaw] = fields.array::<3>("rpy", ANGLE)?.unwrap_or_default();
    Ok(Isometry3::from_parts(
        Translation3::from(Vector3::from(origin)),
        UnitQuaternion::from_euler_angles(roll, pitch, yaw),
    ))
}

//! Reads `[kinematics]` and `[[joint]]` of a robot file.

use nalgebra::{Isometry3, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};

use super::error::RobotError;
use super::fields::{ANGLE, Accepts, Fields, LENGTH};
use super::geometry::{Coupling, Geometry, Joint, Opw};
use super::ortho_parallel::{offset_wrist, recognise};
use super::provenance::Origin;

impl Geometry {
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

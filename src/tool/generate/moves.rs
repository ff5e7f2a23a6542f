//! Movement instructions for points without times.

use nalgebra::Isometry3;

use super::error::GenerateError;
use super::settings::Form;
use super::table::{Points, SpeedOrZone, Table};
use crate::arm::kinematics::{Conf, conf_of, fk, ik_conf, ik_near, limits_ok};
use crate::arm::robot::Model;
use crate::rapid::ir::number::number;
use crate::rapid::ir::predefined::lookup;
use crate::retime::path::joint_path::{DOF, Joints};

/// Default speed.
const SPEED: &str = "v200";
/// Default zone, also of the last point.
const STOP: &str = "fine";

/// A movement to each point.
pub(super) struct Moves {
    pub(super) form: Form,
    pub(super) targets: Vec<Target>,
    pub(super) notes: Vec<String>,
}

/// A point with its speed and zone.
pub(super) struct Target {
    /// Joint positions, rad.
    pub(super) q: Joints,
    pub(super) pose: Isometry3<f64>,
    pub(super) conf: Conf,
    /// RAPID text.
    pub(super) speed: String,
    /// RAPID text.
    pub(super) zone: String,
}

/// The movements to the points of a table without times.
pub(super) fn moves(model: &Model, table: &Table, form: Form) -> Result<Moves, GenerateError> {
    let positions = match &table.points {
        Points::Trajectory(_, q) | Points::Joints(q) => q.clone(),
        Points::Poses(poses) => joint_positions(model, poses)?,
    };
    let mut notes = Vec::new();
    let last = positions.len() - 1;
    let mut targets = Vec::with_capacity(positions.len());
    for (i, q) in positions.into_iter().enumerate() {
        let row = i + 2;
        limits_ok(model, &q).map_err(|violation| GenerateError::Range { row, violation })?;
        let (pose, conf) = match &table.points {
            Points::Poses(poses) => (poses[i].0, poses[i].1.unwrap_or_else(|| conf_of(model, &q))),
            _ => (fk(model, &q), conf_of(model, &q)),
        };
        let speed = speed_or_zone(row, table.speeds[i].as_ref(), "speeddata", SPEED, |metres| {
            format!("v1000\\V:={}", number(metres * 1e3, 3))
        })?;
        let zone = speed_or_zone(row, table.zones[i].as_ref(), "zonedata", STOP, |metres| {
            format!("z10\\Z:={}", number(metres * 1e3, 3))
        })?;
        let zone = if i == last && zone != STOP {
            notes
                .push(format!("the last point is {STOP} instead of {zone}: the motion ends there"));
            STOP.to_owned()
        } else {
            zone
        };
        targets.push(Target { q, pose, conf, speed, zone });
    }
    Ok(Moves { form, targets, notes })
}

/// Joint positions of poses: in the given configuration, or else near the previous point.
fn joint_positions(
    model: &Model,
    poses: &[(Isometry3<f64>, Option<Conf>)],
) -> Result<Vec<Joints>, GenerateError> {
    let mut near = [0.0; DOF];
    let mut positions = Vec::with_capacity(poses.len());
    for (i, (pose, conf)) in poses.iter().enumerate() {
        let solution = match conf {
            Some(conf) => ik_conf(model, pose, *conf),
            None => ik_near(model, pose, &near),
        };
        near = solution.map_err(|error| GenerateError::Pose { row: i + 2, error })?;
        positions.push(near);
    }
    Ok(positions)
}

/// The RAPID text of a speed or zone.
fn speed_or_zone(
    row: usize,
    amount: Option<&SpeedOrZone>,
    r#type: &str,
    default: &str,
    written: impl Fn(f64) -> String,
) -> Result<String, GenerateError> {
    match amount {
        None => Ok(default.to_owned()),
        Some(SpeedOrZone::Value(metres)) => Ok(written(*metres)),
        Some(SpeedOrZone::Name(name)) => match lookup(name) {
            Some(value) if &*value.type_key == r#type => Ok(name.clone()),
            _ => {
                let speed = r#type == "speeddata";
                Err(GenerateError::Name {
                    row,
                    name: name.clone(),
                    what: if speed { "speed" } else { "zone" },
                    example: if speed { "v100 or vmax" } else { "fine or z10" },
                })
            }
        },
    }
}

//! What identification or diagnosis added to a robot: `[effects.ID]`.
//!
//! Values are changes against the robot without the effect. A parameter of a joint is
//! written for one joint (`joint = 3`, `stiction = 2.5`), for some (`stiction_j3 = 2.5`) or
//! for all (`stiction = [0, 0, 2.5, 0, 0, 0]`).

use super::error::RobotError;
use super::fields::{Accepts, Fields};
use super::names::nearest;
use super::provenance::Origin;

/// The parameters of one effect.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectParameters {
    /// Id of the effect, such as `stribeck`.
    pub id: String,
    /// Name and values of each parameter that is given: one of the robot, or one for each
    /// joint, 0 for those that are not named.
    pub values: Vec<(String, Vec<f64>)>,
    /// Where the table stands.
    pub(super) place: String,
}

/// Whose a parameter is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Of {
    Joint,
    Robot,
}

/// An effect whose law the model has.
struct Known {
    id: &'static str,
    of: Of,
    parameters: &'static [&'static str],
}

const fn known(id: &'static str, of: Of, parameters: &'static [&'static str]) -> Known {
    Known { id, of, parameters }
}

const KNOWN: [Known; 15] = [
    known("apparent_torque", Of::Joint, &["inertia", "viscous"]),
    known("base_load", Of::Robot, &["power"]),
    known("brake_power", Of::Robot, &["power"]),
    known("copper_loss", Of::Joint, &["loss"]),
    known("encoder_offset", Of::Joint, &["offset"]),
    known("friction_level", Of::Joint, &["coulomb", "viscous"]),
    known("load_friction", Of::Joint, &["mu"]),
    known("no_regeneration", Of::Robot, &[]),
    known("payload", Of::Robot, &["mass", "com_x", "com_y", "com_z"]),
    known("rotor_inertia", Of::Joint, &["inertia"]),
    known("stribeck", Of::Joint, &["stiction", "velocity"]),
    known("torque_constant", Of::Joint, &["error"]),
    known("torque_offset", Of::Joint, &["offset"]),
    known("viscous_asymmetry", Of::Joint, &["asymmetry"]),
    known("wrist_coupling", Of::Robot, &["coupling", "coulomb", "viscous", "inertia"]),
];

impl EffectParameters {
    /// The tables of `[effects]`, by id.
    pub(super) fn read_all(
        mut fields: Fields,
        dof: usize,
        origins: &mut Vec<Origin>,
    ) -> Result<Vec<EffectParameters>, RobotError> {
        let mut effects = Vec::new();
        for id in fields.keys() {
            let Some(mut table) = fields.table(&id)? else { continue };
            let Some(effect) = KNOWN.iter().find(|effect| effect.id == id) else {
                return Err(no_law(&table, &id));
            };
            let mut values = Vec::new();
            let joint = match effect.of {
                Of::Joint if table.has("joint") => Some(table.joint("joint", dof)?),
                _ => None,
            };
            for name in effect.parameters {
                let found = match effect.of {
                    Of::Joint => of_joints(&mut table, name, joint, dof)?,
                    Of::Robot => table.number(name, Accepts::Finite)?.map(|value| vec![value]),
                };
                values.extend(found.map(|list| ((*name).to_owned(), list)));
            }
            let place = table.place();
            origins.extend(table.finish()?);
            effects.push(EffectParameters { id, values, place });
        }
        origins.extend(fields.finish()?);
        Ok(effects)
    }

    /// A parameter's values, if it is given.
    pub(super) fn of(&self, name: &str) -> Option<&[f64]> {
        let (_, list) = self.values.iter().find(|(known, _)| known == name)?;
        Some(list)
    }

    /// A parameter of the robot; 0 if it is not given.
    pub(super) fn number(&self, name: &str) -> f64 {
        self.of(name).and_then(|list| list.first()).copied().unwrap_or(0.0)
    }
}

/// A parameter of joints in one of its forms.
fn of_joints(
    table: &mut Fields,
    name: &str,
    joint: Option<usize>,
    dof: usize,
) -> Result<Option<Vec<f64>>, RobotError> {
    let single: Vec<String> =
        (1..=dof).map(|joint| format!("{name}_j{joint}")).filter(|key| table.has(key)).collect();
    if !single.is_empty() {
        let mut list = vec![0.0; dof];
        for (joint, value) in list.iter_mut().enumerate() {
            let key = format!("{name}_j{}", joint + 1);
            if table.has(&key) {
                *value = table.number(&key, Accepts::Finite)?.unwrap_or(0.0);
            }
        }
        return Ok(Some(list));
    }
    match joint {
        Some(joint) => Ok(table.number(name, Accepts::Finite)?.map(|value| {
            let mut list = vec![0.0; dof];
            list[joint] = value;
            list
        })),
        None => table.per_joint(name, dof, Accepts::Finite),
    }
}

fn no_law(table: &Fields, id: &str) -> RobotError {
    let ids = KNOWN.iter().map(|effect| effect.id);
    RobotError::Effect {
        place: table.place(),
        id: id.to_owned(),
        suggestion: nearest(id, ids.clone()).map(str::to_owned),
        known: ids.map(str::to_owned).collect(),
    }
}

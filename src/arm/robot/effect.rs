//! Effects that identification or diagnosis added to a robot: `[effects.ID]` as written.
//!
//! Values are changes relative to the robot without the effect. A joint parameter is written for
//! one joint (`joint = 3`, `stiction = 2.5`), for some (`stiction_j3 = 2.5`) or for all
//! (`stiction = [0, 0, 2.5, 0, 0, 0]`). Module `effects` defines their meaning.

use super::error::RobotError;
use super::fields::{Accepts, Fields};

/// The parameters of one effect.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectParameters {
    /// Id of the effect, such as `stribeck`.
    pub id: String,
    /// Name and values of each given parameter.
    pub values: Vec<(String, Given)>,
    /// Position of the table.
    pub place: String,
}

/// The values of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// One value for the robot.
    Robot(f64),
    /// One value per joint; 0 if not named.
    Joints(Vec<f64>),
}

impl EffectParameters {
    /// The tables of `[effects]`, by id.
    pub(super) fn read_all(
        fields: &mut Fields,
        dof: usize,
    ) -> Result<Vec<EffectParameters>, RobotError> {
        let mut effects = Vec::new();
        for id in fields.keys() {
            effects.extend(fields.part(&id, |table| EffectParameters::read(&id, table, dof))?);
        }
        Ok(effects)
    }

    fn read(id: &str, table: &mut Fields, dof: usize) -> Result<EffectParameters, RobotError> {
        let joint = if table.has("joint") { Some(table.joint("joint", dof)?) } else { None };
        let mut values: Vec<(String, Given)> = Vec::new();
        for key in table.keys() {
            let given = if table.is_list(&key) {
                table.per_joint(&key, dof, Accepts::Finite)?.map(|list| (key, Given::Joints(list)))
            } else {
                let (name, joint) = match of_one_joint(&key, dof) {
                    Some((name, joint)) => (name, Some(joint)),
                    None => (key.clone(), joint),
                };
                table.number(&key, Accepts::Finite)?.map(|x| match joint {
                    Some(joint) => (name, Given::one_joint(joint, x, dof)),
                    None => (name, Given::Robot(x)),
                })
            };
            let Some((name, given)) = given else { continue };
            let before = values.iter_mut().find(|(known, _)| *known == name);
            match (before, given) {
                (Some((_, Given::Joints(sum))), Given::Joints(list)) => {
                    sum.iter_mut().zip(list).for_each(|(sum, value)| *sum += value);
                }
                (_, given) => values.push((name, given)),
            }
        }
        Ok(EffectParameters { id: id.to_owned(), values, place: table.place() })
    }
}

/// `stiction_j3` is the `stiction` of joint 3.
fn of_one_joint(key: &str, dof: usize) -> Option<(String, usize)> {
    let (name, joint) = key.rsplit_once("_j")?;
    let joint: usize = joint.parse().ok().filter(|joint| (1..=dof).contains(joint))?;
    Some((name.to_owned(), joint - 1))
}

impl Given {
    /// A value of one joint, 0 for the others.
    pub(super) fn one_joint(joint: usize, value: f64, dof: usize) -> Given {
        let mut list = vec![0.0; dof];
        list[joint] = value;
        Given::Joints(list)
    }
}

//! What identification or diagnosis added to a robot: effects by their ids.

use super::error::RobotError;
use super::fields::Fields;
use super::provenance::Origin;

/// The parameters of one effect. What they mean is the effect's own matter.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectParameters {
    /// Id of the effect, such as `stribeck`.
    pub id: String,
    /// Name and values of each parameter; a single number is a list of one.
    pub values: Vec<(String, Vec<f64>)>,
}

impl EffectParameters {
    /// The tables of `[effects]`, by id.
    pub(super) fn read_all(
        mut fields: Fields,
        origins: &mut Vec<Origin>,
    ) -> Result<Vec<EffectParameters>, RobotError> {
        let mut effects = Vec::new();
        for id in fields.keys() {
            let Some(mut table) = fields.table(&id)? else { continue };
            let mut values = Vec::new();
            for name in table.keys() {
                if let Some(list) = table.any_numbers(&name)? {
                    values.push((name, list));
                }
            }
            origins.extend(table.finish()?);
            effects.push(EffectParameters { id, values });
        }
        origins.extend(fields.finish()?);
        Ok(effects)
    }
}

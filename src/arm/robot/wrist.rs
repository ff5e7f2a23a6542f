//! Coupling of the wrist gears.

use super::error::RobotError;
use super::fields::{Accepts, Fields};
use super::provenance::Origin;

/// Relation of wrist motors and wrist axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Wrist {
    /// Turns of the gear of axis 6 per turn of axis 5 with axis 6 at rest; 0 without coupling.
    pub coupling: f64,
}

impl Wrist {
    pub(super) fn uncoupled() -> Wrist {
        Wrist { coupling: 0.0 }
    }

    pub(super) fn read(
        mut fields: Fields,
        dof: usize,
        origins: &mut Vec<Origin>,
    ) -> Result<Wrist, RobotError> {
        let coupling = fields.number("coupling", Accepts::Finite)?.unwrap_or(0.0);
        if coupling != 0.0 && dof != 6 {
            return Err(RobotError::Value {
                place: fields.place(),
                key: fields.path("coupling"),
                value: coupling.to_string(),
                must: format!("0 for a robot of {dof} joints: it couples axes 5 and 6 of six"),
            });
        }
        origins.extend(fields.finish()?);
        Ok(Wrist { coupling })
    }
}

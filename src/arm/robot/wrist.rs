//! Coupling of the wrist gears.

use super::error::RobotError;
use super::fields::{Accepts, Fields};

/// Relation of wrist motors and wrist axes; by default uncoupled.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wrist {
    /// Turns of the gear of axis 6 per turn of axis 5 with axis 6 at rest; 0 without coupling.
    pub coupling: f64,
}

impl Wrist {
    pub(super) fn read(fields: &mut Fields, dof: usize) -> Result<Wrist, RobotError> {
        let coupling = fields.number("coupling", Accepts::Finite)?.unwrap_or(0.0);
        if coupling != 0.0 && dof != 6 {
            return Err(RobotError::Value {
                place: fields.place(),
                key: fields.path("coupling"),
                value: coupling.to_string(),
                must: format!("0 for a robot of {dof} joints: it couples axes 5 and 6 of six"),
            });
        }
        Ok(Wrist { coupling })
    }
}

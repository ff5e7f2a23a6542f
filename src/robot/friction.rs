//! Friction of the joints.

use super::error::RobotError;
use super::fields::{Accepts, Fields};
use super::provenance::Origin;

/// Coulomb and viscous friction, at the joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Coulomb friction of each joint \[Nm\].
    pub coulomb: Vec<f64>,
    /// Viscous friction of each joint \[Nm s/rad\].
    pub viscous: Vec<f64>,
}

impl Friction {
    pub(super) fn none(dof: usize) -> Friction {
        Friction { coulomb: vec![0.0; dof], viscous: vec![0.0; dof] }
    }

    pub(super) fn read(
        mut fields: Fields,
        dof: usize,
        origins: &mut Vec<Origin>,
    ) -> Result<Friction, RobotError> {
        let none = Friction::none(dof);
        let friction = Friction {
            coulomb: fields
                .per_joint("coulomb", dof, Accepts::NonNegative)?
                .unwrap_or(none.coulomb),
            viscous: fields
                .per_joint("viscous", dof, Accepts::NonNegative)?
                .unwrap_or(none.viscous),
        };
        origins.extend(fields.finish()?);
        Ok(friction)
    }
}

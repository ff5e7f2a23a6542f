//! Friction of the joints.

use super::error::RobotError;
use super::fields::{Accepts, Fields};

/// Joint friction; laws without a source are absent.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Coulomb friction of each joint \[Nm\].
    pub coulomb: Vec<f64>,
    /// Viscous friction of each joint \[Nm s/rad\].
    pub viscous: Vec<f64>,
    /// Half of the Coulomb friction forwards minus backwards \[Nm\].
    pub coulomb_asymmetry: Option<Vec<f64>>,
    /// The same for viscous friction \[Nm s/rad\].
    pub viscous_asymmetry: Option<Vec<f64>>,
    /// Friction at low speed above Coulomb friction.
    pub stribeck: Option<Stribeck>,
    /// Friction per gear torque \[1\].
    pub load_friction: Option<Vec<f64>>,
}

/// Friction that falls with speed (Stribeck effect).
#[derive(Clone, Debug, PartialEq)]
pub struct Stribeck {
    /// Breakaway friction above Coulomb friction \[Nm\].
    pub stiction: Vec<f64>,
    /// Speed at which it has fallen to 1/e \[rad/s\].
    pub velocity: Vec<f64>,
}

impl Friction {
    pub(super) fn none(dof: usize) -> Friction {
        Friction {
            coulomb: vec![0.0; dof],
            viscous: vec![0.0; dof],
            coulomb_asymmetry: None,
            viscous_asymmetry: None,
            stribeck: None,
            load_friction: None,
        }
    }

    pub(super) fn read(fields: &mut Fields, dof: usize) -> Result<Friction, RobotError> {
        let zero = || vec![0.0; dof];
        let mut law = |table: &str, key: &str, accepts: Accepts| {
            fields.part(table, |law| law.must(key, |law, key| law.per_joint(key, dof, accepts)))
        };
        let viscous_asymmetry = law("viscous_asymmetry", "asymmetry", Accepts::Finite)?;
        let load_friction = law("load_friction", "mu", Accepts::NonNegative)?;
        let stribeck = fields.part("stribeck", |table| Stribeck::read(table, dof))?;
        Ok(Friction {
            coulomb: fields.per_joint("coulomb", dof, Accepts::NonNegative)?.unwrap_or_else(zero),
            viscous: fields.per_joint("viscous", dof, Accepts::NonNegative)?.unwrap_or_else(zero),
            coulomb_asymmetry: fields.per_joint("coulomb_asymmetry", dof, Accepts::Finite)?,
            viscous_asymmetry,
            stribeck,
            load_friction,
        })
    }
}

impl Stribeck {
    fn read(fields: &mut Fields, dof: usize) -> Result<Stribeck, RobotError> {
        let stiction = fields.per_joint("stiction", dof, Accepts::Finite)?;
        let velocity = fields.per_joint("velocity", dof, Accepts::Positive)?;
        Ok(Stribeck {
            stiction: fields.required("stiction", stiction)?,
            velocity: fields.required("velocity", velocity)?,
        })
    }
}

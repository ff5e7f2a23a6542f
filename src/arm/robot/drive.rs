//! The drive unit, the brakes and the power at standstill.

use super::error::RobotError;
use super::fields::{Accepts, Fields};

/// Brake times \[s\].
const BRAKE_TIME: Accepts =
    Accepts::Between(0.0, 10.0, "0 or more and at most 10, in s (not milliseconds)");

/// Use of the negative mechanical power of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sharing {
    /// It is lost at its axis.
    #[default]
    None,
    /// Other axes use it through the common DC bus.
    Bus,
}

/// The drive unit; by default without power and losses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drive {
    /// Power of controller and drives with motors on, without holding power and brake coils \[W\].
    pub base_w: f64,
    /// Sharing between the axes.
    pub sharing: Sharing,
    /// Share of the negative bus power that is fed back to the grid.
    pub regeneration: f64,
}

impl Drive {
    pub(super) fn read(fields: &mut Fields) -> Result<Drive, RobotError> {
        let words = [("none", Sharing::None), ("bus", Sharing::Bus)];
        Ok(Drive {
            base_w: fields.number("base_w", Accepts::NonNegative)?.unwrap_or(0.0),
            sharing: fields.choice("sharing", &words)?.unwrap_or_default(),
            regeneration: fields.number("regeneration", Accepts::Share)?.unwrap_or(0.0),
        })
    }
}

/// The holding brakes of all joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Brakes {
    /// Energy of one release \[J\].
    pub energy_per_release_j: f64,
    /// Time from the command until the brakes are released \[s\].
    pub release_s: f64,
    /// Time from the command until the brakes hold \[s\].
    pub engage_s: f64,
    /// Power of the coils of released brakes \[W\].
    pub power_released_w: f64,
}

impl Brakes {
    pub(super) fn read(fields: &mut Fields) -> Result<Brakes, RobotError> {
        // Missing values have no origin and are estimated (`prior`).
        let mut number = |key: &str, accepts: Accepts| -> Result<f64, RobotError> {
            Ok(fields.number(key, accepts)?.unwrap_or(0.0))
        };
        Ok(Brakes {
            energy_per_release_j: number("energy_per_release_j", Accepts::NonNegative)?,
            release_s: number("release_s", BRAKE_TIME)?,
            engage_s: number("engage_s", BRAKE_TIME)?,
            power_released_w: number("power_released_w", Accepts::NonNegative)?,
        })
    }
}

/// Power at standstill with released brakes in addition to the modelled copper loss.
#[derive(Clone, Debug, PartialEq)]
pub struct Standstill {
    /// Constant holding power of each joint \[W\].
    pub holding_w: Vec<f64>,
}

impl Standstill {
    pub(super) fn none(dof: usize) -> Standstill {
        Standstill { holding_w: vec![0.0; dof] }
    }

    pub(super) fn read(fields: &mut Fields, dof: usize) -> Result<Standstill, RobotError> {
        let holding = fields.per_joint("holding_w", dof, Accepts::NonNegative)?;
        Ok(holding.map_or_else(|| Standstill::none(dof), |holding_w| Standstill { holding_w }))
    }
}

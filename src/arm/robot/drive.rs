//! The drive unit, the brakes and the power at standstill.

use super::error::RobotError;
use super::fields::{Accepts, Fields};
use super::provenance::Origin;

/// Brake times \[s\].
const BRAKE_TIME: Accepts =
    Accepts::Between(0.0, 10.0, "0 or more and at most 10, in s (not milliseconds)");

/// Use of the negative mechanical power of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharing {
    /// It is lost at its axis.
    None,
    /// Other axes use it through the common DC bus.
    Bus,
}

/// The drive unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Power of controller and drives with motors on, without holding power and brake coils \[W\].
    pub base_w: f64,
    /// Sharing between the axes.
    pub sharing: Sharing,
    /// Share of the negative bus power that is fed back to the grid.
    pub regeneration: f64,
}

impl Drive {
    pub(super) fn lossless() -> Drive {
        Drive { base_w: 0.0, sharing: Sharing::None, regeneration: 0.0 }
    }

    pub(super) fn read(mut fields: Fields, origins: &mut Vec<Origin>) -> Result<Drive, RobotError> {
        let words = [("none", Sharing::None), ("bus", Sharing::Bus)];
        let drive = Drive {
            base_w: fields.number("base_w", Accepts::NonNegative)?.unwrap_or(0.0),
            sharing: fields.choice("sharing", &words)?.unwrap_or(Sharing::None),
            regeneration: fields.number("regeneration", Accepts::Share)?.unwrap_or(0.0),
        };
        origins.extend(fields.finish()?);
        Ok(drive)
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
    pub(super) fn read(
        mut fields: Fields,
        origins: &mut Vec<Origin>,
    ) -> Result<Brakes, RobotError> {
        let energy = fields.number("energy_per_release_j", Accepts::NonNegative)?;
        let release = fields.number("release_s", BRAKE_TIME)?;
        let engage = fields.number("engage_s", BRAKE_TIME)?;
        let power = fields.number("power_released_w", Accepts::NonNegative)?;
        // Missing values have no origin and are estimated (`prior`).
        let brakes = Brakes {
            energy_per_release_j: energy.unwrap_or(0.0),
            release_s: release.unwrap_or(0.0),
            engage_s: engage.unwrap_or(0.0),
            power_released_w: power.unwrap_or(0.0),
        };
        origins.extend(fields.finish()?);
        Ok(brakes)
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

    pub(super) fn read(
        mut fields: Fields,
        dof: usize,
        origins: &mut Vec<Origin>,
    ) -> Result<Standstill, RobotError> {
        let holding = fields.per_joint("holding_w", dof, Accepts::NonNegative)?;
        origins.extend(fields.finish()?);
        Ok(holding.map_or_else(|| Standstill::none(dof), |holding_w| Standstill { holding_w }))
    }
}

//! The drive unit, the brakes, and what standing still costs.

use super::error::RobotError;
use super::fields::{Accepts, Fields};
use super::provenance::Origin;

/// Times of brakes \[s\].
const BRAKE_TIME: Accepts =
    Accepts::Between(0.0, 10.0, "0 or more and at most 10, in s (not milliseconds)");

/// What becomes of the negative mechanical power of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharing {
    /// It is lost at its own axis.
    None,
    /// The other axes use it over the common direct-current bus.
    Bus,
}

/// The drive unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Power of controller and drive with the motors on, without holding
    /// currents and brake coils \[W\].
    pub base_w: f64,
    /// Sharing between the axes.
    pub sharing: Sharing,
    /// Share of the negative power of the bus that is given back to the grid.
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

/// The holding brakes, all joints together.
#[derive(Clone, Debug, PartialEq)]
pub struct Brakes {
    /// Energy of one release \[J\].
    pub energy_per_release_j: f64,
    /// Time from the order to move until the brakes are open \[s\].
    pub release_s: f64,
    /// Time from the order to hold until the brakes are closed \[s\].
    pub engage_s: f64,
    /// Power of the coils that keep the brakes open \[W\].
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
        // What is not there has no origin, and is estimated (`prior`).
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

/// Power at standstill with open brakes that the model of the copper loss does
/// not contain.
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

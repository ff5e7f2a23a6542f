//! The cost that is minimised on a path: energy, or a substitute from the literature.

use super::path_energy::{EnergyModel, Sharing};
use crate::arm::robot::{self, Model};
use crate::retime::motion::stream::DOF;

/// The cost of a timing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cost {
    /// What the robot takes from the grid: work, copper losses, braking energy that is not used.
    #[default]
    Electrical,
    /// The same with all braking energy lost that no other joint uses.
    ElectricalWithoutRegeneration,
    /// ∫ Σ τ q̇ dt, as if braking gave everything back: Paes et al. (2014), before equation 9.
    Mechanical,
    /// ∫ Σ q̇² dt: Paes et al. (2014), what their cost is reduced to.
    Velocity,
    /// ∫ Σ τ² dt.
    Torque,
}

impl Cost {
    /// The cost on a robot. Base power is left out: the time is spent anyway.
    pub fn model(self, robot: &Model) -> EnergyModel {
        let motors = robot.motors.as_ref();
        let loss = std::array::from_fn(|j| motors.map_or(0.0, |m| m.loss_constant[j]));
        let sharing = match robot.drive.sharing {
            robot::Sharing::None => Sharing::PerJoint,
            robot::Sharing::Bus => Sharing::Bus,
        };
        let lossless =
            EnergyModel { regeneration: 1.0, ..EnergyModel::electrical([0.0; DOF], Sharing::Bus) };
        match self {
            Cost::Electrical => EnergyModel {
                regeneration: robot.drive.regeneration,
                ..EnergyModel::electrical(loss, sharing)
            },
            Cost::ElectricalWithoutRegeneration => EnergyModel::electrical(loss, sharing),
            Cost::Mechanical => lossless,
            Cost::Velocity => EnergyModel { work: 0.0, speed: 1.0, ..lossless },
            Cost::Torque => EnergyModel { work: 0.0, loss: [1.0; DOF], ..lossless },
        }
    }
}

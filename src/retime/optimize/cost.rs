//! The cost that is minimised on a path: energy or a substitute from the literature.

use super::path_energy::{EnergyModel, Sharing};
use crate::arm::robot::{self, Model};
use crate::retime::motion::stream::DOF;

/// The cost of a timing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cost {
    /// Energy from the grid: work, copper losses, braking energy that is not reused.
    #[default]
    Electrical,
    /// The same, but braking energy that no other joint uses is lost.
    ElectricalWithoutRegeneration,
    /// ∫ Σ τ q̇ dt, with full recovery of braking energy: Paes et al. (2014), before equation 9.
    Mechanical,
    /// ∫ Σ q̇² dt: the simplified cost of Paes et al. (2014).
    Velocity,
    /// ∫ Σ τ² dt.
    Torque,
}

impl Cost {
    /// The energy model of the cost on a robot. No base power: it depends on time only.
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

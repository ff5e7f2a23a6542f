//! The six parts of the energy.

use std::ops::{Add, AddAssign, Mul};

/// Energy by cause, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyParts {
    /// ∫ Σ `τ_rigid` q̇ dt: change of kinetic and potential energy.
    pub mechanical_j: f64,
    /// Work against friction.
    pub friction_j: f64,
    /// Copper loss in motion.
    pub copper_j: f64,
    /// Converter loss and braking energy that is not recovered.
    pub drive_j: f64,
    /// Base power, and holding power at rest.
    pub idle_j: f64,
    /// Brake coils, and release of brakes.
    pub brake_j: f64,
}

impl EnergyParts {
    /// Sum of all six parts.
    pub fn energy_j(&self) -> f64 {
        self.motion_energy_j() + self.idle_j + self.brake_j
    }

    /// Sum of the first four parts.
    pub fn motion_energy_j(&self) -> f64 {
        self.mechanical_j + self.friction_j + self.copper_j + self.drive_j
    }

    fn zip(self, other: EnergyParts, f: impl Fn(f64, f64) -> f64) -> EnergyParts {
        EnergyParts {
            mechanical_j: f(self.mechanical_j, other.mechanical_j),
            friction_j: f(self.friction_j, other.friction_j),
            copper_j: f(self.copper_j, other.copper_j),
            drive_j: f(self.drive_j, other.drive_j),
            idle_j: f(self.idle_j, other.idle_j),
            brake_j: f(self.brake_j, other.brake_j),
        }
    }
}

impl Add for EnergyParts {
    type Output = EnergyParts;
    fn add(self, other: EnergyParts) -> EnergyParts {
        self.zip(other, |a, b| a + b)
    }
}

impl AddAssign for EnergyParts {
    fn add_assign(&mut self, other: EnergyParts) {
        *self = *self + other;
    }
}

impl Mul<f64> for EnergyParts {
    type Output = EnergyParts;
    fn mul(self, factor: f64) -> EnergyParts {
        self.zip(self, |a, _| a * factor)
    }
}

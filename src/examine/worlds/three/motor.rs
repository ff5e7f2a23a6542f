//! A motor in electrical quantities, seen from behind its gear.
//!
//! Surface-magnet synchronous machine with field-oriented control: D. Schröder, Elektrische Antriebe.

use crate::arm::Arm;
use crate::rng::Rng;

/// A motor and its drive.
#[derive(Clone, Copy, Debug)]
pub struct Motor {
    /// Torque at the joint per current \[Nm/A\] of cold magnets, as the drive believes.
    pub constant: f64,
    /// Share of the torque constant that is lost with the heat of usual work.
    pub magnets: f64,
    /// Time constant of the winding \[s\].
    pub winding: f64,
    /// Current of usual work \[A\].
    pub usual: f64,
    /// Hysteresis torque of the iron \[Nm\].
    pub hysteresis: f64,
    /// Eddy current torque of the iron \[Nm s/rad\].
    pub eddy: f64,
}

impl Motor {
    /// Motor `i` of an arm.
    pub fn new(arm: &Arm, i: usize, rng: &mut Rng) -> Self {
        // Largest currents of robot drives: 3 A for wrists of small arms to 60 A for large ones.
        let largest = (2.0 + 0.25 * arm.torque[i].powf(0.65)) * rng.range(0.7, 1.4);
        let constant = arm.torque[i] / largest;
        Self {
            constant,
            magnets: rng.range(0.0, 0.006),
            winding: rng.log_range(60.0, 600.0),
            usual: arm.usual[i] / constant,
            hysteresis: arm.coulomb[i] * rng.range(0.0, 0.01),
            eddy: arm.viscous[i] * rng.range(0.0, 0.02),
        }
    }

    /// Phase current \[A\] (of the torque axis) for a torque \[Nm\] at a rate \[rad/s\]; `heat` is 1 in
    /// usual work.
    #[must_use]
    pub fn current(&self, torque: f64, rate: f64, heat: f64) -> f64 {
        let iron = self.hysteresis * (rate / 0.01).tanh() + self.eddy * rate;
        (torque + iron) / (self.constant * (1.0 - self.magnets * heat))
    }

    /// Heats the winding over a step \[s\].
    pub fn warm(&self, heat: &mut f64, current: f64, dt: f64) {
        let ratio = current / self.usual;
        *heat += (ratio * ratio - *heat) * dt / self.winding;
    }

    /// Torque \[Nm\] that the drive reports for a current.
    #[must_use]
    pub fn reported(&self, current: f64) -> f64 {
        self.constant * current
    }
}

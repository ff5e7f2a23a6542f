//! A motor in electrical quantities, seen from behind its gear.
//!
//! Surface-magnet synchronous machine with field-oriented control: D. Schröder, Elektrische Antriebe.

use super::arm::Arm;
use crate::examine::worlds::random::Rng;

/// A motor and its drive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motor {
    /// Torque at the joint per current \[Nm/A\] of cold magnets, as the drive believes.
    pub(super) constant: f64,
    /// Share of the torque constant that is lost with the heat of usual work.
    pub(super) magnets: f64,
    /// Time constant of the winding \[s\].
    pub(super) winding: f64,
    /// Current of usual work \[A\].
    pub(super) usual: f64,
    /// Hysteresis torque of the iron \[Nm\].
    pub(super) hysteresis: f64,
    /// Eddy current torque of the iron \[Nm s/rad\].
    pub(super) eddy: f64,
}

impl Motor {
    /// Motor `i` of an arm.
    pub(super) fn new(arm: &Arm, i: usize, rng: &mut Rng) -> Self {
        // Largest currents of robot drives: 3 A for wrists of small arms to 60 A for large ones.
        let largest = (2.0 + 0.25 * arm.torque[i].powf(0.65)) * rng.between(0.7, 1.4);
        let constant = arm.torque[i] / largest;
        Self {
            constant,
            magnets: rng.between(0.0, 0.006),
            winding: rng.log_between(60.0, 600.0),
            usual: arm.usual[i] / constant,
            hysteresis: arm.coulomb[i] * rng.between(0.0, 0.01),
            eddy: arm.viscous[i] * rng.between(0.0, 0.02),
        }
    }

    /// Phase current \[A\] (of the torque axis) for a torque \[Nm\] at a rate \[rad/s\]; `heat` is 1 in
    /// usual work.
    pub(super) fn current(&self, torque: f64, rate: f64, heat: f64) -> f64 {
        let iron = self.hysteresis * (rate / 0.01).tanh() + self.eddy * rate;
        (torque + iron) / (self.constant * (1.0 - self.magnets * heat))
    }

    /// Heats the winding over a step \[s\].
    pub(super) fn warm(&self, heat: &mut f64, current: f64, dt: f64) {
        let ratio = current / self.usual;
        *heat += (ratio * ratio - *heat) * dt / self.winding;
    }

    /// Torque \[Nm\] that the drive reports for a current.
    pub(super) fn reported(&self, current: f64) -> f64 {
        self.constant * current
    }
}

//! A periodic motion, sampled finely.

use super::mechanics::Joints;
use crate::arm::robot::MAX_DOF;

/// Sampling interval of the simulation \[s\].
pub(super) const STEP_S: f64 = 0.002;
/// Simulation samples per row of a log.
pub(super) const PER_ROW: usize = 5;

/// One period of a motion with a sample each [`STEP_S`]; the next period continues smoothly.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub(super) samples: Vec<Sample>,
}

/// Joint angles \[rad\] with rates and accelerations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) q: Joints,
    pub(super) qd: Joints,
    pub(super) qdd: Joints,
}

impl Sample {
    /// All joints at the angle 0, at rest.
    pub(super) const ZERO: Sample =
        Sample { q: [0.0; MAX_DOF], qd: [0.0; MAX_DOF], qdd: [0.0; MAX_DOF] };
}

impl Motion {
    /// Duration of the period \[s\].
    pub(super) fn period_s(&self) -> f64 {
        self.samples.len() as f64 * STEP_S
    }
}

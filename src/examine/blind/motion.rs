//! A periodic motion, sampled finely.

use super::mechanics::Joints;

/// Time between two samples of the simulation \[s\].
pub(super) const STEP_S: f64 = 0.002;
/// Samples of the simulation for one row of a log.
pub(super) const PER_ROW: usize = 5;

/// One period of a motion, a sample each [`STEP_S`]; the next period follows without a jump.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub(super) samples: Vec<Sample>,
}

/// Where the joints are \[rad\], with rates and accelerations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) q: Joints,
    pub(super) qd: Joints,
    pub(super) qdd: Joints,
}

impl Motion {
    /// Length of the period \[s\].
    pub(super) fn period_s(&self) -> f64 {
        self.samples.len() as f64 * STEP_S
    }
}

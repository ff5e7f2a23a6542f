//! The wait that a comparison adds to the original program.
//!
//! Where a retrofit may take longer than the original program, the robot of the original waits
//! for the rest of that time: it stands where its cycle ends, with base load, holding power and
//! open brakes. Without this wait the base load of the longer cycle would count for one side
//! only.

use super::simulated::{Simulated, TIME_TOLERANCE};
use crate::arm::robot::Model;
use crate::retime::energy::EnergyParts;
use crate::retime::energy::account::at_rest;

/// A wait at the end of the original cycle that the comparison adds, so that both sides take the
/// same time.
#[derive(Clone, Debug)]
pub struct Padding {
    /// s.
    pub duration_s: f64,
    /// What it costs: base load, holding and open brakes.
    pub energy: EnergyParts,
}

/// What the original waits more, so that it takes as long as the retrofit, `cycle_s`; `None` where
/// the retrofit takes no longer.
pub(super) fn padding(model: &Model, original: &Simulated, cycle_s: f64) -> Option<Padding> {
    let duration_s = cycle_s - original.simulation.cycle_s;
    if duration_s <= TIME_TOLERANCE {
        return None;
    }
    let (load, q) = original.end()?;
    Some(Padding { duration_s, energy: at_rest(model, load, q, duration_s) })
}

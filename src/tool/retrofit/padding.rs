//! The wait that the comparison adds to the original program.
//!
//! If a retrofit takes longer than the original, the original robot waits for the difference at the
//! end of its cycle, with base load, holding power and open brakes. Otherwise the base load of the
//! longer cycle would count for one side only.

use super::simulated::{Simulated, TIME_TOLERANCE};
use crate::arm::robot::Model;
use crate::retime::energy::EnergyParts;
use crate::retime::energy::account::at_rest;

/// An added wait at the end of the original cycle that makes both cycles equally long.
#[derive(Clone, Debug)]
pub struct Padding {
    /// s.
    pub duration_s: f64,
    /// Its energy: base load, holding and open brakes.
    pub energy: EnergyParts,
}

/// The padding up to `cycle_s`, the cycle time of the retrofit; `None` if that is not longer.
pub(super) fn padding(model: &Model, original: &Simulated, cycle_s: f64) -> Option<Padding> {
    let duration_s = cycle_s - original.simulation.cycle_s;
    if duration_s <= TIME_TOLERANCE {
        return None;
    }
    let (load, q) = original.end()?;
    Some(Padding { duration_s, energy: at_rest(model, load, q, duration_s) })
}

//! The wait that a comparison adds to the original program.
//!
//! Where a retrofit may take longer than the original program, the robot of the original waits
//! for the rest of that time: it stands where its cycle ends, with base load, holding power and
//! open brakes. Without this wait the base load of the longer cycle would count for one side
//! only.

use super::figures::{Figures, Padding};
use super::notes::end;
use super::work::TIME_TOLERANCE;
use crate::arm::robot::Model;
use crate::retime::energy::account::at_rest;
use crate::retime::motion::Simulation;

/// What the original waits more, so that it takes as long as the retrofit; `None` where the
/// retrofit takes no longer.
pub(super) fn padding(
    model: &Model,
    simulation: &Simulation,
    optimized: &Figures,
) -> Option<Padding> {
    let duration_s = optimized.cycle_s - simulation.cycle_s;
    if duration_s <= TIME_TOLERANCE {
        return None;
    }
    let (load, q) = end(simulation)?;
    Some(Padding { duration_s, energy: at_rest(model, load, q, duration_s) })
}

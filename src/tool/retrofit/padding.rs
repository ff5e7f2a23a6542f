//! The wait that the comparison adds to the original program.
//!
//! If a retrofit takes longer than the original, the original robot waits for the difference at the
//! end of its cycle, with base load, holding power and open brakes. Otherwise the base load of the
//! longer cycle would count for one side only. If the takt leaves a rest in an idle state, the padding is
//! the difference between the rests of both sides.

use super::simulated::{Simulated, TIME_TOLERANCE};
use super::whole_cycle::{Rest, WholeCycle};
use crate::arm::robot::Model;
use crate::retime::energy::EnergyParts;
use crate::retime::energy::account::at_rest;

/// An added wait at the end of the original cycle that makes both cycles equally long.
#[derive(Clone, Debug)]
pub struct Padding {
    /// s.
    pub duration_s: f64,
    /// Part of it in which the original stands longer than the retrofit, s.
    pub standing_s: f64,
    /// Its energy: base load, holding and open brakes, or that of idle states.
    pub energy: EnergyParts,
}

/// The padding up to `cycle_s`, the cycle time of the retrofit; `None` if that is not longer.
pub(super) fn padding(
    model: &Model,
    original: &Simulated,
    cycle_s: f64,
    whole: &WholeCycle,
) -> Option<Padding> {
    let duration_s = cycle_s - original.simulation.cycle_s;
    if duration_s <= TIME_TOLERANCE {
        return None;
    }
    let [before, after]: [&Rest; 2] = [&whole.original.rest, &whole.optimized.rest];
    if before.state.is_some() || after.state.is_some() {
        let idle_j = before.energy_j - after.energy_j;
        let standing_s = before.standing_s - after.standing_s;
        let energy = EnergyParts { idle_j, ..EnergyParts::default() };
        return Some(Padding { duration_s, standing_s, energy });
    }
    let (load, q) = original.end()?;
    let energy = at_rest(model, load, q, duration_s);
    Some(Padding { duration_s, standing_s: duration_s, energy })
}

//! The energy of one whole takt: the cycle, and the rest of the takt until the next one starts.

use super::cycle_time::{awaits_stated_input, base_w};
use super::settings::{Budget, Settings};
use super::simulated::Simulated;
use crate::arm::robot::Model;
use crate::retime::energy::power::holding_w;
use crate::retime::optimize::resting::{cheapest, ways};

/// Why a takt is as long as it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TaktBasis {
    /// The user states it.
    Given,
    /// The waits of the cycle end at stated times: the machine sets the cycle time.
    Waits,
    /// The cycle time of today.
    #[default]
    AsBefore,
}

/// The rest of a takt.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rest {
    /// s.
    pub time_s: f64,
    /// Part of it in which the robot stands and can move, s.
    pub standing_s: f64,
    /// Everything that the robot takes in it, J.
    pub energy_j: f64,
    /// Name of its idle state; `None`: the robot stands.
    pub state: Option<String>,
}

/// The energy of one takt by cause. Its parts add up to all of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TaktEnergy {
    /// The takt, or the cycle if that is longer, s.
    pub time_s: f64,
    /// The four parts of the motion, J.
    pub motion_j: f64,
    /// Holding the arm in waits and at stop points, J.
    pub standing_j: f64,
    /// Open brakes during the cycle, J.
    pub brake_j: f64,
    /// Base power during the cycle, J.
    pub base_j: f64,
    /// After the cycle.
    pub rest: Rest,
}

impl TaktEnergy {
    /// All energy of the takt, J.
    #[must_use]
    pub fn energy_j(&self) -> f64 {
        self.motion_j + self.standing_j + self.brake_j + self.base_j + self.rest.energy_j
    }
}

/// A time of the whole cycle with its energy.
#[derive(Clone, Debug, PartialEq)]
pub struct CyclePoint {
    /// s.
    pub time_s: f64,
    /// Least energy of the cycle and of the rest up to this time, J.
    pub energy_j: f64,
    /// Lower bound of that energy, J.
    pub lower_bound_j: f64,
    /// Idle state of the rest; `None`: the robot stands.
    pub state: Option<String>,
}

/// The whole cycle before and after.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WholeCycle {
    /// The takt, s.
    pub takt_s: f64,
    /// Why.
    pub basis: TaktBasis,
    /// The original.
    pub original: TaktEnergy,
    /// The retrofit.
    pub optimized: TaktEnergy,
    /// Energy over time; may be empty.
    pub curve: Vec<CyclePoint>,
}

/// The whole cycle before and after, without a curve.
pub(super) fn whole_cycle(
    model: &Model,
    settings: &Settings,
    before: &Simulated,
    after: &Simulated,
) -> WholeCycle {
    let [now_s, new_s] = [before, after].map(|cycle| cycle.simulation.cycle_s);
    let (takt_s, basis) = match settings.budget {
        Budget::Takt(takt) => (takt, TaktBasis::Given),
        Budget::Factor(_) => (now_s.max(new_s), TaktBasis::Given),
        Budget::AsBefore if awaits_stated_input(&before.simulation) => (now_s, TaktBasis::Waits),
        Budget::AsBefore => (now_s, TaktBasis::AsBefore),
    };
    let [original, optimized] =
        [before, after].map(|cycle| takt_energy(model, settings, cycle, takt_s));
    WholeCycle { takt_s, basis, original, optimized, curve: Vec::new() }
}

fn takt_energy(model: &Model, settings: &Settings, cycle: &Simulated, takt: f64) -> TaktEnergy {
    let (parts, cycle_s) = (&cycle.account.total, cycle.simulation.cycle_s);
    let base_j = model.drive.base_w * cycle_s;
    let time_s = (takt - cycle_s).max(0.0);
    let (way, energy_j) = cheapest(&ways(standing_w(model, cycle), &settings.idle, 0.0), time_s);
    let state = way.checked_sub(1).map(|index| &settings.idle[index]);
    TaktEnergy {
        time_s: takt.max(cycle_s),
        motion_j: parts.motion_energy_j(),
        standing_j: parts.idle_j - base_j,
        brake_j: parts.brake_j,
        base_j,
        rest: Rest {
            time_s,
            standing_s: state.map_or(time_s, |state| state.wake_s),
            energy_j,
            state: state.map(|state| state.name.clone()),
        },
    }
}

/// Power of standing at the end of the cycle with released brakes, W.
fn standing_w(model: &Model, cycle: &Simulated) -> f64 {
    let holding = cycle.end().map(|(load, q)| holding_w(model, load, q).iter().sum::<f64>());
    base_w(model) + holding.unwrap_or(0.0)
}

/// What to know about the takt: that the waits give it, and what the idle states are good for.
pub(super) fn notes(
    model: &Model,
    settings: &Settings,
    whole: &WholeCycle,
    before: &Simulated,
) -> Vec<String> {
    let mut notes = Vec::new();
    if whole.basis == TaktBasis::Waits {
        notes.push(format!(
            "the takt is {:.3} s, the cycle of today: the program waits for inputs whose times are \
             stated, so the machine sets it and slower travel uses up these waits",
            whole.takt_s
        ));
    }
    let standing_w = standing_w(model, before);
    let rest = &whole.optimized.rest;
    for state in &settings.idle {
        let fate = if state.power_w > standing_w {
            format!(
                "is never used: it takes {} W, and standing takes {standing_w:.1} W",
                state.power_w
            )
        } else if rest.state.as_ref() == Some(&state.name) {
            format!(
                "is used for the rest of the takt, {:.3} s: {:.1} J, and standing takes {:.1} J",
                rest.time_s,
                rest.energy_j,
                standing_w * rest.time_s
            )
        } else if rest.time_s < state.wake_s {
            format!(
                "is not used: it takes {} s to wake up, and the takt leaves {:.3} s",
                state.wake_s, rest.time_s
            )
        } else {
            let better = rest.state.as_deref().unwrap_or("standing");
            format!("is not used: in a rest of {:.3} s, {better} takes less", rest.time_s)
        };
        notes.push(format!("idle state '{}' {fate}", state.name));
    }
    notes
}

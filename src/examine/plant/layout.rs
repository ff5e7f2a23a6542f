//! A cell: its robot and its machines.

use std::collections::BTreeMap;

use super::cell::{Cell, Power};
use super::draw::{Machine, machines};
use super::law::Kind;
use super::random::Random;
use super::script::{Place, Script, Step};
use super::truth::Truth;

/// A cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Plant {
    /// What the robot takes beside its movements.
    pub power: Power,
    pub(super) cell: Cell,
    /// By signal.
    pub(super) machines: BTreeMap<String, Machine>,
}

impl Plant {
    /// A cell for a program.
    #[must_use]
    pub fn draw(seed: u64, script: &Script) -> Plant {
        Plant::draw_with(seed, script, &[])
    }

    /// A cell in which some signals come from machines of given kinds. A machine that nothing in the
    /// program can start becomes [`Kind::Answer`], a second takt becomes [`Kind::Queue`].
    #[must_use]
    pub fn draw_with(seed: u64, script: &Script, given: &[(&str, Kind)]) -> Plant {
        let (machines, nominal_s) = machines(seed, script, given);
        let mut draws = Random::of(seed, "cell", &[]);
        let power = Power {
            base_w: draws.between(120.0, 350.0),
            hold_w: draws.between(40.0, 250.0),
            brakes_after_s: draws.log_between(2.0, 30.0),
        };
        Plant { power, cell: Cell::drawn(nominal_s, &mut draws), machines }
    }

    /// The same cell without faults, breaks, and cycles with a lowered override.
    #[must_use]
    pub fn calm(mut self) -> Plant {
        self.cell.calm();
        self
    }

    /// What makes each wait of a program end.
    #[must_use]
    pub fn truth(&self, script: &Script) -> BTreeMap<Place, Truth> {
        let truth = |step: &Step| match step {
            Step::Wait { signal, .. } => {
                self.machines.get(signal).map(|machine| (step.place(), machine.truth()))
            }
            _ => None,
        };
        script.steps().filter_map(truth).collect()
    }
}

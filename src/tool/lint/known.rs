//! What simulations of programs that differ little have in common.

use std::sync::Arc;

use crate::arm::robot::Model;
use crate::retime::energy::plausible::Robots;
use crate::retime::energy::{Account, Energies};
use crate::retime::motion::{Options, Plans, Simulation};

/// What is known of a robot: the runs of earlier simulations and their energies, on which no result depends,
/// and the plausible robots.
#[derive(Clone)]
pub struct Known {
    plans: Arc<Plans>,
    energies: Arc<Energies>,
    robots: Arc<Option<Robots>>,
}

impl Known {
    /// Nothing is simulated yet.
    #[must_use]
    pub fn new(model: &Model) -> Known {
        Known {
            plans: Arc::new(Plans::new(model)),
            energies: Arc::new(Energies::new(model)),
            robots: Arc::new(Robots::new(model)),
        }
    }

    /// Options of a simulation that uses what is known.
    #[must_use]
    pub fn options(&self, options: &Options) -> Options {
        Options { plans: Some(self.plans.clone()), ..options.clone() }
    }

    /// The energies of a simulation.
    pub(super) fn account(&self, simulation: &Simulation) -> Account {
        self.energies.account(simulation)
    }

    /// The plausible robots; `None` if all parameters are known.
    pub(super) fn robots(&self) -> Option<&Robots> {
        self.robots.as_ref().as_ref()
    }

    /// Whether it belongs to a robot.
    pub(super) fn is_of(&self, model: &Model) -> bool {
        self.energies.is_of(model)
    }
}

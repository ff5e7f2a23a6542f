//! A program simulated on the virtual controller.

use crate::arm::dynamics::Load;
use crate::arm::robot::Model;
use crate::rapid::ir::program::{Program, RoutineId};
use crate::retime::energy::{Account, account};
use crate::retime::motion::timeline::What;
use crate::retime::motion::{Options, Simulation, simulate};
use crate::retime::path::joint_path::Joints;

/// Rounding of a time, s.
pub(super) const TIME_TOLERANCE: f64 = 1e-6;
/// Tolerance of a joint position after the rounding of emitted text, rad.
pub(super) const ENDPOINT_TOLERANCE: f64 = 1e-4;

/// One simulated cycle with its energy.
pub(in crate::tool) struct Simulated {
    pub(in crate::tool) simulation: Simulation,
    pub(in crate::tool) account: Account,
}

impl Simulated {
    pub(in crate::tool) fn new(
        program: &Program,
        entry: RoutineId,
        model: &Model,
        options: &Options,
    ) -> Simulated {
        Simulated::with_energy(model, simulate(program, entry, model, options))
    }

    /// A simulation with the energy of this robot.
    pub(super) fn with_energy(model: &Model, simulation: Simulation) -> Simulated {
        Simulated { account: account(model, &simulation), simulation }
    }

    /// Load and joint positions of the robot at the end of the cycle.
    pub(super) fn end(&self) -> Option<(&Load, &Joints)> {
        self.simulation.events.iter().rev().find_map(|event| match &event.what {
            What::Run(run) => Some((&run.load, &run.end)),
            What::Wait(wait) => Some((&wait.load, &wait.q)),
            What::Output(..) | What::Left(_) => None,
        })
    }
}

//! The virtual controller: executes a program and places its movements on a time line.

mod draft;
mod layout;
mod load;
mod machine;
mod options;
mod reach;
mod replay;
mod state;
mod target;
mod time_limit;

pub use options::Options;
pub use reach::unreached;
pub use replay::{Step, replay};

use state::VirtualController;

use super::controller::assumed;
use super::timeline::Simulation;
use crate::arm::robot::Model;
use crate::rapid::ir::exec::execute;
use crate::rapid::ir::program::{Program, RoutineId};

/// Runs a program on the virtual controller.
pub fn simulate(
    program: &Program,
    entry: RoutineId,
    model: &Model,
    options: &Options,
) -> Simulation {
    let mut machine = VirtualController::new(model, options);
    let execution = execute(program, entry, &mut machine);
    machine.flush();
    machine.lay_out();
    machine.note_limit();
    let about_limits = assumed(model).filter(|_| machine.moved);
    let mut simulation = machine.into_simulation();
    simulation.assumed = [execution.assumed, simulation.assumed].concat();
    simulation.assumed.extend(about_limits);
    simulation.unresolved = [execution.unresolved, simulation.unresolved].concat();
    simulation.unresolved.sort_by_key(|note| note.span);
    simulation
}

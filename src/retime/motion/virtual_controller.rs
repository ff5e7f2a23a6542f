//! The virtual controller: executes a program and places its movements on a time line.

mod draft;
mod layout;
mod load;
mod machine;
mod options;
mod replay;
mod state;
mod target;
mod time_limit;

pub use options::Options;
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
    machine.tell_length();
    let mut assumptions = execution.assumed;
    assumptions.append(&mut machine.assumed);
    assumptions.extend(assumed(model).filter(|_| machine.moved));
    let mut unresolved = execution.unresolved;
    unresolved.append(&mut machine.notes);
    unresolved.sort_by_key(|note| note.span);
    let count = machine.events.len();
    Simulation {
        events: machine.events,
        cycle_s: machine.time,
        repeats_from: machine.repeats_from.filter(|first| *first < count),
        unresolved,
        assumed: assumptions,
        inputs_asked: machine.asked,
    }
}

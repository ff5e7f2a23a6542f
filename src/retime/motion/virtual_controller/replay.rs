//! Lays given movements, waits and outputs on a time line: the effect of another zone, speed or order
//! of some of them, without executing the program.

use std::collections::BTreeMap;

use super::load::gripping;
use super::options::Options;
use super::state::VirtualController;
use crate::arm::robot::Model;
use crate::rapid::ir::exec::Machine;
use crate::rapid::ir::movement::{Movement, Output, Wait};
use crate::retime::motion::timeline::Simulation;
use crate::retime::path::joint_path::Joints;

/// Something that the robot did.
#[derive(Clone, Debug)]
pub enum Step {
    /// It moved.
    Move(Box<Movement>),
    /// It waited for as long as the wait states.
    Wait(Box<Wait>),
    /// An output was set: no rest at a stop point is added where one follows.
    Output(Box<Output>),
}

/// Lays steps on a time line from the joints at which the robot stands at first, rad, with what
/// the movement `before` had it carry. Inputs come at no time of their own: a wait without a
/// stated length takes none. With the rest that the last stop point adds where a movement follows
/// at once, s.
pub fn replay(
    model: &Model,
    options: &Options,
    start: Joints,
    before: Option<&Movement>,
    steps: Vec<Step>,
) -> (Simulation, f64) {
    let options = Options { start: Some(start), inputs: BTreeMap::new(), ..options.clone() };
    let mut machine = VirtualController::new(model, &options);
    machine.tool = before.map(gripping);
    for step in steps {
        match step {
            Step::Move(movement) => machine.moves(Ok(*movement)),
            Step::Wait(wait) => {
                machine.waits(*wait);
            }
            Step::Output(output) => machine.sets(*output),
        }
    }
    machine.flush();
    machine.lay_out();
    let simulation = Simulation {
        events: machine.events,
        cycle_s: machine.time,
        repeats_from: None,
        unresolved: machine.notes,
        assumed: machine.assumed,
        inputs_asked: machine.asked,
    };
    (simulation, machine.settling)
}

//! Places given movements, waits and outputs on a time line without executing the program, for
//! changed zones, speeds or order.

use std::collections::BTreeMap;

use super::load::gripping;
use super::options::Options;
use super::state::VirtualController;
use crate::arm::robot::Model;
use crate::rapid::ir::exec::Machine;
use crate::rapid::ir::movement::{Movement, Output, Wait};
use crate::retime::motion::timeline::Simulation;
use crate::retime::path::joint_path::Joints;

/// An action of the robot.
#[derive(Clone, Debug)]
pub enum Step {
    /// A movement.
    Move(Box<Movement>),
    /// A wait with its stated duration.
    Wait(Box<Wait>),
    /// An output; at a stop point before it no rest is added.
    Output(Box<Output>),
}

/// Places steps on a time line from the start position (rad) with the tool of the movement
/// `before`. Inputs have no times: a wait without a stated duration takes 0 s. Also returns the
/// rest that the last stop point adds if a movement follows directly, s.
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
            Step::Move(movement) => machine.on_movement(Ok(*movement)),
            Step::Wait(wait) => {
                machine.on_wait(*wait);
            }
            Step::Output(output) => machine.on_output(*output),
        }
    }
    machine.flush();
    machine.lay_out();
    let settling = machine.settling;
    (machine.into_simulation(), settling)
}

//! Values that do not depend on the statements executed before.

use super::executor::{Executor, Frame};
use super::machine::{Machine, WaitResult};
use crate::rapid::ir::hir::{Expr, ExprKind, Ident};
use crate::rapid::ir::movement::{Movement, Output, Unresolved, Wait};
use crate::rapid::ir::program::{DataId, Program};
use crate::rapid::ir::value::{Datum, Dependence, Value};

/// The value of an expression in the scope of a module. It is unknown, with the reason, if it
/// depends on a variable that the program writes, on an input or on the robot.
pub fn evaluate(program: &Program, module: usize, expr: &Expr) -> Value {
    let mut machine = NoMachine;
    let mut executor = Executor::new(program, &mut machine);
    executor.frames.push(Frame { module, ..Frame::default() });
    let mut value = executor.eval_level(expr);
    if let Some(reason) = value.origin.iter().find_map(changes)
        && value.datum.first_unknown().is_none()
    {
        value.datum = Datum::unknown(reason, expr.span);
    }
    value
}

/// The value of data at module level; see [`evaluate`].
pub fn value_of(program: &Program, id: DataId) -> Value {
    let name: Ident = program.data(id).name.clone();
    let span = name.span;
    evaluate(program, id.module, &Expr { kind: ExprKind::Ref(name), span })
}

/// The reason why this dependence can change a value during execution, if it can.
fn changes(dependence: &Dependence) -> Option<String> {
    match dependence {
        // Local data here are parameters of functions that the expression itself calls.
        Dependence::Persistent(_) | Dependence::TrustedPersistent(_) | Dependence::Local(_) => None,
        Dependence::Inner(name) | Dependence::Variable(name) => {
            Some(format!("'{name}' is written by the program"))
        }
        Dependence::Exposed(name, call) => {
            Some(format!("'{name}' may be written by '{call}', which is not in the files given"))
        }
        Dependence::Input(name) => Some(format!("'{name}' is not declared in the files given")),
        Dependence::RobotState => Some("it depends on where the robot is".to_owned()),
    }
}

/// A machine without effects and without a position.
struct NoMachine;

impl Machine for NoMachine {
    fn on_movement(&mut self, _: Result<Movement, Unresolved>) {}
    fn on_wait(&mut self, _: Wait) -> WaitResult {
        WaitResult::Ended
    }
    fn on_output(&mut self, _: Output) {}
}

#[cfg(test)]
mod tests;

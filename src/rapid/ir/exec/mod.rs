//! Execution of a program without its robot cell.
//!
//! The executor runs the statements, stores every value with its origin, and reports movements,
//! waits and outputs to a [`Machine`]. Inputs are 0 until the program has waited for them or the
//! user states them; an unknown condition counts as FALSE; an endless loop runs a limited number
//! of passes. Each such decision is recorded.

mod arguments;
mod branches;
mod call;
mod constant;
mod displacement;
mod eval;
mod executor;
mod external;
mod flow;
mod functions;
mod instruction;
mod loops;
mod machine;
mod modes;
mod motion;
mod operators;
mod polling;
mod references;
mod settings;
mod system;
#[cfg(test)]
mod tests;
mod waits;

pub use constant::{evaluate, value_of};
pub use executor::{Execution, Note};
pub use flow::NO_END;
pub use machine::{Machine, WaitResult};

use executor::Executor;
use flow::Flow;

use super::program::{Program, RoutineId};

/// Executes the routine `entry` on the machine.
pub fn execute(program: &Program, entry: RoutineId, machine: &mut dyn Machine) -> Execution {
    let mut executor = Executor::new(program, machine);
    executor.run(entry);
    executor.execution
}

impl Executor<'_> {
    fn run(&mut self, entry: RoutineId) {
        let program = self.program;
        for clash in &program.clashes {
            for span in &clash.spans {
                let name = &clash.name.text;
                let times = clash.spans.len();
                self.unresolved(
                    *span,
                    format!("'{name}' is declared {times} times: what uses it is left alone"),
                );
            }
        }
        match self.enter(entry, Vec::new(), Vec::new(), None) {
            Flow::Raised(raised) => {
                let error = raised.error.as_deref().unwrap_or("an error");
                let reason = format!("{error}, which no handler takes, ends the program here");
                self.unresolved(raised.at, reason);
            }
            Flow::Jump(label, _) => {
                self.unresolved(label.span, format!("no label '{}' in reach", label.text));
            }
            _ => {}
        }
    }
}

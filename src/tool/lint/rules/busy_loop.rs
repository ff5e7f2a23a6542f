//! A loop asks an input again and again without a pause.
//!
//! ## What it does
//! Finds `WHILE` loops whose condition reads an input or a flag and whose body does nothing that takes
//! time, and the same loops made of a label, an `IF` and a `GOTO`, in programs that move a robot.
//!
//! ## Why it wastes energy
//! The controller spends its time on the loop, so that other tasks, communication and the planning of
//! movements come later; neither a reader nor a tool sees that the robot stands here until an input
//! comes, so nobody travels slower or waits in a better pose for it.
//!
//! ## How the saving is computed
//! None is told: `simulate` takes such a loop for a wait that ends with its input.
//!
//! ## Example
//! ```text
//! WHILE diReady = 0 DO
//! ENDWHILE
//! ```
//!
//! ## Use instead
//! ```text
//! WaitDI diReady, 1;
//! ```
//!
//! ## Safety
//! Without a fix: the condition may ask for more than one input.
//!
//! ## Assumptions
//! A `PERS` flag that the loop does not write is written by another task.

use super::super::context::Context;
use super::super::flow::Class;
use super::super::rule::Finding;
use super::polling_wait::{PollingLoop, asks_outside, polling_loops};
use crate::rapid::ir::hir::{Expr, Stmt, StmtKind};
use crate::rapid::ir::program::RoutineId;

rule!("EW306", "busy-loop", Dwell, Text, Info, "busy_loop.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    if context.sites.is_empty() {
        return;
    }
    for PollingLoop { routine, stmt, condition, body } in polling_loops(context) {
        let input =
            asks_outside(condition) && !context.flow.data_names.has_only_data(routine, condition);
        let asks = input || reads_flag(context, routine, condition);
        if asks && takes_no_time(context, routine, body) {
            let message = "a loop asks without a pause: WaitDI or WaitUntil wait for it";
            findings.push(Finding::new(&RULE, stmt.span, message));
        }
    }
}

/// Whether an expression reads a flag of other tasks.
fn reads_flag(context: &Context<'_>, routine: RoutineId, expr: &Expr) -> bool {
    context.flow.data_names.is_flag(routine, expr)
        || expr.parts().into_iter().any(|part| reads_flag(context, routine, part))
}

/// Whether statements neither write data nor do anything that takes time.
fn takes_no_time(context: &Context<'_>, routine: RoutineId, body: &[Stmt]) -> bool {
    body.iter().all(|stmt| {
        matches!(stmt.kind, StmtKind::Call(_))
            && context.flow.class(routine, stmt) == Class::NoEffect
    })
}

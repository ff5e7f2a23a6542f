//! A loop asks an input again and again without a pause.
//!
//! ## What it does
//! Finds `WHILE` loops whose condition reads an input or a flag and whose body does nothing that takes
//! time (it may count, read a clock, or end when a time runs out), the same loops made of a label, an `IF`
//! and a `GOTO`, and `WHILE TRUE` loops that do something only where an input asks for it, in programs that
//! move a robot.
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
use super::super::statements::called_instruction;
use super::polling_wait::{PollingLoop, asks_outside, polling_loops};
use crate::rapid::builtins::{self, Effect, Source};
use crate::rapid::ir::hir::{Arg, Expr, ExprKind, Ident, Stmt, StmtKind};
use crate::rapid::ir::program::RoutineId;

rule!("EW306", "busy-loop", Dwell, Text, Info, "busy_loop.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    if context.sites.is_empty() {
        return;
    }
    for PollingLoop { routine, stmt, condition, body } in polling_loops(context) {
        let asks = |condition: &Expr| {
            asks_outside(condition) && !context.flow.data_names.has_only_data(routine, condition)
        };
        let is_input = asks(condition);
        let waits_for_it = is_input || reads_flag(context, routine, condition);
        let ends_loop = |name: &Ident| !is_input && mentions(condition, name);
        let takes_none = |stmt: &&Stmt| takes_no_time(context, routine, stmt, &ends_loop);
        if waits_for_it && body.iter().all(takes_none) {
            let message = "a loop asks without a pause: WaitDI or WaitUntil wait for it";
            findings.push(Finding::new(&RULE, stmt.span, message));
        } else if matches!(condition.kind, ExprKind::Bool(true))
            && body.iter().any(|stmt| is_question(stmt, &asks))
            && body.iter().all(|stmt| is_question(stmt, &asks) || takes_none(stmt))
        {
            let message = "an endless loop asks for inputs in turn without a pause: WaitUntil waits for \
                           any of them, and a WaitTime leaves time to other tasks";
            findings.push(Finding::new(&RULE, stmt.span, message));
        }
    }
}

/// Whether an expression reads a flag of other tasks.
fn reads_flag(context: &Context<'_>, routine: RoutineId, expr: &Expr) -> bool {
    context.flow.data_names.is_flag(routine, expr)
        || expr.parts().into_iter().any(|part| reads_flag(context, routine, part))
}

/// Whether an expression reads data.
fn mentions(expr: &Expr, name: &Ident) -> bool {
    matches!(&expr.kind, ExprKind::Ref(read) if read.key == name.key)
        || expr.parts().into_iter().any(|part| mentions(part, name))
}

/// Whether a statement does something only where inputs ask for it.
fn is_question(stmt: &Stmt, asks: &impl Fn(&Expr) -> bool) -> bool {
    match &stmt.kind {
        StmtKind::If { branches, otherwise } => {
            otherwise.as_ref().is_none_or(Vec::is_empty) && branches.iter().all(|(it, _)| asks(it))
        }
        _ => false,
    }
}

/// Whether a statement takes no time and writes nothing that ends the loop.
fn takes_no_time(
    context: &Context<'_>,
    routine: RoutineId,
    stmt: &Stmt,
    ends_loop: &impl Fn(&Ident) -> bool,
) -> bool {
    match &stmt.kind {
        StmtKind::Call(_) => context.flow.class(routine, stmt) == Class::NoEffect,
        StmtKind::Assign { target, value } => {
            is_calculated(value) && !target.base().is_some_and(ends_loop)
        }
        // As where a time runs out.
        StmtKind::If { branches, otherwise } => {
            let takes_none = |stmt: &Stmt| {
                matches!(stmt.kind, StmtKind::Goto(_))
                    || takes_no_time(context, routine, stmt, ends_loop)
            };
            let free = |body: &[Stmt]| leaves(body) || body.iter().all(takes_none);
            branches.iter().all(|(it, body)| is_calculated(it) && free(body))
                && otherwise.as_deref().is_none_or(free)
        }
        _ => false,
    }
}

/// Whether statements end the loop or stop the program: what they do before is no part of the loop.
fn leaves(body: &[Stmt]) -> bool {
    body.last().is_some_and(|last| match &last.kind {
        StmtKind::Return(_) | StmtKind::Raise(_) | StmtKind::Exit => true,
        _ => called_instruction(last)
            .is_some_and(|it| matches!(it.effect, Effect::Stop | Effect::ExitCycle)),
    })
}

/// Whether a value comes from data, clocks and calculations alone.
fn is_calculated(value: &Expr) -> bool {
    match &value.kind {
        ExprKind::Call(name, args) => {
            let source = builtins::function(&name.key).map(|function| function.source);
            matches!(source, Some(Source::Arguments | Source::State))
                && args.iter().filter_map(Arg::value).all(is_calculated)
        }
        _ => value.parts().into_iter().all(is_calculated),
    }
}

//! A loop asks an input again and again, with a `WaitTime` in it.
//!
//! ## What it does
//! Finds `WHILE` loops whose condition reads an input and whose body does nothing but `WaitTime`,
//! and the same loops made of a label, an `IF` and a `GOTO`.
//!
//! ## Why it wastes energy
//! The wait is cut into pieces: the robot goes on a poll late, and neither a reader nor a tool
//! sees that it stands here until an input comes, so nobody travels slower or waits in a better
//! pose for it.
//!
//! ## How the saving is computed
//! None is told: `simulate` takes such a loop for a wait that ends with its input, so that two
//! runs show no difference. On the controller the robot goes on up to one `WaitTime` late, each
//! time at the base load; how late is chance.
//!
//! ## Example
//! ```text
//! WHILE diReady = 0 DO
//!     WaitTime 0.5;
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
//! A name that nothing declares is an input.

use super::super::context::Context;
use super::super::flow::Class;
use super::super::rule::Finding;
use crate::rapid::ir::hir::{Block, Callee, Expr, Stmt, StmtKind};
use crate::rapid::ir::program::RoutineId;

rule!("EW303", "polling-wait", Dwell, Text, Info, "polling_wait.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (module, body) in context.program.modules.iter().enumerate() {
        for (index, routine) in body.routines.iter().enumerate() {
            for block in routine.blocks() {
                look(context, RoutineId { module, index }, block, findings);
            }
        }
    }
}

/// The depth of the recursion is limited by the parser.
fn look(context: &Context<'_>, routine: RoutineId, block: &Block, findings: &mut Vec<Finding>) {
    for (index, stmt) in block.iter().enumerate() {
        let polled = match &stmt.kind {
            StmtKind::While { condition, body } => Some((condition, body.as_slice())),
            StmtKind::If { branches, otherwise: None } => {
                jump_back(branches, index.checked_sub(1).map(|before| &block[before]))
            }
            _ => None,
        };
        if let Some((condition, body)) = polled
            && !context.quiet.expression(routine, condition)
            && only_waits(context, routine, body)
        {
            let message =
                "a loop polls with WaitTime: WaitDI or WaitUntil wait for the input itself";
            findings.push(Finding::new(&RULE, stmt.span, message));
        }
        for inner in stmt.kind.blocks() {
            look(context, routine, inner, findings);
        }
    }
}

/// The condition and the rest of the one branch of an `IF` that ends with a jump to the label
/// right before it.
fn jump_back<'h>(
    branches: &'h [(Expr, Block)],
    before: Option<&Stmt>,
) -> Option<(&'h Expr, &'h [Stmt])> {
    let [(condition, body)] = branches else { return None };
    let (StmtKind::Label(label), (last, rest)) = (&before?.kind, body.split_last()?) else {
        return None;
    };
    match &last.kind {
        StmtKind::Goto(to) if to.key == label.key => Some((condition, rest)),
        _ => None,
    }
}

fn only_waits(context: &Context<'_>, routine: RoutineId, body: &[Stmt]) -> bool {
    let mut waits = false;
    for stmt in body {
        let is_wait = match &stmt.kind {
            StmtKind::Call(call) => match &call.callee {
                Callee::Name(name) => name.key == "waittime",
                Callee::Late(_) => false,
            },
            _ => false,
        };
        if !is_wait && context.flow.class(routine, stmt) != Class::Quiet {
            return false;
        }
        // A counter or a jump may end the loop.
        if !is_wait && !matches!(stmt.kind, StmtKind::Call(_)) {
            return false;
        }
        waits |= is_wait;
    }
    waits
}

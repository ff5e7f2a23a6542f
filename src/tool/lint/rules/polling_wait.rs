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
use super::super::statements::called_name;
use crate::rapid::ir::hir::{Block, Expr, Routine, Stmt, StmtKind};
use crate::rapid::ir::program::RoutineId;

rule!("EW303", "polling-wait", Dwell, Text, Info, "polling_wait.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (routine, body) in context.program.routines() {
        for block in all_blocks(body) {
            for (index, stmt) in block.iter().enumerate() {
                let before = index.checked_sub(1).map(|before| &block[before]);
                let Some((condition, body)) = polling_loop(stmt, before) else { continue };
                if !context.flow.data_names.has_only_data(routine, condition)
                    && only_waits(context, routine, body)
                {
                    let message = "a loop polls with WaitTime: WaitDI or WaitUntil wait for the \
                                   input itself";
                    findings.push(Finding::new(&RULE, stmt.span, message));
                }
            }
        }
    }
}

/// The statement lists of a routine, those inside of statements too.
fn all_blocks(routine: &Routine) -> Vec<&Block> {
    let mut blocks: Vec<&Block> = routine.blocks().collect();
    let mut next = 0;
    while let Some(block) = blocks.get(next).copied() {
        blocks.extend(block.iter().flat_map(|stmt| stmt.kind.blocks()));
        next += 1;
    }
    blocks
}

/// The condition and the statements of a loop, also of one that is made with a jump.
fn polling_loop<'h>(stmt: &'h Stmt, before: Option<&'h Stmt>) -> Option<(&'h Expr, &'h [Stmt])> {
    match &stmt.kind {
        StmtKind::While { condition, body } => Some((condition, body.as_slice())),
        StmtKind::If { branches, otherwise: None } => jump_back(branches, before),
        _ => None,
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
    let is_wait = |stmt: &Stmt| called_name(stmt).is_some_and(|name| name.key == "waittime");
    // A counter or a jump may end the loop.
    let no_effect = |stmt: &Stmt| {
        matches!(stmt.kind, StmtKind::Call(_))
            && context.flow.class(routine, stmt) == Class::NoEffect
    };
    body.iter().any(is_wait) && body.iter().all(|stmt| is_wait(stmt) || no_effect(stmt))
}

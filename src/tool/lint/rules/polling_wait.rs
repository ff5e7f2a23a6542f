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
//! A name that nothing declares and that is compared with 0, 1, high or low is an input. Programs that
//! move no robot are left alone: a task that watches others has its flags.

use super::super::context::Context;
use super::super::flow::Class;
use super::super::rule::Finding;
use super::super::statements::called_name;
use crate::rapid::ir::hir::{Block, Expr, ExprKind, Routine, Stmt, StmtKind};
use crate::rapid::ir::program::RoutineId;

rule!("EW303", "polling-wait", Dwell, Text, Info, "polling_wait.rs");

/// Functions that read an input.
const READING: [&str; 4] = ["dinput", "testdi", "ginput", "ainput"];

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    if context.sites.is_empty() {
        return;
    }
    for PollingLoop { routine, stmt, condition, body } in polling_loops(context) {
        if asks_outside(condition)
            && !context.flow.data_names.has_only_data(routine, condition)
            && only_waits(context, routine, &body)
        {
            let message =
                "a loop polls with WaitTime: WaitDI or WaitUntil wait for the input itself";
            findings.push(Finding::new(&RULE, stmt.span, message));
        }
    }
}

/// A loop that may wait for something.
pub(super) struct PollingLoop<'h> {
    pub(super) routine: RoutineId,
    pub(super) stmt: &'h Stmt,
    pub(super) condition: &'h Expr,
    pub(super) body: Vec<&'h Stmt>,
}

/// The loops of a program, also those that are made with a jump.
pub(super) fn polling_loops<'h>(context: &Context<'h>) -> Vec<PollingLoop<'h>> {
    let mut loops = Vec::new();
    for (routine, all) in context.program.routines() {
        for block in all_blocks(all) {
            for (index, stmt) in block.iter().enumerate() {
                if let Some((condition, body)) = polling_loop(stmt, &block[..index]) {
                    loops.push(PollingLoop { routine, stmt, condition, body });
                }
            }
        }
    }
    loops
}

/// The statement lists of a routine, those inside of statements too.
pub(super) fn all_blocks(routine: &Routine) -> Vec<&Block> {
    let mut blocks: Vec<&Block> = routine.blocks().collect();
    let mut next = 0;
    while let Some(block) = blocks.get(next).copied() {
        blocks.extend(block.iter().flat_map(|stmt| stmt.kind.blocks()));
        next += 1;
    }
    blocks
}

/// The condition and the statements of a loop, also of one that is made with a jump.
fn polling_loop<'h>(stmt: &'h Stmt, before: &'h [Stmt]) -> Option<(&'h Expr, Vec<&'h Stmt>)> {
    match &stmt.kind {
        StmtKind::While { condition, body } => Some((condition, body.iter().collect())),
        StmtKind::If { branches, otherwise: None } => jump_back(branches, before),
        _ => None,
    }
}

/// The condition of the one branch of an `IF` that ends with a jump back, and all statements from the
/// label to the jump.
fn jump_back<'h>(
    branches: &'h [(Expr, Block)],
    before: &'h [Stmt],
) -> Option<(&'h Expr, Vec<&'h Stmt>)> {
    let [(condition, body)] = branches else { return None };
    let (last, rest) = body.split_last()?;
    let StmtKind::Goto(to) = &last.kind else { return None };
    let is_label =
        |stmt: &Stmt| matches!(&stmt.kind, StmtKind::Label(label) if label.key == to.key);
    let label = before.iter().rposition(is_label)?;
    Some((condition, before[label + 1..].iter().chain(rest).collect()))
}

/// Whether a condition has the form of a question for an input: a level of a signal, or a function that
/// reads one. What is true or false by itself is a flag.
pub(super) fn asks_outside(condition: &Expr) -> bool {
    match &condition.kind {
        ExprKind::Call(name, _) => READING.contains(&name.key.as_str()),
        ExprKind::Binary(_, left, right) => {
            let is_name = |side: &Expr| matches!(side.kind, ExprKind::Ref(_));
            let compares = |a: &Expr, b: &Expr| is_name(a) && is_level(b);
            compares(left, right)
                || compares(right, left)
                || asks_outside(left)
                || asks_outside(right)
        }
        _ => condition.parts().into_iter().any(asks_outside),
    }
}

fn is_level(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Num(level) => *level == 0.0 || *level == 1.0,
        ExprKind::Ref(name) => ["high", "low"].contains(&name.key.as_str()),
        _ => false,
    }
}

fn only_waits(context: &Context<'_>, routine: RoutineId, body: &[&Stmt]) -> bool {
    let is_wait = |stmt: &Stmt| called_name(stmt).is_some_and(|name| name.key == "waittime");
    // A counter or a jump may end the loop.
    let no_effect = |stmt: &Stmt| {
        matches!(stmt.kind, StmtKind::Call(_))
            && context.flow.class(routine, stmt) == Class::NoEffect
    };
    body.iter().any(|stmt| is_wait(stmt))
        && body.iter().all(|stmt| is_wait(stmt) || no_effect(stmt))
}

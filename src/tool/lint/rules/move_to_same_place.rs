//! A movement goes where the robot already is.
//!
//! ## What it does
//! Finds movements whose goal is, on every way through the program, the goal of the movement
//! before, with the same tool and work object.
//!
//! ## Why it wastes energy
//! It moves nothing, but the controller plans it, waits for its stop point, and ends what would
//! have been a corner.
//!
//! ## How the saving is computed
//! The cycle is laid on a time line without it. A movement without a path takes the virtual
//! controller no time: where nothing else changes, there is no finding.
//!
//! ## Example
//! ```text
//! MoveJ pHome, v1000, fine, tGrip;
//! MoveJ pHome, v1000, fine, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pHome, v1000, fine, tGrip;
//! ```
//!
//! ## Safety
//! Unsafe: somebody may start the program here by hand, with the robot elsewhere.
//!
//! ## Assumptions
//! Only what the program does moves the robot.

use super::super::context::Context;
use super::super::edits::{fix, remove};
use super::super::rule::{Applicability, Finding};
use super::super::saving::Weighed;
use crate::rapid::ir::hir::{Expr, ExprKind};
use crate::rapid::ir::program::Symbol;

rule!("EW401", "move-to-same-place", Path, Text, Info, "move_to_same_place.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        let before = context.before(index);
        if before.is_empty() || context.may_start(index) || !before.iter().all(|b| *b != index) {
            continue;
        }
        if !before.iter().all(|before| same_goal(context, *before, index)) {
            continue;
        }
        // After a fly-by point this movement makes the robot stop: that has a purpose.
        if site.is_stop() && before.iter().any(|before| !context.sites[*before].is_stop()) {
            continue;
        }
        let message = format!("{} goes where the robot already is", site.name);
        let mut finding = Finding::new(&RULE, site.stmt.span, message);
        for before in before {
            let there = context.sites[*before].stmt.span;
            finding.related.push((there, "it got there here".to_owned()));
        }
        if let Weighed::Saves(saving) = context.weigh(&[site.stmt.span], &|_| Vec::new()) {
            "leaving it out".clone_into(&mut finding.change);
            finding.saving = Some(saving);
        }
        finding.fix = remove(context, site).map(|edit| fix(Applicability::Unsafe, edit));
        findings.push(finding);
    }
}

/// Whether two plain movements go to the same place with the same tool and work object.
pub(super) fn same_goal(context: &Context<'_>, a: usize, b: usize) -> bool {
    let (a, b) = (&context.sites[a], &context.sites[b]);
    let (Some(goal), Some(other)) = (&a.facts.goal, &b.facts.goal) else { return false };
    a.is_plain()
        && b.is_plain()
        && goal.is_same(other)
        && a.tool_key().is_some()
        && a.tool_key() == b.tool_key()
        && a.wobj_key().is_some()
        && a.wobj_key() == b.wobj_key()
        && [a, b].iter().all(|site| is_steady(context, site.place.0.module, site.target))
}

/// Whether no name in a target stands for data that the program writes.
fn is_steady(context: &Context<'_>, module: usize, expr: &Expr) -> bool {
    let steady = |expr: &Expr| is_steady(context, module, expr);
    match &expr.kind {
        ExprKind::Ref(name) => match context.program.resolve(module, &name.key) {
            Some(Symbol::Data(id)) => !context.program.is_written(id),
            _ => true,
        },
        ExprKind::Field(base, _) => steady(base),
        ExprKind::Index(base, indices) => steady(base) && indices.iter().all(steady),
        ExprKind::Aggregate(items) => items.iter().all(steady),
        ExprKind::Unary(_, operand) => steady(operand),
        ExprKind::Binary(_, left, right) => steady(left) && steady(right),
        _ => true,
    }
}

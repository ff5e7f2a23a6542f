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
use super::super::edits::remove;
use super::super::rule::Finding;
use crate::rapid::ir::hir::{Expr, ExprKind};
use crate::rapid::ir::program::Symbol;

rule!("EW401", "move-to-same-place", Path, Text, Info, "move_to_same_place.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        let before = context.before(index);
        if before.is_empty() || context.is_unknown_before(index) || before.contains(&index) {
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
            finding = finding.with_related(context.sites[*before].stmt.span, "it got there here");
        }
        if let Ok(Some(saving)) = context.evaluate(&[site.stmt.span], &|_| Vec::new()) {
            finding = finding.with_saving("leaving it out", saving);
        }
        findings.push(finding.with_unsafe_fix(remove(context, site)));
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
    match &expr.kind {
        ExprKind::Ref(name) => match context.program.resolve(module, &name.key) {
            Some(Symbol::Data(id)) => !context.program.is_written(id),
            _ => true,
        },
        ExprKind::Call(..) => true,
        _ => expr.parts().into_iter().all(|part| is_steady(context, module, part)),
    }
}

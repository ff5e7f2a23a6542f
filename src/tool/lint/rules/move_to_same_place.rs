//! A movement goes where the robot already is.
//!
//! ## What it does
//! Finds movements whose goal is, on every way through the program, the goal of the movement
//! before, with the same tool and work object. Statements of a file that repeat the one before word for
//! word are one finding with their number: what wrote them is the cause.
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
//! Only what the program does moves the robot, unless it stops or asks the operator, who may then move
//! it by hand. Movements next to work (an output, a wait, another tool or load) are left alone.

use std::collections::BTreeMap;

use super::super::context::Context;
use super::super::edits::remove;
use super::super::rule::Finding;
use crate::rapid::ir::hir::{Arg, Expr, ExprKind};
use crate::rapid::ir::program::Symbol;
use crate::rapid::text::{Edit, FileId, Span};

/// Functions that give a place beside another one.
const SHIFTS: [&str; 2] = ["offs", "reltool"];

rule!("EW401", "move-to-same-place", Path, Text, Info, "move_to_same_place.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    // Statements that repeat the one before word for word have one cause: what wrote them.
    let mut repeated: BTreeMap<FileId, Vec<usize>> = BTreeMap::new();
    for (index, site) in context.sites.iter().enumerate() {
        let before = context.before(index);
        if before.is_empty() || context.is_unknown_before(index) || before.contains(&index) {
            continue;
        }
        if context.is_next_to_work(index)
            || !before.iter().all(|before| same_goal(context, *before, index))
        {
            continue;
        }
        // After a fly-by point this movement makes the robot stop: that has a purpose.
        if site.is_stop() && before.iter().any(|before| !context.sites[*before].is_stop()) {
            continue;
        }
        let text = |site: usize| words(context, context.sites[site].stmt.span);
        if before.iter().all(|before| text(*before) == text(index)) {
            repeated.entry(site.stmt.span.file).or_default().push(index);
        } else {
            findings.push(same_place(context, &[index]));
        }
    }
    findings.extend(repeated.into_values().map(|sites| same_place(context, &sites)));
}

/// A finding at the first of some movements, for all of them.
fn same_place(context: &Context<'_>, sites: &[usize]) -> Finding {
    let spans: Vec<Span> = sites.iter().map(|site| context.sites[*site].stmt.span).collect();
    let site = &context.sites[sites[0]];
    let (what, change) = match sites.len() {
        1 => (String::new(), "leaving it out".to_owned()),
        count => {
            let others = count - 1;
            let what = format!(", and so do {others} others that repeat the statement before");
            (what, format!("leaving out all {count}"))
        }
    };
    let message = format!("{} goes where the robot already is{what}", site.name);
    let mut finding = Finding::new(&RULE, spans[0], message).for_places(sites.len());
    for before in context.before(sites[0]) {
        finding = finding.with_related(context.sites[*before].stmt.span, "it got there here");
    }
    for span in spans.iter().skip(1) {
        finding = finding.with_related(*span, "and here");
    }
    if let Ok(Some(saving)) = context.evaluate(&spans, &|_| Vec::new()) {
        finding = finding.with_saving(change, saving);
    }
    let edits: Option<Vec<Edit>> =
        sites.iter().map(|site| remove(context, &context.sites[*site])).collect();
    finding.with_unsafe_fix(edits.unwrap_or_default())
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
        && (is_written_out(a.target) && is_written_out(b.target)
            || words(context, a.target.span) == words(context, b.target.span))
}

/// A text without regard to case and white space.
fn words(context: &Context<'_>, span: Span) -> String {
    context.text(span).to_lowercase().split_whitespace().collect()
}

/// Whether no function makes a target but those that shift the place: others may move external axes, too.
fn is_written_out(target: &Expr) -> bool {
    match &target.kind {
        ExprKind::Call(function, args) => {
            SHIFTS.contains(&function.key.as_str())
                && args.iter().filter_map(Arg::value).all(is_written_out)
        }
        _ => target.parts().into_iter().all(is_written_out),
    }
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

//! A movement can't be worked out from the program, and hides what it costs.
//!
//! ## What it does
//! Finds movements that run, but whose target, speed or zone is not in the files or not known.
//! Where many names are missing, only the first is reported. Positions that the program reads from
//! the robot (`CRobT`) are left alone: nobody can state them.
//!
//! ## Why it wastes energy
//! What can't be worked out is in no figure, and whatever it wastes is not found.
//!
//! ## How the saving is computed
//! There is none: the movement is in no simulated cycle.
//!
//! ## Example
//! ```text
//! MoveL pNotDeclared, v500, fine, tGrip;
//! ```
//!
//! ## Use instead
//! Give the module that declares the target, or state the value of the data that it depends on.
//!
//! ## Safety
//! Without a fix.
//!
//! ## Assumptions
//! Targets out of reach are not reported here: the robot may be a different one.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::trace::{Action, record};
use crate::rapid::builtins::MoveForm;
use crate::rapid::text::Span;

rule!("EW704", "unresolved-movement", Program, Text, Info, "unresolved_movement.rs");

/// End of the reason why a name says nothing.
const UNDECLARED: &str = "is not declared in the files given";
/// End of the reason why a place that the robot reads of itself is not known.
const DEPENDS_ON_POSITION: &str = "depends on where the robot is";
/// Names that may be missing without a whole module being it.
const MAX_SEPARATE: usize = 3;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let left = || context.trace.iter().any(|done| matches!(done.what, Action::Left(_)));
    let Some(entry) = context.entry.filter(|_| left()) else { return };
    // Movements that only this robot cannot make are resolved.
    let recording = record(context.program, entry);
    let trace = recording.trace();
    let resolved = trace.iter().filter_map(|done| done.what.movement());
    let resolved: BTreeSet<Span> = resolved.map(|movement| movement.span).collect();
    let mut reported: BTreeSet<&str> = BTreeSet::new();
    let mut missing: Vec<Finding> = Vec::new();
    for done in &context.trace {
        let Action::Left(span) = done.what else { continue };
        let Some(site) = context.site_of(span).map(|index| &context.sites[index]) else { continue };
        let facts = &site.facts;
        let open = facts.goal.is_none() || facts.speed.is_none() || facts.zone.is_none();
        if !open || resolved.contains(&span) || site.signature.form == MoveForm::ExternalJoint {
            continue;
        }
        let Some(note) = context.unresolved.iter().find(|note| note.span == span) else { continue };
        // One remark for one cause.
        if !note.reason.ends_with(DEPENDS_ON_POSITION) && reported.insert(&note.reason) {
            let message = format!("{} can't be worked out: {}", site.name, note.reason);
            let finding = Finding::new(&RULE, span, message);
            let list =
                if note.reason.ends_with(UNDECLARED) { &mut missing } else { &mut *findings };
            list.push(finding);
        }
    }
    if missing.len() > MAX_SEPARATE {
        // A missing module is one cause, too.
        let others = missing.split_off(1);
        let _ = write!(missing[0].message, " (and {} other names are not)", others.len());
        missing[0].related = others.into_iter().map(|it| (it.span, it.message)).collect();
    }
    findings.extend(missing);
}

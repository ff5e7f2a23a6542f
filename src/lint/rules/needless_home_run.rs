//! The robot goes home in the middle of the cycle, where nothing happens.
//!
//! ## What it does
//! Finds movements to the place at which the program starts, between two other movements, where
//! nothing is done at home: no wait, no output. Without a robot at least two of them in a cycle
//! are needed.
//!
//! ## Why it wastes energy
//! The way home and out again is longer than the way from one work to the next.
//!
//! ## How the saving is computed
//! The cycle is laid on a time line without it.
//!
//! ## Example
//! ```text
//! MoveJ pOverPick, v1000, z50, tGrip;
//! MoveAbsJ jHome, v1000, fine, tGrip;
//! MoveJ pOverPlace, v1000, z50, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pOverPick, v1000, z50, tGrip;
//! MoveJ pOverPlace, v1000, z50, tGrip;
//! ```
//!
//! ## Safety
//! Unsafe: home may be the only free way between both. Check that there is room.
//!
//! ## Assumptions
//! Home is where the first movement of the program goes, if that is a `MoveAbsJ`, or a pose at which
//! the program also ends and the robot stops.

use super::super::context::Context;
use super::super::edits::{fix, remove};
use super::super::finding::{Applicability, Finding};
use super::super::site::facts_of;
use super::super::trace::Deed;
use super::super::weigh::Weighed;
use crate::ir::instructions::MoveForm;

rule!("EW406", "needless-home-run", Path, Text, Info, "needless_home_run.rs");

/// Visits in a cycle that are too many whatever they cost.
const MANY: usize = 2;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let is_move = |step: usize| matches!(context.trace[step].what, Deed::Move(_));
    let moves: Vec<usize> = (0..context.trace.len()).filter(|step| is_move(*step)).collect();
    let Some(home) = moves.first().and_then(|step| goal(context, *step)) else { return };
    // A program that begins at a pose begins at home if it ends there too.
    let ends = moves.last().and_then(|step| goal(context, *step));
    if home.pose().is_some() && ends.is_none_or(|ends| !ends.is_same(&home)) {
        return;
    }
    // What is done before it goes home is done elsewhere.
    let idle = |step: usize| {
        let away = |step: usize| goal(context, step).is_none_or(|goal| !goal.is_same(&home));
        let before = context.trace[..step].iter().rposition(|done| moves_or_leaves(&done.what));
        goal(context, step).is_some_and(|goal| goal.is_same(&home))
            && before.is_some_and(|before| is_move(before) && away(before))
            && step + 1 < context.trace.len()
            && is_move(step + 1)
            && away(step + 1)
    };
    let visits = moves.iter().filter(|step| idle(**step)).count();
    for site in &context.sites {
        // A pose that is passed is a point on the way.
        let joint = match site.signature.form {
            MoveForm::AbsJ => true,
            MoveForm::Joint => site.is_stop(),
            _ => false,
        };
        let all = !site.executions.is_empty() && site.executions.iter().all(|step| idle(*step));
        if !joint || !all || !site.is_plain() {
            continue;
        }
        let weighed = context.weigh(&[site.stmt.span], &|_| Vec::new());
        let saving = match weighed {
            Weighed::Saves(saving) => Some(saving),
            Weighed::Unknown if visits >= MANY => None,
            _ => continue,
        };
        let message = format!("{} goes home on the way to other work, for nothing", site.name);
        let mut finding = Finding::new(&RULE, site.stmt.span, message);
        "leaving it out".clone_into(&mut finding.change);
        finding.saving = saving;
        finding.assumptions.push("the direct way is free".to_owned());
        finding.fix = remove(context, site).map(|edit| fix(Applicability::Unsafe, edit));
        findings.push(finding);
    }
}

fn moves_or_leaves(deed: &Deed<'_>) -> bool {
    matches!(deed, Deed::Move(_) | Deed::Left(_))
}

fn goal(context: &Context<'_>, step: usize) -> Option<super::super::site::Goal> {
    match &context.trace[step].what {
        Deed::Move(movement) => facts_of(movement).goal,
        _ => None,
    }
}

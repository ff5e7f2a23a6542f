//! The robot goes home in the middle of the cycle, where nothing happens.
//!
//! ## What it does
//! Finds movements to the place at which the program starts, between two other movements, where
//! nothing is done at home, no wait and no output, but something before it and something behind it.
//! Where a procedure that does nothing else goes home, each call of it is looked at by itself. Without
//! a robot at least two of them in a cycle are needed.
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
//! Without a fix: the way home may be the lift behind a grip, or the only free way between both.
//! Who leaves it out by hand checks that there is room.
//!
//! ## Assumptions
//! Home is where the first movement of the program goes, if that is a `MoveAbsJ`, or a pose at which
//! the program also ends and the robot stops.

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::saving::Weighed;
use super::super::site::{Site, facts_of};
use super::super::trace::Action;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::graph::Step as GraphStep;
use crate::rapid::ir::hir::{Callee, Stmt, StmtKind};
use crate::rapid::text::Span;
use crate::retime::motion::Step;

rule!("EW406", "needless-home-run", Path, Text, Info, "needless_home_run.rs");

/// Least number of visits in a cycle that are reported without a robot.
const MANY: usize = 2;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let is_move = |step: usize| matches!(context.trace[step].what, Action::Move(_));
    let moves: Vec<usize> = (0..context.trace.len()).filter(|step| is_move(*step)).collect();
    let Some(home) = moves.first().and_then(|step| goal(context, *step)) else { return };
    // A program that begins at a pose begins at home if it ends there too.
    let ends = moves.last().and_then(|step| goal(context, *step));
    if home.pose().is_some() && ends.is_none_or(|ends| !ends.is_same(&home)) {
        return;
    }
    // Nothing is done at home, and the movements before and after it lead elsewhere.
    let idle = |step: usize| {
        let away = |step: usize| goal(context, step).is_none_or(|goal| !goal.is_same(&home));
        let before = context.trace[..step].iter().rposition(|done| moves_or_leaves(&done.what));
        goal(context, step).is_some_and(|goal| goal.is_same(&home))
            && before.is_some_and(|before| is_move(before) && away(before))
            && step + 1 < context.trace.len()
            && is_move(step + 1)
            && away(step + 1)
    };
    // Without work between two visits home is only a point of a path.
    let is_home = |step: &usize| goal(context, *step).is_some_and(|goal| goal.is_same(&home));
    let is_work = |step: &usize| !moves_or_leaves(&context.trace[*step].what);
    let homes: Vec<usize> = moves.iter().copied().filter(is_home).collect();
    let at_work: Vec<usize> = (0..context.trace.len()).filter(is_work).collect();
    let works_between = |from: usize, to: usize| {
        let next = at_work.partition_point(|step| *step <= from);
        at_work.get(next).is_some_and(|step| *step < to)
    };
    let idle = |step: usize| {
        let visit = homes.partition_point(|home| *home < step);
        let before = visit.checked_sub(1).map_or(0, |before| homes[before]);
        let after = homes.get(visit + 1).copied().unwrap_or(context.trace.len());
        idle(step) && works_between(before, step) && works_between(step, after)
    };
    let visits = moves.iter().filter(|step| idle(**step)).count();
    for site in &context.sites {
        // A pose that is passed is a point on the way.
        let joint = match site.signature.form {
            MoveForm::AbsJ => true,
            MoveForm::Joint => site.is_stop(),
            _ => false,
        };
        if !joint || !site.is_plain() || site.executions.is_empty() {
            continue;
        }
        if site.executions.iter().all(|step| idle(*step)) {
            let weighed = context.weigh(&[site.stmt.span], &|_| Vec::new());
            findings.extend(told(site.stmt.span, site.name, weighed, visits));
        } else if does_nothing_else(context, site) {
            for call in idle_calls(context, site, &idle) {
                let weighed = context.weigh(&[site.stmt.span], &|step| without(step, call.name));
                findings.extend(told(call.stmt.span, call.text, weighed, visits));
            }
        }
    }
}

fn told(span: Span, name: &str, weighed: Weighed, visits: usize) -> Option<Finding> {
    let saving = match weighed {
        Weighed::Saves(saving) => Some(saving),
        Weighed::Unknown if visits >= MANY => None,
        _ => return None,
    };
    let message = format!("{name} goes home on the way to other work, for nothing");
    let mut finding = Finding::new(&RULE, span, message);
    "leaving it out".clone_into(&mut finding.change);
    finding.saving = saving;
    finding.assumptions.push("the direct way is free".to_owned());
    Some(finding)
}

/// A call of a routine.
struct CallSite<'c> {
    /// The statement.
    stmt: &'c Stmt,
    /// The routine's name there.
    name: Span,
    text: &'c str,
}

/// The calls of a movement's routine whose executions are all needless.
fn idle_calls<'c>(
    context: &Context<'c>,
    site: &Site<'_>,
    idle: &impl Fn(usize) -> bool,
) -> Vec<CallSite<'c>> {
    let called_at = |step: usize| match &context.trace[step].what {
        Action::Move(movement) => movement.called_at,
        _ => None,
    };
    let mut found = Vec::new();
    for place in context.flow.callers(site.place.0) {
        let Some(stmt) = context.flow.statement(*place) else { continue };
        let StmtKind::Call(call) = &stmt.kind else { continue };
        let Callee::Name(name) = &call.callee else { continue };
        let mut visits = site.executions.iter().filter(|step| called_at(**step) == Some(name.span));
        let some = visits.clone().next().is_some();
        if some && visits.all(|step| idle(*step)) {
            found.push(CallSite { stmt, name: name.span, text: &name.text });
        }
    }
    found
}

/// Whether all that the routine of a movement does is that movement.
fn does_nothing_else(context: &Context<'_>, site: &Site<'_>) -> bool {
    let (routine, _) = site.place;
    context.program.routine(routine).error.is_empty()
        && context.flow.graph(routine).nodes.iter().all(|node| match node.step {
            GraphStep::Statement(stmt) => {
                stmt.span == site.stmt.span || matches!(stmt.kind, StmtKind::Return(None))
            }
            GraphStep::Condition(_) | GraphStep::Test(_) | GraphStep::Count => false,
            GraphStep::Entry | GraphStep::Exit => true,
        })
}

/// The change that removes a movement, for the executions that belong to a call.
fn without(step: &Step, call: Span) -> Vec<Step> {
    match step {
        Step::Move(movement) if movement.called_at == Some(call) => Vec::new(),
        other => vec![other.clone()],
    }
}

fn moves_or_leaves(action: &Action<'_>) -> bool {
    matches!(action, Action::Move(_) | Action::Left(_))
}

fn goal(context: &Context<'_>, step: usize) -> Option<super::super::site::Goal> {
    match &context.trace[step].what {
        Action::Move(movement) => facts_of(movement).goal,
        _ => None,
    }
}

//! The robot goes home in the middle of the cycle, where nothing happens.
//!
//! ## What it does
//! Finds movements to the place at which the program starts, between two other movements, where
//! nothing is done at home, no wait and no output, but something before it and something behind it. Home
//! and the movement behind it are next to no work: where home is the lift behind a grip or the approach to
//! the next one, nothing is told.
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
//! MoveL pOverPick, v1000, z50, tGrip;
//! MoveAbsJ jHome, v1000, fine, tGrip;
//! MoveJ pOverPlace, v1000, z50, tGrip;
//! MoveL pPlace, v300, fine, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveL pOverPick, v1000, z50, tGrip;
//! MoveJ pOverPlace, v1000, z50, tGrip;
//! MoveL pPlace, v300, fine, tGrip;
//! ```
//!
//! ## Safety
//! Without a fix: the way home may be the lift behind a grip, or the only free way between both.
//! Who leaves it out by hand checks that there is room.
//!
//! ## Assumptions
//! Home is where the first movement of the program goes, if that is a `MoveAbsJ`, or a pose at which
//! the program also ends and the robot stops; joints and poses are compared. The confidence is low.

use super::super::context::Context;
use super::super::evaluate::POSITION_TOLERANCE;
use super::super::flow::{Next, Through};
use super::super::rule::Finding;
use super::super::saving::Evaluation;
use super::super::site::{Goal, Site, facts_of};
use super::super::statements::called_name;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::graph::Step as GraphStep;
use crate::rapid::ir::hir::{Ident, Stmt, StmtKind};
use crate::rapid::ir::movement::Movement;
use crate::rapid::text::Span;
use crate::retime::motion::Step;
use crate::retime::path::joint_path::{Joints, are_close};

rule!("EW406", "needless-home-run", Path, Text, Info, "needless_home_run.rs");

/// Least number of visits in a cycle that are reported without a robot.
const MIN_VISITS: usize = 2;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let is_move = |step: usize| context.trace[step].what.movement().is_some();
    let moves: Vec<usize> = (0..context.trace.len()).filter(|step| is_move(*step)).collect();
    let Some(home) = moves.first().and_then(|step| goal(context, *step)) else { return };
    // The same place may be written as joints and as a pose.
    let first = moves[0];
    let is_home = |step: usize| {
        goal(context, step).is_some_and(|goal| goal.is_same(&home))
            || joints(context, step)
                .zip(joints(context, first))
                .is_some_and(|(a, b)| are_close(&a, &b, POSITION_TOLERANCE))
    };
    // A program that begins at a pose begins at home if it ends there too.
    if home.pose().is_some() && !moves.last().is_some_and(|step| is_home(*step)) {
        return;
    }
    // Nothing is done at home, and the movements before and after it lead elsewhere.
    // Without it the way into or out of work stays: it is neither a lift nor an approach.
    let moves_at = |step: usize| step < context.trace.len() && is_move(step);
    let passes = |step: usize| {
        is_home(step)
            && step > 0
            && moves_at(step - 1)
            && !is_home(step - 1)
            && moves_at(step + 1)
            && !is_home(step + 1)
            && moves_at(step + 2)
    };
    // Without work between two visits home is only a point of a path.
    let homes: Vec<usize> = moves.iter().copied().filter(|step| is_home(*step)).collect();
    let is_work = |step: &usize| !context.trace[*step].what.moves();
    let at_work: Vec<usize> = (0..context.trace.len()).filter(is_work).collect();
    let works_between = |from: usize, to: usize| {
        let next = at_work.partition_point(|step| *step <= from);
        at_work.get(next).is_some_and(|step| *step < to)
    };
    let idle = |step: usize| {
        let visit = homes.partition_point(|home| *home < step);
        let before = visit.checked_sub(1).map_or(0, |before| homes[before]);
        let after = homes.get(visit + 1).copied().unwrap_or(context.trace.len());
        passes(step) && works_between(before, step) && works_between(step, after)
    };
    let visits = moves.iter().filter(|step| idle(**step)).count();
    for (index, site) in context.sites.iter().enumerate() {
        let joint = matches!(site.signature.form, MoveForm::AbsJ | MoveForm::Joint);
        if !joint || !site.is_plain() || site.executions.is_empty() {
            continue;
        }
        if site.executions.iter().all(|step| idle(*step)) && context.may_leave_out(index) {
            let saving = context.evaluate(&[site.stmt.span], &|_| Vec::new());
            findings.extend(needless(site.stmt.span, site.name, saving, visits));
        } else if does_nothing_else(context, site) {
            for (stmt, name) in idle_calls(context, site, &idle) {
                let saving = context.evaluate(&[site.stmt.span], &|step| without(step, name.span));
                findings.extend(needless(stmt.span, &name.text, saving, visits));
            }
        }
    }
}

fn needless(span: Span, name: &str, saving: Evaluation, visits: usize) -> Option<Finding> {
    let saving = saving.ok().filter(|saving| saving.is_some() || visits >= MIN_VISITS)?;
    let message = format!("{name} goes home on the way to other work, for nothing");
    let finding = Finding::new(&RULE, span, message)
        .with_saving("leaving it out", saving)
        .with_assumption("the direct way is free")
        .doubtful();
    Some(finding)
}

/// The calls of a movement's routine whose executions are all needless, with the name there.
fn idle_calls<'c>(
    context: &Context<'c>,
    site: &Site<'_>,
    idle: &impl Fn(usize) -> bool,
) -> Vec<(&'c Stmt, &'c Ident)> {
    let called_at = |step: usize| called_at(context.trace[step].what.movement()?);
    let calls = context.flow.callers(site.place.0).iter().filter_map(|place| {
        let stmt = context.flow.statement(*place)?;
        let name = called_name(stmt)?;
        let next = context.flow.following(*place, Through::NoEffect);
        if !next.iter().all(|next| matches!(next, Next::Move(_))) {
            return None;
        }
        let mut visits = site.executions.iter().filter(|step| called_at(**step) == Some(name.span));
        let some = visits.clone().next().is_some();
        (some && visits.all(|step| idle(*step))).then_some((stmt, name))
    });
    calls.collect()
}

/// The name of the routine of a movement where it is called.
fn called_at(movement: &Movement) -> Option<Span> {
    movement.call.as_ref().map(|call| call.name)
}

/// Whether all that the routine of a movement does is that movement.
fn does_nothing_else(context: &Context<'_>, site: &Site<'_>) -> bool {
    let (routine, _) = site.place;
    context.program.routine(routine).error.is_empty()
        && context.flow.graph(routine).nodes.iter().all(|node| match node.step {
            GraphStep::Statement(stmt) => {
                stmt.span == site.stmt.span || matches!(stmt.kind, StmtKind::Return(None))
            }
            GraphStep::Condition(_) | GraphStep::Test(_) | GraphStep::Count(_) => false,
            GraphStep::Entry | GraphStep::Exit => true,
        })
}

/// The change that removes a movement, for the executions that belong to a call.
fn without(step: &Step, call: Span) -> Vec<Step> {
    match step {
        Step::Move(movement) if called_at(movement) == Some(call) => Vec::new(),
        other => vec![other.clone()],
    }
}

/// The simulated joints at the end of a movement that stops.
fn joints(context: &Context<'_>, step: usize) -> Option<Joints> {
    let (_, record, leg) = context.record(step)?;
    record.movement.zone.fine.then_some(leg.end)
}

fn goal(context: &Context<'_>, step: usize) -> Option<Goal> {
    facts_of(context.trace[step].what.movement()?).goal
}

//! The robot goes far round over a point where nothing happens.
//!
//! ## What it does
//! Finds fly-by points of joint movements behind which the next joint movement leads back: the way over the
//! point takes the axes half as long again as the direct one, or more.
//!
//! ## Why it wastes energy
//! The axes accelerate, brake and turn round for a way that nobody needs.
//!
//! ## How the saving is computed
//! The cycle is laid on a time line without the movement to the point.
//!
//! ## Example
//! ```text
//! MoveJ pPickUp, v1000, z50, tGrip;
//! MoveJ pFarLeft, v1000, z50, tGrip;
//! MoveJ pPlaceUp, v1000, z50, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pPickUp, v1000, z50, tGrip;
//! MoveJ pPlaceUp, v1000, z50, tGrip;
//! ```
//!
//! ## Safety
//! Without a fix: the point may lead round something that no program shows. A point nearer to the direct
//! way saves a part of it.
//!
//! ## Assumptions
//! A robot that only passes a point has nothing to do there. Points above both ends of the way, or nearer to
//! the robot than both, lead round things and are left alone. So are points next to work or in a process, ways
//! below 500 mm/s, and loops that end where they begin (EW402, EW403). The confidence is low.

use std::iter::successors;

use super::super::context::Context;
use super::super::rule::Finding;
use super::move_to_same_place::same_goal;
use super::there_and_back::only_next;
use crate::arm::robot::Model;
use crate::rapid::builtins::MoveForm;
use crate::retime::path::joint_path::Joints;

rule!("EW407", "far-via-point", Path, Robot, Info, "far_via_point.rs");

/// Least time of the axes over the point, as a multiple of that of the direct way: a point half as far to the
/// side as the way is long has 1.4, which leads round things.
const MIN_DETOUR: f64 = 1.5;
/// Height, and distance to the axis of the robot, by which a point leads round things, m.
const CLEARANCE: f64 = 0.05;
/// Slower movements are taken for a process, m/s: as in EW402.
const MIN_SPEED: f64 = 0.5;
/// Movements to both sides among which a loop is looked for.
const MAX_POINTS: usize = 6;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let Some(model) = context.model else { return };
    findings.extend((0..context.sites.len()).filter_map(|site| detour(context, model, site)));
}

fn detour(context: &Context<'_>, model: &Model, via: usize) -> Option<Finding> {
    let next = only_next(context, via)?;
    let joint = |site: usize| {
        let site = &context.sites[site];
        let form = matches!(site.signature.form, MoveForm::Joint | MoveForm::AbsJ);
        form && site.is_plain() && site.facts.speed.is_some_and(|speed| speed.tcp >= MIN_SPEED)
    };
    let site = &context.sites[via];
    if !joint(via)
        || !joint(next)
        || site.is_stop()
        || site.executions.is_empty()
        || is_in_loop(context, via)
        || context.is_next_to_work(via)
        || context.is_in_process(via)
        || !context.has_process(&[via, next])
        || !site.executions.iter().all(|step| is_detour(context, model, *step))
    {
        return None;
    }
    let saving = context.evaluate(&[site.stmt.span], &|_| Vec::new()).ok()??;
    let message = format!("{} goes far round over a point where nothing happens", site.name);
    let finding = Finding::new(&RULE, site.stmt.span, message)
        .with_related(context.sites[next].stmt.span, "the next movement leads back")
        .with_saving("leaving it out", saving)
        .with_assumption("the direct way is free")
        .doubtful();
    Some(finding)
}

/// Whether a movement up to this one goes where one behind it goes.
fn is_in_loop(context: &Context<'_>, via: usize) -> bool {
    let previous = |site: &usize| match context.before(*site) {
        [before] if only_next(context, *before) == Some(*site) => Some(*before),
        _ => None,
    };
    let mut before = successors(Some(via), previous).take(MAX_POINTS);
    let behind = successors(Some(via), |site| only_next(context, *site)).skip(1).take(MAX_POINTS);
    let behind: Vec<usize> = behind.collect();
    before.any(|one| behind.iter().any(|other| same_goal(context, one, *other)))
}

/// Whether an execution and the movement behind it take the axes much longer than the direct way.
fn is_detour(context: &Context<'_>, model: &Model, step: usize) -> bool {
    let (Some((.., over)), Some((_, after))) = (context.record(step), context.neighbours(step))
    else {
        return false;
    };
    let Some((.., on)) = context.record(after) else { return false };
    let direct = axis_time(model, &over.start, &on.end);
    let round = axis_time(model, &over.start, &over.end) + axis_time(model, &over.end, &on.end);
    round >= MIN_DETOUR * direct && !leads_round(context, step, after)
}

/// Whether the point of an execution is above both ends of the way, or nearer to the robot; so if one of them
/// is unknown.
fn leads_round(context: &Context<'_>, step: usize, after: usize) -> bool {
    let place = |step: usize| {
        let at = context.pose(step)?.translation.vector;
        Some((at.z, at.x.hypot(at.y)))
    };
    let before = context.neighbours(step).and_then(|(before, _)| place(before));
    let (Some(from), Some(over), Some(on)) = (before, place(step), place(after)) else {
        return true;
    };
    over.0 > from.0.max(on.0) + CLEARANCE || over.1 < from.1.min(on.1) - CLEARANCE
}

/// The time that the slowest axis needs at its largest speed, s.
fn axis_time(model: &Model, from: &Joints, to: &Joints) -> f64 {
    let speeds = model.limits.velocity.iter().flatten();
    let times =
        from.iter().zip(to).zip(speeds).map(|((from, to), speed)| (to - from).abs() / speed);
    times.fold(0.0, f64::max)
}

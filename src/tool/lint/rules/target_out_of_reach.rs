//! A movement goes where the robot cannot get.
//!
//! ## What it does
//! Finds movements whose target the robot has no joint angles for, whatever the configuration, in
//! programs most of whose movements it can make; in procedures that start by themselves, too.
//!
//! ## Why it wastes energy
//! The robot stops there with an error, and stands with its drives on until somebody comes; no
//! figure counts the statements after it.
//!
//! ## How the saving is computed
//! There is none: a movement that cannot be made is in no simulated cycle.
//!
//! ## Example
//! ```text
//! MoveL Offs(pPick, 0, 0, 2000), v500, z10, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveL Offs(pPick, 0, 0, 200), v500, z10, tGrip;
//! ```
//!
//! ## Safety
//! Without a fix: the program does not say where it should go.
//!
//! ## Assumptions
//! Robot, tool and work object are those that `--robot` and the program name. Where more than one
//! movement in four cannot be made as it stands, the robot is taken for another one and nothing is
//! told.

use std::collections::{BTreeMap, BTreeSet};

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::runs::recording;
use super::super::trace::Action;
use crate::arm::kinematics::{IkError, ik_near, limits_ok};
use crate::arm::robot::Model;
use crate::rapid::ir::movement::{Movement, Target};
use crate::rapid::text::Span;

rule!("EW705", "target-out-of-reach", Program, Robot, Warning, "target_out_of_reach.rs");

/// Of so many movements one may be impossible, if the robot is the right one.
const MIN_MOVES_PER_FAILURE: usize = 4;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let Some(model) = context.model else { return };
    let mut moves: BTreeSet<Span> = BTreeSet::new();
    let mut left: BTreeSet<Span> = BTreeSet::new();
    for done in &context.trace {
        match done.what {
            Action::Move(movement) => moves.insert(movement.span),
            Action::Left(span) if context.site_of(span).is_some() => left.insert(span),
            _ => false,
        };
    }
    if left.is_empty() || left.len() * MIN_MOVES_PER_FAILURE > moves.union(&left).count() {
        return;
    }
    let recording = recording(context.program, context.entry);
    let mut reasons: BTreeMap<Span, Option<String>> = BTreeMap::new();
    for done in recording.trace() {
        let Some(movement) = done.what.movement() else { continue };
        let reason = reasons.entry(movement.span).or_default();
        if reason.is_none() {
            *reason = out_of_reach(model, movement);
        }
    }
    for (span, reason) in reasons {
        let Some(reason) = reason.filter(|_| left.contains(&span)) else { continue };
        let Some(index) = context.site_of(span) else { continue };
        let message = format!("{} cannot get where it goes: {reason}", context.sites[index].name);
        findings.push(Finding::new(&RULE, span, message));
    }
}

/// Why the robot cannot get to a movement's target, if it cannot.
fn out_of_reach(model: &Model, movement: &Movement) -> Option<String> {
    match &movement.target {
        Target::Joints(q) => limits_ok(model, q).err().map(|error| error.to_string()),
        Target::Pose(target) if movement.wobj.fixed && movement.tool.robhold => {
            let world = model.kinematics.base.inverse();
            let shift = movement.settings.displacement.unwrap_or_default();
            let pose = world * movement.wobj.frame * shift * target.pose;
            let flange = pose * movement.tool.frame.inverse();
            match ik_near(model, &flange, &[0.0; 6]).err()? {
                error @ (IkError::Unreachable { .. }
                | IkError::OutsideLimits(_)
                | IkError::NotFound { .. }) => Some(error.to_string()),
                _ => None,
            }
        }
        Target::Pose(_) => None,
    }
}

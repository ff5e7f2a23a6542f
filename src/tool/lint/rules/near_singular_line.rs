//! A line passes so near to a singularity that a wrist axis has to race.
//!
//! ## What it does
//! Finds lines on which axis 5 comes within 5° of zero, axis 4 or 6 turns by more than 90°, and the
//! axes set the pace, not the programmed speed.
//!
//! ## Why it wastes energy
//! Axes 4 and 6 turn against each other at their limit, the TCP has to slow down for them, and
//! the base load runs on.
//!
//! ## How the saving is computed
//! The movement is laid on a time line as it is and as a joint movement.
//!
//! ## Example
//! ```text
//! MoveL pAcross, v1000, fine, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pAcross, v1000, fine, tGrip;
//! ```
//!
//! ## Safety
//! Without a fix: a joint movement leaves the line. `SingArea \Wrist`, another orientation of the
//! tool or another place of the work may do.
//!
//! ## Assumptions
//! The robot has a spherical wrist. First movements are not judged: where they begin is assumed.

use super::super::context::Context;
use super::super::edits::as_joint;
use super::super::rule::Finding;
use crate::arm::kinematics::singularity;
use crate::rapid::builtins::MoveForm;

rule!("EW404", "near-singular-line", Path, Robot, Warning, "near_singular_line.rs");

/// Sine of the angle of axis 5 below which it is near zero: 5°.
const MAX_SINE: f64 = 0.0872;
/// Names of the paces that axes set.
const BY_AXES: [&str; 4] = ["joint-speed", "acceleration", "torque", "estimated"];
/// Turn of axis 4 or 6 that only a singularity asks for, rad.
const MIN_TURN: f64 = std::f64::consts::FRAC_PI_2;
/// Intervals between the samples of a movement.
const INTERVALS: usize = 40;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for site in &context.sites {
        let line = site.signature.form == MoveForm::Linear && site.is_plain();
        // Where the robot stands before its first movement is assumed.
        let first = site.executions.first().is_some_and(|step| is_first(context, *step));
        if !line || first || !site.executions.iter().any(|step| is_near(context, *step)) {
            continue;
        }
        let Ok(Some(saving)) = context.evaluate(&[site.stmt.span], &as_joint) else { continue };
        let message = format!("{} passes the singularity of the wrist", site.name);
        let change = format!("MoveJ in place of {}", site.name);
        findings.push(Finding::new(&RULE, site.stmt.span, message).with_saving(change, saving));
    }
}

fn is_first(context: &Context<'_>, step: usize) -> bool {
    context.trace[..step].iter().all(|done| done.what.movement().is_none())
}

fn is_near(context: &Context<'_>, step: usize) -> bool {
    let (Some((run, record, leg)), Some(model)) = (context.record(step), context.model) else {
        return false;
    };
    let wrist = |i: usize| {
        let t = record.t_start + record.duration * i as f64 / INTERVALS as f64;
        singularity(model, &run.at(t).q).map_or(1.0, |singularity| singularity.wrist)
    };
    let turns = [3, 5].iter().any(|axis| (leg.end[*axis] - leg.start[*axis]).abs() > MIN_TURN);
    let by_axes = BY_AXES.contains(&record.pace.name());
    by_axes && turns && (0..=INTERVALS).map(wrist).fold(1.0, f64::min) < MAX_SINE
}

//! A payload is set and never taken off again.
//!
//! ## What it does
//! Finds `GripLoad` with a load in programs that have no `GripLoad` without one.
//!
//! ## Why it wastes energy
//! From the first part on the controller takes the empty arm for a loaded one: it accelerates
//! less than it could, and every figure about energy is wrong.
//!
//! ## How the saving is computed
//! There is none: the program does not say where the part is released, so there is no second
//! program to simulate, and with a wrong payload no figure is right.
//!
//! ## Example
//! ```text
//! SetDO doGripClose, 1;
//! GripLoad loadPart;
//! MoveJ pPlace, v1000, fine, tGrip;
//! SetDO doGripClose, 0;
//! ```
//!
//! ## Use instead
//! ```text
//! SetDO doGripClose, 1;
//! GripLoad loadPart;
//! MoveJ pPlace, v1000, fine, tGrip;
//! SetDO doGripClose, 0;
//! GripLoad load0;
//! ```
//!
//! ## Safety
//! Without a fix: the process determines where the part is released.
//!
//! ## Assumptions
//! The program is complete: it has its entry. Where `tool0` is in use with several payloads of which none is
//! zero, the lightest is the empty gripper.

use super::super::context::Context;
use super::super::flow::Place;
use super::super::outputs::NO_LOAD;
use super::super::rule::Finding;
use super::super::site::parts;
use super::super::statements::first_argument;
use super::gripping_without_payload::may_run;
use crate::rapid::ir::hir::{Call, Stmt};
use crate::rapid::ir::program::RoutineId;

rule!("EW503", "payload-never-reset", Load, Text, Warning, "payload_never_reset.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    if context.entry.is_none() || context.flow.has_late_calls() {
        return;
    }
    let mut calls = context.calls("gripload");
    calls.retain(|(place, ..)| may_run(context, place.0));
    let mass = |(place, _, call): &(Place, &Stmt, &Call)| payload_kg(context, place.0, call);
    // A load that is not known may be none.
    let Some(masses) = calls.iter().map(mass).collect::<Option<Vec<f64>>>() else { return };
    if masses.is_empty()
        || masses.iter().any(|mass| *mass <= NO_LOAD)
        || has_gripper(context, &masses)
    {
        return;
    }
    let message = "a payload is set here, and no GripLoad load0 takes it off again";
    findings.push(Finding::new(&RULE, calls[0].1.span, message));
}

/// The mass that a `GripLoad` states, kg, if it is known.
pub(super) fn payload_kg(context: &Context<'_>, routine: RoutineId, call: &Call) -> Option<f64> {
    let load = context.constant(routine, first_argument(call)?)?;
    parts(&load)?.first()?.num()
}

/// Whether payloads have the gripper's mass in them: several, none of them zero, and `tool0` is in use.
pub(super) fn has_gripper(context: &Context<'_>, masses: &[f64]) -> bool {
    let is_bare = context.sites.iter().any(|site| site.tool_key() == Some("tool0"));
    is_bare
        && masses.iter().all(|mass| *mass > NO_LOAD)
        && masses.iter().any(|mass| *mass != masses[0])
}

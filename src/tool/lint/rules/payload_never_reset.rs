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
//! The program is complete: it has its entry.

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::site::parts;
use super::super::statements::first_argument;

rule!("EW503", "payload-never-reset", Load, Text, Warning, "payload_never_reset.rs");

/// Loads up to this are none, kg.
const MAX_EMPTY: f64 = 0.01;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    if context.entry.is_none() || context.flow.has_late_calls() {
        return;
    }
    let calls = context.calls("gripload");
    let masses = calls.iter().map(|(place, _, call)| {
        let load = context.constant(place.0, first_argument(call)?)?;
        parts(&load)?.first()?.num()
    });
    // A load that is not known may be none.
    let Some(masses) = masses.collect::<Option<Vec<f64>>>() else { return };
    if masses.is_empty() || masses.iter().any(|mass| *mass <= MAX_EMPTY) {
        return;
    }
    let message = "a payload is set here, and no GripLoad load0 takes it off again";
    findings.push(Finding::new(&RULE, calls[0].1.span, message));
}

//! Parts are carried with tool0: the gripper has no mass.
//!
//! ## What it does
//! Finds movements with `tool0` in programs that set a payload with `GripLoad`: something grips,
//! so the flange is not bare.
//!
//! ## Why it wastes energy
//! The mass of the gripper is in neither the tool nor the payload: torques and energy are higher
//! than the controller knows.
//!
//! ## How the saving is computed
//! There is none to tell: without the mass no figure is right.
//!
//! ## Example
//! ```text
//! GripLoad loadPart;
//! MoveJ pPlace, v1000, fine, tool0;
//! ```
//!
//! ## Use instead
//! ```text
//! GripLoad loadPart;
//! MoveJ pPlace, v1000, fine, tGrip;
//! ```
//!
//! ## Safety
//! Without a fix: targets have to be taught with the tool, or transformed.
//!
//! ## Assumptions
//! A payload is gripped by something that has a mass. Joint movements go where they say whatever
//! the tool is, but take its load: they count too.

use super::super::context::Context;
use super::super::rule::Finding;
use crate::rapid::ir::hir::ArgKind;
use crate::rapid::ir::value::Datum;

rule!("EW504", "tool0-while-gripping", Load, Text, Warning, "tool0_while_gripping.rs");

/// Loads up to this are none, kg.
const NONE: f64 = 0.01;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let grips = context.calls("gripload").iter().any(|(place, _, call)| {
        let Some(ArgKind::Positional(expr)) = call.args.first().map(|arg| &arg.kind) else {
            return false;
        };
        match context.constant(place.0, expr) {
            Some(Datum::List(parts)) => {
                parts.first().and_then(Datum::num).is_some_and(|mass| mass > NONE)
            }
            _ => false,
        }
    });
    let bare: Vec<_> = context
        .sites
        .iter()
        .filter(|site| site.tool_key() == Some("tool0") && site.reachable)
        .collect();
    let (true, Some(first)) = (grips, bare.first()) else { return };
    let count = match bare.len() {
        1 => String::new(),
        count => format!(" (and in {} other movements)", count - 1),
    };
    let message = format!(
        "parts are gripped, but {} moves with tool0{count}: the gripper's mass is in no figure",
        first.name
    );
    let span = first.tool.map_or(first.stmt.span, |tool| tool.span);
    findings.push(Finding::new(&RULE, span, message));
}

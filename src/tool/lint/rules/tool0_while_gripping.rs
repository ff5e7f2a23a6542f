//! Parts are carried with tool0: the gripper has no mass.
//!
//! ## What it does
//! Finds movements with `tool0` that the program runs while a payload of `GripLoad` is in force:
//! something grips, so the flange is not bare.
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
//! the tool is, but take its load: they count too. Movements without a part, as to a pose for
//! transport, are left alone.

use super::super::context::Context;
use super::super::rule::Finding;

rule!("EW504", "tool0-while-gripping", Load, Text, Warning, "tool0_while_gripping.rs");

/// Loads up to this are none, kg.
const NONE: f64 = 0.01;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let carries = |step: &usize| {
        let movement = context.trace[*step].what.movement();
        let load = movement.and_then(|movement| movement.settings.grip_load);
        load.is_some_and(|load| load.mass > NONE)
    };
    let bare = context.sites.iter().filter(|site| {
        site.tool_key() == Some("tool0") && site.reachable && site.executions.iter().any(carries)
    });
    let bare: Vec<_> = bare.collect();
    let Some(first) = bare.first() else { return };
    let count = match bare.len() {
        1 => String::new(),
        count => format!(" (and in {} other movements)", count - 1),
    };
    let message = format!(
        "a part is gripped, but {} moves with tool0{count}: the gripper's mass is in no figure",
        first.name
    );
    let span = first.tool.map_or(first.stmt.span, |tool| tool.span);
    findings.push(Finding::new(&RULE, span, message).for_places(bare.len()));
}

//! Parts are carried with tool0: the gripper has no mass.
//!
//! ## What it does
//! Finds movements with `tool0` that can follow a `GripLoad` with a mass before the next `GripLoad`:
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
//! transport, are left alone. Where there are several payloads and none of them is zero, they have the
//! gripper's mass in them.

use std::collections::BTreeSet;

use super::super::context::Context;
use super::super::flow::Place;
use super::super::outputs::NO_LOAD;
use super::super::rule::Finding;
use super::payload_never_reset::{has_gripper, payload_kg};

rule!("EW504", "tool0-while-gripping", Load, Text, Warning, "tool0_while_gripping.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let calls = context.calls("gripload");
    let masses: Vec<(Place, f64)> = calls
        .iter()
        .filter_map(|(place, _, call)| Some((*place, payload_kg(context, place.0, call)?)))
        .collect();
    if has_gripper(context, &masses.iter().map(|(_, mass)| *mass).collect::<Vec<f64>>()) {
        return;
    }
    let mut carrying = BTreeSet::new();
    for (place, _) in masses.into_iter().filter(|(_, mass)| *mass > NO_LOAD) {
        carrying.extend(context.flow.in_force(place, "gripload").movements);
    }
    let bare = context.sites.iter().filter(|site| {
        site.tool_key() == Some("tool0") && site.reachable && carrying.contains(&site.place)
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
    let finding = Finding::new(&RULE, span, message).for_places(bare.len());
    let others = bare.iter().skip(1);
    findings.push(others.fold(finding, |finding, site| {
        finding.with_related(site.tool.map_or(site.stmt.span, |tool| tool.span), "and here")
    }));
}

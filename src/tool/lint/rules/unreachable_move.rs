//! A movement can never run.
//!
//! ## What it does
//! Finds movements that no way through their routine leads to: behind `RETURN`, `EXIT`, `GOTO`,
//! `RAISE`, or a `WHILE TRUE` that nothing leaves.
//!
//! ## Why it wastes energy
//! It does not; but it looks as if the robot did it, and hides what it really does.
//!
//! ## How the saving is computed
//! There is none: what never runs changes no simulated cycle.
//!
//! ## Example
//! ```text
//! RETURN;
//! MoveJ pHome, v1000, fine, tGrip;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pHome, v1000, fine, tGrip;
//! RETURN;
//! ```
//!
//! ## Safety
//! Without a fix: it may be that it should run.
//!
//! ## Assumptions
//! Handlers can always be reached: every statement may raise an error.

use super::super::context::Context;
use super::super::rule::Finding;

rule!("EW701", "unreachable-move", Program, Text, Warning, "unreachable_move.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let mut last = None;
    for site in &context.sites {
        let dead = !site.reachable && !context.in_handler(site);
        // The first of several in a row is enough.
        if dead && last != Some(site.place.0) {
            let message = format!("this {} is unreachable", site.name);
            findings.push(Finding::new(&RULE, site.stmt.span, message));
        }
        last = dead.then_some(site.place.0);
    }
}

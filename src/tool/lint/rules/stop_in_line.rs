//! A movement stops although the next one goes on in the same line.
//!
//! ## What it does
//! Finds stop points between two lines in the same direction, with the same orientation and tool,
//! behind which nothing needs a robot that stands.
//!
//! ## Why it wastes energy
//! The arm is braked and accelerated anew on a way that it could pass without a change of speed.
//!
//! ## How the saving is computed
//! As of EW101: both movements are laid on a time line with `fine` and with a zone.
//!
//! ## Example
//! ```text
//! MoveL Offs(p, 0, 0, 200), v1000, fine, tGrip;
//! MoveL Offs(p, 0, 0, 100), v1000, fine, tGrip;
//! MoveL p, v1000, fine, tGrip;
//! WaitTime 1;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveL Offs(p, 0, 0, 200), v1000, fine, tGrip;
//! MoveL Offs(p, 0, 0, 100), v1000, z10, tGrip;
//! MoveL p, v1000, fine, tGrip;
//! WaitTime 1;
//! ```
//!
//! ## Safety
//! Without a fix: the stop may belong to a process, as where a hole is drilled in steps.
//! Somebody has to say that nothing needs it.
//!
//! ## Assumptions
//! Directions that differ by less than 0.3° are one line. Not looked at: movements next to work, and
//! those of a process (below 200 mm/s, or with an output on for lines alone) or directly before it.

use super::super::context::Context;
use super::super::edits::zone_within;
use super::super::rule::Finding;
use super::super::stops::{is_in_line, propose_zone, stops_for_movements};

rule!("EW102", "stop-in-line", Stops, Text, Warning, "stop_in_line.rs");

/// Share of the shorter way that a zone may take.
const SHARE: f64 = 0.3;
/// Largest zone that is proposed, m.
const MAX_ZONE: f64 = 0.075;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        if context.is_next_to_work(index) || context.is_process(index) {
            continue;
        }
        let Some(next) = stops_for_movements(context, index) else { continue };
        let Some(corner) = context.corner(index) else { continue };
        let is_before_process = next.iter().any(|next| context.is_process(*next));
        if is_before_process || !is_in_line(context, index, &next, &corner) {
            continue;
        }
        let Some(zone) = zone_within((SHARE * corner.room()).min(MAX_ZONE)) else { continue };
        let message = format!("{} stops in the middle of a line", site.name);
        findings.extend(propose_zone(context, &RULE, index, zone, message));
    }
}

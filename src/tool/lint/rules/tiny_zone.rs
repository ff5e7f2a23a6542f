//! A corner is passed with a zone far smaller than its room.
//!
//! ## What it does
//! Finds fast movements that pass a corner with a zone of at most 1 mm, or of a fiftieth of the
//! way to the next point, where another movement follows on every way and nothing between them
//! needs the point.
//!
//! ## Why it wastes energy
//! In so small a corner the robot has to slow down almost to a stop, and is accelerated anew.
//!
//! ## How the saving is computed
//! The run is laid on a time line with both zones.
//!
//! ## Example
//! ```text
//! MoveJ pOver, v2000, z1, tGrip;
//! MoveJ pBelow, v2000, fine, tGrip;
//! WaitTime 1;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pOver, v2000, z50, tGrip;
//! MoveJ pBelow, v2000, fine, tGrip;
//! WaitTime 1;
//! ```
//!
//! ## Safety
//! Unsafe: the corner is cut further. Check that there is room.
//!
//! ## Assumptions
//! Movements below 500 mm/s, corners between two lines and points at which the tool turns back
//! are left alone.

use super::super::context::Context;
use super::super::edits::{fix, replace, zone_within};
use super::super::flow::Through;
use super::super::rule::{Applicability, Finding};
use super::super::stops::with_zone;
use crate::rapid::ir::hir::RoutineKind;

rule!("EW103", "tiny-zone", Stops, Text, Info, "tiny_zone.rs");

/// Zones up to this are tiny, m.
const TINY: f64 = 0.001;
/// And so are zones of this share of the room.
const SHARE_OF_ROOM: f64 = 0.02;
/// Slower movements are left alone, m/s.
const FAST: f64 = 0.5;
/// A larger change of direction is a way back, rad.
const BACK: f64 = 2.36;
/// Least room, m.
const ROOM: f64 = 0.1;
/// Share of the room that is proposed, and the most, m.
const PROPOSED: (f64, f64) = (0.3, 0.075);

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        let (Some(zone), Some(speed), Some(argument)) =
            (site.facts.zone, site.facts.speed, site.zone)
        else {
            continue;
        };
        let trap = matches!(context.program.routine(site.place.0).kind, RoutineKind::Trap);
        if zone.fine || !site.is_plain() || !site.reachable || trap || speed.tcp < FAST {
            continue;
        }
        let Some(next) = context.next_moves(index, Through::Quiet) else { continue };
        let plain = |next: &usize| {
            let next = &context.sites[*next];
            next.is_plain() && next.tool_key() == site.tool_key()
        };
        let lines = site.is_linear() && next.iter().any(|next| context.sites[*next].is_linear());
        if lines || !next.iter().all(plain) {
            continue;
        }
        let Some(corner) = context.corner(index) else { continue };
        let tiny = zone.tcp <= TINY || zone.tcp <= SHARE_OF_ROOM * corner.room();
        if !tiny || corner.room() < ROOM || corner.turn > BACK {
            continue;
        }
        let Some(larger) = zone_within((PROPOSED.0 * corner.room()).min(PROPOSED.1)) else {
            continue;
        };
        let weighed = context.weigh(&[site.stmt.span], &|step| with_zone(step, larger));
        let Ok(saving) = weighed.saving() else { continue };
        let written = context.text(argument.span);
        let message = format!(
            "{written} makes {} slow down in a corner that has {:.0} mm of room",
            site.name,
            corner.room() * 1e3
        );
        let mut finding = Finding::new(&RULE, site.stmt.span, message);
        finding.change = format!("{} in place of {written}", larger.name);
        finding.saving = saving;
        finding.assumptions.push(format!("there is room to cut the corner ({})", larger.name));
        finding.fix = Some(fix(Applicability::Unsafe, replace(argument.span, larger.name)));
        findings.push(finding);
    }
}

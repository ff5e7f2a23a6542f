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
//! Movements below 500 mm/s, next to work or in a process, corners between two lines, points at which the
//! tool turns back and ways below 50 mm are left alone.

use super::super::context::Context;
use super::super::edits::zone_within;
use super::super::flow::Through;
use super::super::rule::Finding;
use super::super::stops::{are_plain, fix_zone, is_ordinary};

rule!("EW103", "tiny-zone", Stops, Text, Info, "tiny_zone.rs");

/// Zones up to this are tiny, m.
const TINY: f64 = 0.001;
/// And so are zones of this share of the room.
const TINY_SHARE: f64 = 0.02;
/// Slower movements are left alone, m/s.
const MIN_SPEED: f64 = 0.5;
/// A larger change of direction is a way back, rad.
const MAX_TURN: f64 = 2.36;
/// Least room, m.
const MIN_ROOM: f64 = 0.05;
/// Share of the room that is proposed.
const SHARE: f64 = 0.3;
/// Largest zone that is proposed, m.
const MAX_ZONE: f64 = 0.075;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let found = |index| larger_zone(context, index);
    findings.extend((0..context.sites.len()).filter_map(found));
}

fn larger_zone(context: &Context<'_>, index: usize) -> Option<Finding> {
    let site = &context.sites[index];
    let zone = site.facts.zone?;
    let touches_work = context.is_next_to_work(index) || context.is_in_process(index);
    if zone.fine || touches_work || !is_ordinary(context, site) {
        return None;
    }
    if site.facts.speed?.tcp < MIN_SPEED {
        return None;
    }
    let next = context.next_moves(index, Through::NoEffect)?;
    let lines = site.is_linear() && next.iter().any(|next| context.sites[*next].is_linear());
    if lines || !are_plain(context, site, &next) {
        return None;
    }
    let corner = context.corner(index)?;
    let tiny = zone.tcp <= TINY || zone.tcp <= TINY_SHARE * corner.room();
    if !tiny || corner.room() < MIN_ROOM || corner.turn > MAX_TURN {
        return None;
    }
    let larger = zone_within((SHARE * corner.room()).min(MAX_ZONE))?;
    let message = format!(
        "{} makes {} slow down in a corner that has {:.0} mm of room",
        context.text(site.zone?.span),
        site.name,
        corner.room() * 1e3
    );
    fix_zone(context, &RULE, index, larger, message)
}

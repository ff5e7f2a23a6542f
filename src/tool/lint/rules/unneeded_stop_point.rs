//! A movement stops although on every way another movement follows at once.
//!
//! ## What it does
//! Finds stop points (`fine`) of plain movements behind which, on every way through the program,
//! the next thing that concerns the robot is another plain movement with the same tool.
//!
//! ## Why it wastes energy
//! The arm is braked, its kinetic energy is lost in the drives, and it is accelerated anew; the
//! base load runs on for the time that braking, settling and starting take.
//!
//! ## How the saving is computed
//! The movements before and after the point are laid on a time line once with `fine` and once with
//! the largest predefined zone that has room; the difference in joules and seconds is told.
//!
//! ## Example
//! ```text
//! MoveJ pAbove, v1000, fine, tGrip;
//! MoveL pPick, v300, fine, tGrip;
//! WaitTime 0.2;
//! ```
//!
//! ## Use instead
//! ```text
//! MoveJ pAbove, v1000, z50, tGrip;
//! MoveL pPick, v300, fine, tGrip;
//! WaitTime 0.2;
//! ```
//!
//! ## Safety
//! Unsafe: the corner is cut, and data that are written behind the movement are written earlier.
//! Check that there is room.
//!
//! ## Assumptions
//! Not looked at: movements next to work (an output, a wait, another tool or load), movements of a
//! process (below 200 mm/s, or with an output on for lines alone), points at which the tool turns
//! back, points nearer than 20 mm to the next one, corners of contours (lines of less than 150 mm
//! across the tool's axis, next to an arc, or four and more in a row) and their ends (the tool goes
//! in, or comes out, next to a line across its axis), interrupt routines, first movements.

use std::collections::BTreeSet;

use super::super::context::{Context, Corner};
use super::super::edits::{NamedZone, zone_within};
use super::super::flow::Through;
use super::super::rule::Finding;
use super::super::stops::{fix_zone, is_in_line, stops_for_movements};
use crate::rapid::builtins::MoveForm;

rule!("EW101", "unneeded-stop-point", Stops, Text, Warning, "unneeded_stop_point.rs");

/// A larger change of direction is a way back, rad.
const MAX_TURN: f64 = 2.36;
/// Points nearer than this to the next one are left alone, m.
const MIN_ROOM: f64 = 0.02;
/// Longest way on a contour, m.
const MAX_CONTOUR_STEP: f64 = 0.15;
/// Share of a way across the tool's axis that lies along it.
const ACROSS: f64 = 0.3;
/// Lines in a row that are many: with a part the robot goes up, over and down.
const MANY_LINES: usize = 4;
/// Share of the shorter way that a zone may take.
const SHARE: f64 = 0.3;
/// Largest zone between two lines, m: their corner is meant to be near.
const MAX_ZONE_BETWEEN_LINES: f64 = 0.015;
/// Largest zone elsewhere, m.
const MAX_ZONE: f64 = 0.075;

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    for (index, site) in context.sites.iter().enumerate() {
        let Some(zone) = could_pass(context, index) else { continue };
        let message =
            format!("{} stops, but nothing behind it needs a robot that stands", site.name);
        findings.extend(fix_zone(context, &RULE, index, zone, message));
    }
}

/// The zone with which a stop point could be passed; `None` on a straight line, too: that is
/// EW102.
fn could_pass(context: &Context<'_>, index: usize) -> Option<NamedZone> {
    let site = &context.sites[index];
    let next = stops_for_movements(context, index)?;
    if context.is_next_to_work(index) || context.is_process(index) {
        return None;
    }
    let corner = context.corner(index)?;
    if corner.turn > MAX_TURN || corner.room() < MIN_ROOM {
        return None;
    }
    let line_behind = next.iter().any(|next| context.sites[*next].is_linear());
    // The ends of a contour that is drawn, cut or welded stay exact.
    if corner.goes_in && line_behind || corner.comes_out && site.is_linear() {
        return None;
    }
    let short = site.is_linear() && corner.room() < MAX_CONTOUR_STEP;
    if short && is_contour(context, index, &next, &corner) {
        return None;
    }
    let between_lines = site.is_linear() && line_behind;
    let most = if between_lines { MAX_ZONE_BETWEEN_LINES } else { MAX_ZONE };
    zone_within((SHARE * corner.room()).min(most))
        .filter(|_| !is_in_line(context, index, &next, &corner))
}

/// Whether a stop point lies on or ends a contour that the tool draws, cuts or glues: there is an
/// arc, the lines are across the tool's axis, or many in a row.
fn is_contour(context: &Context<'_>, index: usize, next: &[usize], corner: &Corner) -> bool {
    let is_arc = |site: &usize| context.sites[*site].signature.form == MoveForm::Circular;
    let across = corner.along < ACROSS && next.iter().any(|it| context.sites[*it].is_linear());
    if across || is_arc(&index) || next.iter().any(is_arc) || next.contains(&index) {
        return true;
    }
    let mut row = BTreeSet::from([index]);
    let mut open = vec![index];
    while let Some(site) = open.pop().filter(|_| row.len() < MANY_LINES) {
        let behind = context.next_moves(site, Through::NoEffect).unwrap_or_default();
        let before = context.before(site).iter().copied();
        let before = before.filter(|it| context.next_moves(*it, Through::NoEffect).is_some());
        for other in behind.into_iter().chain(before) {
            if context.sites[other].is_linear() && row.insert(other) {
                open.push(other);
            }
        }
    }
    row.len() >= MANY_LINES
}

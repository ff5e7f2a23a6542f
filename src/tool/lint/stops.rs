//! Conditions for unnecessary stop points, shared by several rules.

use super::context::{Context, Corner};
use super::edits::{NamedZone, replace, with_zone};
use super::flow::Through;
use super::rule::{Finding, Rule};
use super::site::Site;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::hir::RoutineKind;
use crate::retime::motion::Step;

/// Smaller differences of direction count as zero, rad.
const STRAIGHT: f64 = 0.005;
/// Smaller differences of orientation count as zero, rad.
const UNTURNED: f64 = 0.002;

/// Whether a movement and all its successors lie on one line.
pub(super) fn is_in_line(
    context: &Context<'_>,
    index: usize,
    next: &[usize],
    corner: &Corner,
) -> bool {
    let is_line = |site: &usize| context.sites[*site].signature.form == MoveForm::Linear;
    is_line(&index)
        && next.iter().all(is_line)
        && corner.turn < STRAIGHT
        && corner.turned < UNTURNED
        && corner.room() > 0.0
}

/// Whether a movement is reachable, has no further action, and is in no trap routine.
pub(super) fn is_ordinary(context: &Context<'_>, site: &Site<'_>) -> bool {
    let trap = matches!(context.program.routine(site.place.0).kind, RoutineKind::Trap);
    site.is_plain() && site.reachable && !trap
}

/// Whether the next movements only move, with the tool of this one.
pub(super) fn are_plain(context: &Context<'_>, site: &Site<'_>, next: &[usize]) -> bool {
    let mut next = next.iter().map(|next| &context.sites[*next]);
    next.all(|next| next.is_plain() && next.tool_key() == site.tool_key())
}

/// The movements that follow a stop point, if nothing there requires a stop.
pub(super) fn stops_for_movements(context: &Context<'_>, index: usize) -> Option<Vec<usize>> {
    let site = &context.sites[index];
    let routine = context.program.routine(site.place.0);
    let handlers = !routine.error.is_empty() || routine.undo.is_some();
    let first = site.executions.first().is_some_and(|step| context.neighbours(*step).is_none());
    if !site.is_stop()
        || !is_ordinary(context, site)
        || site.tool_key().is_none()
        || first
        || handlers && context.in_handler(site)
    {
        return None;
    }
    context.next_moves(index, Through::NoEffect).filter(|next| are_plain(context, site, next))
}

/// A finding that proposes a zone for a movement, with its saving; `None` if it saves nothing.
pub(super) fn propose_zone(
    context: &Context<'_>,
    rule: &'static Rule,
    index: usize,
    zone: NamedZone,
    message: String,
) -> Option<Finding> {
    let site = &context.sites[index];
    let written = context.text(site.zone?.span);
    let change = |step: &Step| with_zone(step, zone.zone);
    let saving = context.evaluate(&[site.stmt.span], &change).ok()?;
    let change = format!("{} in place of {written}", zone.name);
    Some(Finding::new(rule, site.stmt.span, message).with_saving(change, saving))
}

/// The same with the zone as a fix that the user must review.
pub(super) fn fix_zone(
    context: &Context<'_>,
    rule: &'static Rule,
    index: usize,
    zone: NamedZone,
    message: String,
) -> Option<Finding> {
    let finding = propose_zone(context, rule, index, zone, message)?;
    let edit = replace(context.sites[index].zone?.span, zone.name);
    let assumption = format!("there is room to cut the corner ({})", zone.name);
    Some(finding.with_assumption(assumption).with_unsafe_fix([edit]))
}

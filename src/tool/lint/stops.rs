//! Conditions for unnecessary stop points, shared by several rules.

use super::context::{Context, Corner};
use super::edits::NamedZone;
use super::flow::Through;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::hir::RoutineKind;
use crate::rapid::ir::movement::Movement;
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

/// The movements that follow a stop point, if nothing there requires a stop.
pub(super) fn stops_for_movements(context: &Context<'_>, index: usize) -> Option<Vec<usize>> {
    let site = &context.sites[index];
    let routine = context.program.routine(site.place.0);
    let handlers = !routine.error.is_empty() || routine.undo.is_some();
    let first = site.executions.first().is_some_and(|step| context.neighbours(*step).is_none());
    if !site.is_stop()
        || !site.is_plain()
        || !site.reachable
        || matches!(routine.kind, RoutineKind::Trap)
        || first
        || handlers && context.in_handler(site)
    {
        return None;
    }
    let next = context.next_moves(index, Through::Quiet)?;
    let fits = |other: &usize| {
        let other = &context.sites[*other];
        other.is_plain() && other.tool_key() == site.tool_key() && site.tool_key().is_some()
    };
    next.iter().all(fits).then_some(next)
}

/// A movement with another zone.
pub(super) fn with_zone(step: &Step, zone: NamedZone) -> Vec<Step> {
    match step {
        Step::Move(movement) => {
            let movement = Movement { zone: zone.zone, ..(**movement).clone() };
            vec![Step::Move(Box::new(movement))]
        }
        other => vec![other.clone()],
    }
}

//! Which procedures start a program besides its entry: those that somebody chooses in a menu, or that
//! another program calls.

use std::collections::{BTreeMap, BTreeSet};

use super::flow::Flow;
use super::statements::called_instruction;
use crate::rapid::builtins::Instruction;
use crate::rapid::ir::hir::RoutineKind;
use crate::rapid::ir::program::{Program, RoutineId};
use crate::rapid::text::Span;

/// The procedures with movements that nothing executed so far calls, and no other of them, without those
/// that were tried. Where the
/// entry is missing or moves nothing, each procedure may be one, otherwise those that the entry may
/// call: a menu calls the one that is chosen.
pub(super) fn further_entries(
    program: &Program,
    entry: Option<RoutineId>,
    executed: &BTreeSet<Span>,
    tried: &BTreeSet<RoutineId>,
) -> Vec<RoutineId> {
    let flow = Flow::new(program, entry);
    let all = || program.routines().map(|(id, _)| id).collect();
    let entry = entry.filter(|_| !executed.is_empty() && !flow.has_late_calls());
    let pool: BTreeSet<RoutineId> = entry.map_or_else(all, |entry| flow.running([entry]));
    let moves = movements(&flow);
    let is_new = |(id, reached): &(RoutineId, BTreeSet<RoutineId>)| {
        let routine = program.routine(*id);
        let mut own = moves.iter().filter(|(of, _)| reached.contains(of)).peekable();
        !tried.contains(id)
            && matches!(routine.kind, RoutineKind::Proc)
            && routine.params.iter().all(|param| param.optional)
            && own.peek().is_some()
            && own.all(|(_, span)| !executed.contains(span))
    };
    let reach = pool.into_iter().map(|id| (id, flow.running([id])));
    let new: BTreeMap<RoutineId, BTreeSet<RoutineId>> = reach.filter(is_new).collect();
    // Procedures that call each other are roots, too.
    let is_root = |id: &RoutineId| {
        let calls = |(other, reached): (&RoutineId, &BTreeSet<RoutineId>)| {
            reached.contains(id) && !new[id].contains(other)
        };
        !new.iter().any(calls)
    };
    new.keys().copied().filter(is_root).collect()
}

/// The movement statements that their routines reach.
fn movements(flow: &Flow<'_>) -> Vec<(RoutineId, Span)> {
    let all = flow.statements().filter(|(_, stmt, reachable)| {
        *reachable && called_instruction(stmt).is_some_and(Instruction::is_movement)
    });
    all.map(|((routine, _), stmt, _)| (routine, stmt.span)).collect()
}

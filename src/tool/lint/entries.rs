//! Which procedures start a program besides its entry: those that somebody chooses in a menu, or that
//! another program calls.

use std::collections::{BTreeMap, BTreeSet};

use super::flow::Flow;
use super::statements::called_instruction;
use crate::rapid::builtins::Instruction;
use crate::rapid::ir::hir::{Routine, RoutineKind};
use crate::rapid::ir::program::{Program, RoutineId};
use crate::rapid::text::Span;

/// The procedures that can start a program.
pub(super) struct Entries {
    /// The procedures that the entry may call in a cycle without errors and interrupts; `None` where that is not
    /// known.
    called: Option<BTreeSet<RoutineId>>,
    /// The procedures without required parameters, with the routines and the movements that they reach.
    starts: BTreeMap<RoutineId, (BTreeSet<RoutineId>, BTreeSet<Span>)>,
}

impl Entries {
    /// The procedures of a program with an entry, if known.
    pub(super) fn new(program: &Program, entry: Option<RoutineId>) -> Entries {
        let flow = Flow::new(program, entry);
        let moves = movements(&flow);
        let starts = program.routines().filter(|(_, routine)| can_start(routine)).map(|(id, _)| {
            let reached = flow.running([id]);
            let own = moves.iter().filter(|(of, _)| reached.contains(of));
            let own = own.map(|(_, span)| *span).collect();
            (id, (reached, own))
        });
        let called =
            entry.filter(|_| !flow.has_late_calls()).map(|entry| flow.running_normally(entry));
        Entries { called, starts: starts.collect() }
    }

    /// The procedures with movements that nothing executed so far calls, and no other of them, without
    /// those that were tried. Where the entry is missing or moves nothing, each procedure may be one,
    /// otherwise those that the entry may call: a menu calls the one that is chosen.
    pub(super) fn further(
        &self,
        executed: &BTreeSet<Span>,
        tried: &BTreeSet<RoutineId>,
    ) -> Vec<RoutineId> {
        let called = self.called.as_ref().filter(|_| !executed.is_empty());
        let is_new = |(id, (_, moves)): &(&RoutineId, &(BTreeSet<RoutineId>, BTreeSet<Span>))| {
            called.is_none_or(|called| called.contains(id))
                && !tried.contains(id)
                && !moves.is_empty()
                && moves.is_disjoint(executed)
        };
        let new: BTreeMap<&RoutineId, &BTreeSet<RoutineId>> =
            self.starts.iter().filter(is_new).map(|(id, (reached, _))| (id, reached)).collect();
        // Procedures that call each other are roots, too.
        let is_root = |id: &&RoutineId| {
            !new.iter().any(|(other, reached)| reached.contains(id) && !new[id].contains(other))
        };
        new.keys().copied().filter(is_root).copied().collect()
    }
}

/// Whether a routine can be called without arguments.
fn can_start(routine: &Routine) -> bool {
    matches!(routine.kind, RoutineKind::Proc) && routine.params.iter().all(|param| param.optional)
}

/// The movement statements that their routines reach.
fn movements(flow: &Flow<'_>) -> Vec<(RoutineId, Span)> {
    let all = flow.statements().filter(|(_, stmt, reachable)| {
        *reachable && called_instruction(stmt).is_some_and(Instruction::is_movement)
    });
    all.map(|((routine, _), stmt, _)| (routine, stmt.span)).collect()
}

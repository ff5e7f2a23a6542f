//! A procedure with movements is called by nothing.
//!
//! ## What it does
//! Finds procedures with movements that neither the program nor an interrupt calls, in modules
//! that the program uses, where every procedure that is called is among the files and none is
//! called by a text. What an operator starts is left alone: procedures without a parameter that
//! only go to joint positions, stop for somebody or ask somebody.
//!
//! ## Why it wastes energy
//! It does not by itself; but nobody knows what it costs when somebody starts it by hand, and
//! changes are made in it that have no effect.
//!
//! ## How the saving is computed
//! There is none: what never runs changes no simulated cycle.
//!
//! ## Example
//! ```text
//! PROC main()
//!     rWork;
//! ENDPROC
//! PROC rWorkOld()
//!     MoveJ pHome, v1000, fine, tGrip;
//! ENDPROC
//! ```
//!
//! ## Use instead
//! Take it out, or say with a comment that an operator starts it
//! (`! joulepath: ignore EW702 started by hand`).
//!
//! ## Safety
//! Without a fix: an operator may start it by hand.
//!
//! ## Assumptions
//! A module none of whose procedures the program uses is another program or a tool box. A program
//! that moves nothing by itself is started procedure by procedure.

use std::collections::BTreeSet;

use super::super::context::Context;
use super::super::rule::Finding;
use super::super::statements::called_instruction;
use crate::rapid::builtins::{Instruction, MoveForm};
use crate::rapid::ir::hir::{RoutineKind, Scope};
use crate::rapid::ir::program::RoutineId;

rule!("EW702", "dead-procedure", Program, Text, Info, "dead_procedure.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let Some(entry) = context.entry.filter(|_| !context.flow.has_late_calls()) else { return };
    let running = context.flow.running([entry]);
    let moving: BTreeSet<RoutineId> = context.sites.iter().map(|site| site.place.0).collect();
    if moving.is_disjoint(&running) {
        return;
    }
    let used: BTreeSet<usize> = running.iter().map(|id| id.module).collect();
    let open = calls_others(context);
    for id in moving.difference(&running).copied() {
        let routine = context.program.routine(id);
        let may_be_called = open && routine.scope != Scope::Local;
        if !matches!(routine.kind, RoutineKind::Proc)
            || !used.contains(&id.module)
            || may_be_called
            || !context.flow.callers(id).is_empty()
            || is_for_operators(context, id)
        {
            continue;
        }
        let message = format!("nothing calls {}, which moves the robot", routine.name.text);
        findings.push(Finding::new(&RULE, routine.name.span, message));
    }
}

/// Whether something outside of the files is called: it may call any routine.
pub(super) fn calls_others(context: &Context<'_>) -> bool {
    let mut statements = context.flow.statements();
    statements.any(|(place, stmt, _)| context.flow.loses_position(place.0, stmt))
}

/// Whether an operator can start a procedure, and has a reason to.
fn is_for_operators(context: &Context<'_>, id: RoutineId) -> bool {
    if context.program.routine(id).params.iter().any(|param| !param.optional) {
        return false;
    }
    let mut statements = context.flow.statements_of(id);
    let asks =
        statements.any(|stmt| called_instruction(stmt).is_some_and(Instruction::asks_operator));
    let mut own = context.sites.iter().filter(|site| site.place.0 == id);
    asks || own.all(|site| site.signature.form == MoveForm::AbsJ)
}

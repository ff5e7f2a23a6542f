//! A procedure with movements is called by nothing.
//!
//! ## What it does
//! Finds procedures with movements that neither the program nor an interrupt calls, in programs
//! that have their entry and call nothing by a text.
//!
//! ## Why it wastes energy
//! It does not by itself; but nobody knows what it costs when somebody starts it by hand, and
//! changes are made in it that have no effect.
//!
//! ## How the saving is computed
//! There is none: what never runs costs nothing in either of two simulated cycles.
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
//! Take it out, or say with a comment that an operator starts it.
//!
//! ## Safety
//! Without a fix: an operator may start it by hand.
//!
//! ## Assumptions
//! All modules of the task are among the files.

use std::collections::BTreeSet;

use super::super::context::Context;
use super::super::finding::Finding;
use crate::ir::graph::Step;
use crate::ir::hir::{RoutineKind, StmtKind};
use crate::ir::program::{RoutineId, Symbol};

rule!("EW702", "dead-procedure", Program, Text, Info, "dead_procedure.rs");

fn check(context: &Context<'_>, findings: &mut Vec<Finding>) {
    let Some(entry) = context.entry.filter(|_| !context.flow.has_late_calls()) else { return };
    let connected = connected(context);
    let moving: BTreeSet<RoutineId> = context.sites.iter().map(|site| site.place.0).collect();
    for id in moving {
        let routine = context.program.routine(id);
        if id == entry
            || !matches!(routine.kind, RoutineKind::Proc)
            || connected.contains(&id)
            || !context.flow.callers(id).is_empty()
        {
            continue;
        }
        let message = format!("nothing calls {}, which moves the robot", routine.name.text);
        findings.push(Finding::new(&RULE, routine.name.span, message));
    }
}

/// Routines that interrupts start.
fn connected(context: &Context<'_>) -> BTreeSet<RoutineId> {
    let mut found = BTreeSet::new();
    for (routine, graph, _) in context.flow.graphs() {
        for node in &graph.nodes {
            if let Step::Statement(stmt) = node.step
                && let StmtKind::Connect { trap, .. } = &stmt.kind
                && let Some(Symbol::Routine(id)) =
                    context.program.resolve(routine.module, &trap.key)
            {
                found.insert(id);
            }
        }
    }
    found
}

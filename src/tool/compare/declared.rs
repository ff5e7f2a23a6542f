//! The data that a routine declares, before and between its statements.

use crate::rapid::ir::hir::{Data, Routine, StmtKind};

/// All data of a routine, in the order of the text.
pub(super) fn data(routine: &Routine) -> impl Iterator<Item = &Data> {
    let between = routine.statements().filter_map(|stmt| match &stmt.kind {
        StmtKind::Data(data) => Some(data),
        _ => None,
    });
    routine.data.iter().chain(between)
}

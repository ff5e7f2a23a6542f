//! The statements of a routine, with those inside of others.

use crate::rapid::ir::hir::{Block, Call, Callee, Ident, Stmt, StmtKind};

/// The statements of a block and of the blocks in them, in the order of the text.
pub(super) fn statements(block: &Block) -> Vec<&Stmt> {
    let mut found = Vec::new();
    let mut open: Vec<&Stmt> = block.iter().rev().collect();
    while let Some(stmt) = open.pop() {
        found.push(stmt);
        open.extend(stmt.kind.blocks().into_iter().rev().flat_map(|inner| inner.iter().rev()));
    }
    found
}

/// The calls among them that name what they call.
pub(super) fn calls(block: &Block) -> impl Iterator<Item = (&Stmt, &Ident, &Call)> {
    statements(block).into_iter().filter_map(|stmt| match &stmt.kind {
        StmtKind::Call(call) => match &call.callee {
            Callee::Name(name) => Some((stmt, name, call)),
            Callee::Late(_) => None,
        },
        _ => None,
    })
}

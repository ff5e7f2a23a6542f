//! The statements of a routine, nested ones included.

use crate::rapid::ir::hir::{Block, Call, Callee, Ident, Stmt, StmtKind};

/// The statements of a block and of its nested blocks, in text order.
pub(super) fn statements(block: &Block) -> Vec<&Stmt> {
    let mut found = Vec::new();
    let mut open: Vec<&Stmt> = block.iter().rev().collect();
    while let Some(stmt) = open.pop() {
        found.push(stmt);
        open.extend(stmt.kind.blocks().into_iter().rev().flat_map(|inner| inner.iter().rev()));
    }
    found
}

/// The calls among them with a static callee name.
pub(super) fn calls(block: &Block) -> impl Iterator<Item = (&Stmt, &Ident, &Call)> {
    statements(block).into_iter().filter_map(|stmt| match &stmt.kind {
        StmtKind::Call(call) => match &call.callee {
            Callee::Name(name) => Some((stmt, name, call)),
            Callee::Late(_) => None,
        },
        _ => None,
    })
}

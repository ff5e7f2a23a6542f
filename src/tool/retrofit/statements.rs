//! The statements of a routine, nested ones included, and what they may write.

use crate::rapid::builtins::{Function, function};
use crate::rapid::ir::hir::{Arg, Block, Call, Callee, Expr, ExprKind, Ident, Stmt, StmtKind};

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

/// What a statement may write: its target, and arguments of calls. `may_write`: whether a procedure
/// of this name (lower case) may write its arguments.
pub(super) fn written_places(stmt: &Stmt, may_write: impl Fn(&str) -> bool) -> Vec<&Expr> {
    let mut places = places_written_by_functions(stmt.kind.exprs());
    match &stmt.kind {
        StmtKind::Assign { target, .. } => places.push(target),
        StmtKind::Call(call) => {
            let only_reads = matches!(&call.callee, Callee::Name(name) if !may_write(&name.key));
            places.extend(call.args.iter().filter_map(Arg::value).filter(|_| !only_reads));
        }
        _ => {}
    }
    places
}

/// The arguments that function calls within these expressions may write.
pub(super) fn places_written_by_functions(mut open: Vec<&Expr>) -> Vec<&Expr> {
    let mut places = Vec::new();
    while let Some(expr) = open.pop() {
        if let ExprKind::Call(name, args) = &expr.kind
            && !function(&name.key).is_some_and(Function::only_reads)
        {
            places.extend(args.iter().filter_map(Arg::value));
        }
        open.extend(expr.parts());
    }
    places
}

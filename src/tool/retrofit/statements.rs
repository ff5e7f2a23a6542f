//! The calls in a block, and what a statement may write.

use crate::rapid::builtins::{Function, function};
use crate::rapid::ir::hir::{Arg, Block, Call, Callee, Expr, Ident, Stmt, StmtKind};
use crate::rapid::ir::walk::statements;

/// The calls in a block with a static callee name, those of nested blocks too.
pub(super) fn calls(block: &Block) -> impl Iterator<Item = (&Stmt, &Ident, &Call)> {
    statements(block).filter_map(|stmt| match &stmt.kind {
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
pub(super) fn places_written_by_functions(exprs: Vec<&Expr>) -> Vec<&Expr> {
    let calls = exprs.into_iter().flat_map(Expr::calls);
    let writing = calls.filter(|(name, _)| !function(&name.key).is_some_and(Function::only_reads));
    writing.flat_map(|(_, args)| args.iter().filter_map(Arg::value)).collect()
}

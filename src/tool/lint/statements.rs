//! What a statement calls.

use crate::rapid::builtins::{self, Instruction};
use crate::rapid::ir::hir::{Call, Callee, Expr, Ident, Stmt, StmtKind};

/// The name of the routine or instruction that a statement calls.
pub(super) fn called_name(stmt: &Stmt) -> Option<&Ident> {
    match &stmt.kind {
        StmtKind::Call(Call { callee: Callee::Name(name), .. }) => Some(name),
        _ => None,
    }
}

/// The instruction that a statement calls.
pub(super) fn called_instruction(stmt: &Stmt) -> Option<&'static Instruction> {
    builtins::instruction(&called_name(stmt)?.key)
}

/// The first argument of a call, if it has no name.
pub(super) fn first_argument(call: &Call) -> Option<&Expr> {
    call.args.first()?.positional()
}

//! Routines, their statement lists, and the names that statements call.

use crate::rapid::builtins::{self, Instruction};
use crate::rapid::ir::hir::{ArgKind, Block, Call, Callee, Expr, Ident, Routine, Stmt, StmtKind};
use crate::rapid::ir::program::{Program, RoutineId};

/// The routines of a program, in order.
pub(super) fn routines(program: &Program) -> impl Iterator<Item = (RoutineId, &Routine)> {
    program.modules.iter().enumerate().flat_map(|(module, body)| {
        let routines = body.routines.iter().enumerate();
        routines.map(move |(index, routine)| (RoutineId { module, index }, routine))
    })
}

/// The statement lists of a routine, those inside of statements too.
pub(super) fn all_blocks(routine: &Routine) -> Vec<&Block> {
    let mut blocks: Vec<&Block> = routine.blocks().collect();
    let mut next = 0;
    while let Some(block) = blocks.get(next).copied() {
        blocks.extend(block.iter().flat_map(|stmt| stmt.kind.blocks()));
        next += 1;
    }
    blocks
}

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
    match &call.args.first()?.kind {
        ArgKind::Positional(expr) => Some(expr),
        _ => None,
    }
}

//! What other tasks of a controller may write: `PERS` data of one name are shared among tasks.

use std::collections::BTreeSet;

use crate::ir::hir::{ArgKind, Block, Callee, Expr, ExprKind, Routine, StmtKind};
use crate::ir::instructions::may_write;
use crate::ir::lower;
use crate::syntax;
use crate::text::SourceFile;

/// Lower-case names of the data to which statements of these files assign, or that they hand to
/// routines, which may do so.
pub fn written_in<'f>(files: impl Iterator<Item = &'f SourceFile>) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for file in files {
        let parse = syntax::parse(&file.bytes);
        let modules = lower(file.id, &parse, &file.bytes);
        let routines = modules.iter().flat_map(|module| &module.routines);
        for block in routines.flat_map(Routine::blocks) {
            of_block(block, &mut names);
        }
    }
    names
}

fn of_block(block: &Block, names: &mut BTreeSet<String>) {
    for stmt in block {
        match &stmt.kind {
            StmtKind::Assign { target, .. } => name_of(target, names),
            StmtKind::Call(call) => {
                let writes = match &call.callee {
                    Callee::Name(name) => may_write(&name.key),
                    Callee::Late(_) => true,
                };
                for arg in call.args.iter().filter(|_| writes) {
                    if let ArgKind::Positional(expr)
                    | ArgKind::Named(_, expr)
                    | ArgKind::Optional(_, Some(expr)) = &arg.kind
                    {
                        name_of(expr, names);
                    }
                }
            }
            _ => {}
        }
        for inner in stmt.kind.blocks() {
            of_block(inner, names);
        }
    }
}

/// The data that an expression is a place in.
fn name_of(target: &Expr, names: &mut BTreeSet<String>) {
    match &target.kind {
        ExprKind::Ref(name) => {
            names.insert(name.key.clone());
        }
        ExprKind::Field(base, _) | ExprKind::Index(base, _) => name_of(base, names),
        _ => {}
    }
}

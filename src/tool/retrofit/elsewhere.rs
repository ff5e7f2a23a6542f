//! `PERS` data that other tasks may write: tasks share `PERS` data of the same name.

use std::collections::BTreeSet;

use crate::rapid::builtins::{self, Function, Instruction, may_write};
use crate::rapid::ir::hir::{Arg, Block, Callee, DataKind, Expr, ExprKind, Routine, StmtKind};
use crate::rapid::ir::lower;
use crate::rapid::syntax;
use crate::rapid::text::SourceFile;

/// Lower-case names of the data that these files assign or pass to routines that may write them.
pub fn written_in<'f>(files: impl Iterator<Item = &'f SourceFile>) -> BTreeSet<String> {
    let mut written = Written::default();
    for file in files {
        let parse = syntax::parse(&file.bytes);
        for module in lower(file.id, &parse, &file.bytes) {
            let shared = module.data.iter().filter(|data| data.kind == DataKind::Pers);
            written.shared.extend(shared.map(|data| data.name.key.clone()));
            for block in module.routines.iter().flat_map(Routine::blocks) {
                written.block(block);
            }
        }
    }
    if written.by_name {
        written.names.append(&mut written.shared);
    }
    written.names
}

#[derive(Default)]
struct Written {
    names: BTreeSet<String>,
    /// `PERS` data of the files.
    shared: BTreeSet<String>,
    /// Whether data are written by computed name: any of `shared` may change.
    by_name: bool,
}

impl Written {
    fn block(&mut self, block: &Block) {
        for stmt in block {
            match &stmt.kind {
                StmtKind::Assign { target, .. } => self.place(target),
                StmtKind::Call(call) => {
                    let writes = match &call.callee {
                        Callee::Name(name) => {
                            self.by_name |= builtins::instruction(&name.key)
                                .is_some_and(Instruction::finds_by_name);
                            may_write(&name.key)
                        }
                        Callee::Late(_) => true,
                    };
                    if writes {
                        self.places(&call.args);
                    }
                }
                _ => {}
            }
            for expr in stmt.kind.exprs() {
                self.expr(expr);
            }
            for inner in stmt.kind.blocks() {
                self.block(inner);
            }
        }
    }

    fn expr(&mut self, expr: &Expr) {
        if let ExprKind::Call(name, args) = &expr.kind
            && !builtins::function(&name.key).is_some_and(Function::only_reads)
        {
            self.places(args);
        }
        for part in expr.parts() {
            self.expr(part);
        }
    }

    fn places(&mut self, args: &[Arg]) {
        for expr in args.iter().filter_map(Arg::value) {
            self.place(expr);
        }
    }

    /// Adds the data object that contains the place.
    fn place(&mut self, expr: &Expr) {
        self.names.extend(expr.base().map(|name| name.key.clone()));
    }
}

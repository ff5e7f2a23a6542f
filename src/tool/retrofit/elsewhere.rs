//! `PERS` data that other tasks may read or write: tasks share `PERS` data of the same name.

use std::collections::BTreeSet;

use super::statements::{calls, written_places};
use crate::rapid::builtins::{Instruction, instruction, may_write};
use crate::rapid::ir::hir::{DataKind, Expr, Ident, Routine};
use crate::rapid::ir::lower;
use crate::rapid::ir::walk::statements;
use crate::rapid::syntax;
use crate::rapid::text::SourceFile;

/// Lower-case names of the `PERS` data that these files declare.
pub fn declared_in<'f>(files: impl Iterator<Item = &'f SourceFile>) -> BTreeSet<String> {
    let modules = files.flat_map(|file| {
        let parse = syntax::parse(&file.bytes);
        lower(file.id, &parse, &file.bytes)
    });
    let data = modules.flat_map(|module| module.data);
    let pers = data.filter(|data| data.kind == DataKind::Pers);
    pers.map(|data| data.name.key.clone()).collect()
}

/// Lower-case names of the data that these files assign or pass to routines that may write them.
pub fn written_in<'f>(files: impl Iterator<Item = &'f SourceFile>) -> BTreeSet<String> {
    let (mut names, mut shared) = (BTreeSet::new(), BTreeSet::new());
    // Data written by computed name: any of the shared data may change.
    let mut by_name = false;
    let finds_by_name =
        |name: &Ident| instruction(&name.key).is_some_and(Instruction::finds_by_name);
    for file in files {
        let parse = syntax::parse(&file.bytes);
        for module in lower(file.id, &parse, &file.bytes) {
            let pers = module.data.iter().filter(|data| data.kind == DataKind::Pers);
            shared.extend(pers.map(|data| data.name.key.clone()));
            for block in module.routines.iter().flat_map(Routine::blocks) {
                by_name |= calls(block).any(|(_, name, _)| finds_by_name(name));
                let places = statements(block).flat_map(|stmt| written_places(stmt, may_write));
                names.extend(places.filter_map(Expr::base).map(|name| name.key.clone()));
            }
        }
    }
    if by_name {
        names.append(&mut shared);
    }
    names
}

//! The data of the module `user`, which every controller has but the given files rarely contain.

use std::sync::Arc;

use super::hir::{Data, DataKind, Ident, Module, Name, Scope};
use crate::rapid::text::{FileId, Span};

/// Names and types of `USER.SYS`.
const DATA: [(&str, &str); 6] = [
    ("reg1", "num"),
    ("reg2", "num"),
    ("reg3", "num"),
    ("reg4", "num"),
    ("reg5", "num"),
    ("clock1", "clock"),
];
/// The place of declarations without a source file.
const NOWHERE: Span = Span { file: FileId(0), start: 0, end: 0 };

/// A module with those data that no module declares globally; none if all are declared.
pub(super) fn missing(modules: &[Module]) -> Option<Module> {
    let declares = |module: &Module, key: &str| {
        let data = module.data.iter().map(|data| (data.scope, &data.name));
        let routines = module.routines.iter().map(|routine| (routine.scope, &routine.name));
        data.chain(routines).any(|(scope, name)| scope != Scope::Local && name.key == key)
    };
    let is_missing = |(name, _): &&(&str, &str)| !modules.iter().any(|m| declares(m, name));
    let data: Vec<Data> = DATA
        .iter()
        .filter(is_missing)
        .map(|(name, type_name)| Data {
            scope: Scope::Global,
            kind: DataKind::Var,
            type_name: ident(type_name),
            name: ident(name),
            dims: Vec::new(),
            init: None,
            span: NOWHERE,
        })
        .collect();
    (!data.is_empty()).then(|| Module {
        name: ident("user"),
        attributes: vec!["SYSMODULE".to_owned()],
        types: Vec::new(),
        data,
        routines: Vec::new(),
        span: NOWHERE,
    })
}

fn ident(name: &str) -> Ident {
    Ident::new(Arc::new(Name { text: name.to_owned(), key: name.to_owned() }), NOWHERE)
}

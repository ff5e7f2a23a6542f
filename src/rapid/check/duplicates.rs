//! Names that are declared twice in one scope.

use std::collections::BTreeMap;

use super::context::{Context, Extent};
use super::fault::{error, warning, with_place};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{DeclarationId, Kind, Reach};

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    let names = &context.names;
    let modules: Vec<DeclarationId> = names.modules().collect();
    let mut by_name: BTreeMap<&str, DeclarationId> = BTreeMap::new();
    let mut distinct = Vec::new();
    for module in modules {
        let (key, declaration) = (names.key(module), names.declaration(module));
        inside(context, module, out);
        if key.is_empty() {
            distinct.push(module);
        } else if let Some(first) = by_name.insert(key, module) {
            by_name.insert(key, first);
            let name = context.name(declaration);
            let message = format!("the module {name} is there twice");
            let help = "a task has one module of this name: rename or leave out one".to_owned();
            out.push(between_modules(context, module, first, message, help));
        } else {
            distinct.push(module);
        }
    }
    globals(context, &distinct, out);
}

/// Global names of several modules. Modules with one name are left out: only one can be loaded.
fn globals(context: &Context<'_>, modules: &[DeclarationId], out: &mut Vec<Diagnostic>) {
    let names = &context.names;
    let mut seen: BTreeMap<&str, (DeclarationId, DeclarationId)> = BTreeMap::new();
    for module in modules {
        for id in names.inside(*module) {
            let declaration = names.declaration(id);
            let key = names.key(id);
            if declaration.reach == Reach::Local || key.is_empty() {
                continue;
            }
            match seen.get(key) {
                Some((other, first)) if other != module => {
                    let name = context.name(declaration);
                    let message = format!("the global name {name} is declared in two modules");
                    let help = "rename one, or make it LOCAL".to_owned();
                    out.push(between_modules(context, id, *first, message, help));
                }
                Some(_) => {}
                None => {
                    seen.insert(key, (*module, id));
                }
            }
        }
    }
}

/// An error only where the files are one program: else they may be alternatives.
fn between_modules(
    context: &Context<'_>,
    second: DeclarationId,
    first: DeclarationId,
    message: String,
    help: String,
) -> Diagnostic {
    let span = context.names.declaration(second).name;
    let finding = match context.task.extent {
        Extent::Some => {
            let message = format!("{message}, which one task cannot load");
            warning("duplicate-name", span, message, help)
        }
        Extent::Program | Extent::All(_) => error("duplicate-name", span, message, help),
    };
    first_place(context, finding, first)
}

fn first_place(context: &Context<'_>, finding: Diagnostic, first: DeclarationId) -> Diagnostic {
    with_place(finding, context.names.declaration(first).name, "the first is here")
}

/// Names that are there twice inside a module, a routine or a record.
fn inside(context: &Context<'_>, outer: DeclarationId, out: &mut Vec<Diagnostic>) {
    let names = &context.names;
    let mut seen: BTreeMap<(bool, &str), DeclarationId> = BTreeMap::new();
    for id in names.inside(outer) {
        let declaration = names.declaration(id);
        inside(context, id, out);
        let key = names.key(id);
        // A FOR counter hides other names; labels are names apart.
        if key.is_empty() || declaration.kind == Kind::Counter {
            continue;
        }
        let first = *seen.entry((declaration.kind == Kind::Label, key)).or_insert(id);
        if first != id {
            let (message, help) = twice(context, outer, id);
            let finding = error("duplicate-name", declaration.name, message, help.to_owned());
            out.push(first_place(context, finding, first));
        }
    }
}

fn twice(
    context: &Context<'_>,
    outer: DeclarationId,
    id: DeclarationId,
) -> (String, &'static str) {
    let declaration = context.names.declaration(id);
    let name = context.name(declaration);
    let what = match (context.names.declaration(outer).kind, declaration.kind) {
        (_, Kind::Label) => "the label",
        (Kind::Record, _) => "the component",
        (Kind::Routine(_), Kind::Parameter(_)) => "the parameter",
        _ => "the name",
    };
    (format!("{what} {name} is declared twice"), "rename or remove one")
}

//! Names that are declared twice in one scope.

use std::collections::BTreeMap;

use super::context::{Context, Extent};
use super::fault::{error, warning, with_place};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{DeclarationId, Kind, Reach, Storage};

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    let names = &context.names;
    let modules: Vec<DeclarationId> = names.modules().collect();
    let mut by_name: BTreeMap<&str, DeclarationId> = BTreeMap::new();
    let mut distinct = Vec::new();
    for module in modules {
        let key = names.key(module);
        inside(context, module, out);
        if key.is_empty() {
            distinct.push(module);
        } else if let Some(first) = by_name.insert(key, module) {
            by_name.insert(key, first);
            out.push(module_twice(context, module, first));
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
    // The clashes of two modules: the second declaration and the first.
    let mut clashes: BTreeMap<(DeclarationId, DeclarationId), Vec<Clash>> = BTreeMap::new();
    for module in modules {
        for id in names.inside(*module) {
            let key = names.key(id);
            if names.declaration(id).reach == Reach::Local || key.is_empty() {
                continue;
            }
            match seen.get(key) {
                Some((other, first)) if other != module => {
                    let clash = Clash { second: id, first: *first };
                    clashes.entry((*other, *module)).or_default().push(clash);
                }
                Some(_) => {}
                None => {
                    seen.insert(key, (*module, id));
                }
            }
        }
    }
    let one_task = is_one_task(context, clashes.values().flatten());
    for ((_, module), clashes) in clashes {
        if one_task {
            out.extend(clashes.iter().map(|clash| clash.error(context)));
        } else if let [first, ..] = clashes.as_slice() {
            out.push(alternatives(context, module, first, clashes.len()));
        }
    }
}

/// A global name that two modules declare.
struct Clash {
    second: DeclarationId,
    first: DeclarationId,
}

impl Clash {
    fn error(&self, context: &Context<'_>) -> Diagnostic {
        let declaration = context.names.declaration(self.second);
        let name = context.name(declaration);
        let message = format!("the global name {name} is declared in two modules");
        let help = "rename one, or make it LOCAL".to_owned();
        let finding = error("duplicate-name", declaration.name, message, help);
        first_place(context, finding, self.first)
    }

    /// Whether both are PERS of one type, as tasks declare them that share data.
    fn is_shared(&self, context: &Context<'_>) -> bool {
        let [second, first] = [self.second, self.first].map(|id| context.names.declaration(id));
        let persistent = Kind::Data(Storage::Pers);
        second.kind == persistent && first.kind == persistent && second.value == first.value
    }
}

/// Whether modules with these clashes are surely meant for one task.
fn is_one_task<'c>(context: &Context<'_>, mut clashes: impl Iterator<Item = &'c Clash>) -> bool {
    match context.task.extent {
        Extent::Some => false,
        Extent::Program => !clashes.any(|clash| clash.is_shared(context)),
        Extent::Task | Extent::All(_) => true,
    }
}

fn alternatives(
    context: &Context<'_>,
    module: DeclarationId,
    clash: &Clash,
    count: usize,
) -> Diagnostic {
    let declaration = context.names.declaration(clash.second);
    let other = context.names.module_of(clash.first).map(|id| context.shown(id));
    let (this, other) = (context.shown(module), other.unwrap_or_default());
    let plural = if count == 1 { "" } else { "s" };
    let message = format!(
        "{other} and {this} declare {count} equal global name{plural} ({}): one task cannot load both",
        context.name(declaration)
    );
    let help = "load them into different tasks, or one of them, or rename".to_owned();
    let finding = warning("duplicate-name", declaration.name, message, help);
    first_place(context, finding, clash.first)
}

/// An error only where the files are one program: else they may be alternatives.
fn module_twice(context: &Context<'_>, second: DeclarationId, first: DeclarationId) -> Diagnostic {
    let declaration = context.names.declaration(second);
    let message = format!("the module {} is there twice", context.name(declaration));
    let help = "a task has one module of this name: rename or leave out one".to_owned();
    let finding = match context.task.extent {
        Extent::Some => warning("duplicate-name", declaration.name, message, help),
        _ => error("duplicate-name", declaration.name, message, help),
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

fn twice(context: &Context<'_>, outer: DeclarationId, id: DeclarationId) -> (String, &'static str) {
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

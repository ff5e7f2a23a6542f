//! Declarations that have the new name already.

use super::refusal::{Refusal, place};
use crate::rapid::names::{DeclarationId, Kind, Meaning, Names, Reach};
use crate::rapid::text::Span;
use crate::tool::lsp::entity::{Entity, is_shared};
use crate::tool::lsp::task::Task;
use crate::tool::lsp::workspace::View;

/// Refuses a name that another declaration in the scope of one of the declarations has.
pub(super) fn check(view: View<'_>, entity: &Entity, new: &str, key: &str) -> Result<(), Refusal> {
    let modules = &view.project.modules;
    let has =
        |task: &&Task, key: &str| task.files.files.iter().any(|file| modules[*file].mentions(key));
    let concerned = |task: &Task| {
        let files = &task.files.files;
        entity.declarations.iter().any(|span| files.contains(&(span.file.0 as usize)))
    };
    for task in view.project.tasks.iter().filter(|task| concerned(task) && has(task, key)) {
        let names = task.names(modules);
        for span in &entity.declarations {
            let Some(id) = declaration(names, *span) else { continue };
            if let Some(other) = twin(names, id, key) {
                let (name, place) = (new.to_owned(), place(view, names.declaration(other).name));
                return Err(Refusal::Clash { name, place });
            }
        }
    }
    shared(view, entity, new, key)
}

/// Tasks of one controller would share what is a persistent of its own today.
fn shared(view: View<'_>, entity: &Entity, new: &str, key: &str) -> Result<(), Refusal> {
    let modules = &view.project.modules;
    let controllers: Vec<usize> = view
        .project
        .tasks
        .iter()
        .filter(|task| {
            let names = || task.names(modules);
            entity.declarations.iter().any(|span| {
                task.files.files.contains(&(span.file.0 as usize))
                    && declaration(names(), *span)
                        .is_some_and(|id| is_shared(names(), names().declaration(id)))
            })
        })
        .map(|task| task.files.controller)
        .collect();
    for task in &view.project.tasks {
        let files = &task.files.files;
        if !controllers.contains(&task.files.controller)
            || !files.iter().any(|file| modules[*file].mentions(key))
        {
            continue;
        }
        let names = task.names(modules);
        let globals = names.modules().flat_map(|module| names.inside(module));
        let mut twins =
            globals.filter(|id| names.key(*id) == key && is_shared(names, names.declaration(*id)));
        if let Some(twin) = twins.next() {
            let (name, place) = (new.to_owned(), place(view, names.declaration(twin).name));
            return Err(Refusal::Clash { name, place });
        }
    }
    Ok(())
}

/// The declaration whose name stands at a place.
fn declaration(names: &Names, span: Span) -> Option<DeclarationId> {
    match names.at(span.file, span.start)?.meaning {
        Meaning::Declared(id) if names.declaration(id).name == span => Some(id),
        _ => None,
    }
}

/// Another declaration in the scope of one that has a name in lower case.
fn twin(names: &Names, id: DeclarationId, key: &str) -> Option<DeclarationId> {
    let declaration = names.declaration(id);
    let same = |other: &DeclarationId| *other != id && names.key(*other) == key;
    let global = || {
        let globals = names.modules().flat_map(|module| names.inside(module));
        names.modules().chain(globals.filter(|it| names.declaration(*it).reach != Reach::Local))
    };
    let Some(parent) = declaration.parent else { return global().find(same) };
    let kind = declaration.kind;
    let beside = names.inside(parent).filter(|other| {
        // Counters hide other names, and labels are names apart.
        let other = names.declaration(*other).kind;
        kind != Kind::Counter
            && other != Kind::Counter
            && (kind == Kind::Label) == (other == Kind::Label)
    });
    let mut beside = beside.filter(same);
    let is_global =
        names.declaration(parent).kind == Kind::Module && declaration.reach != Reach::Local;
    beside.next().or_else(|| if is_global { global().find(same) } else { None })
}

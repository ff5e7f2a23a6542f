//! Data that would hide a called routine.
//!
//! The index of names prefers routines where something is called; a controller takes the innermost name.

use super::refusal::{Refusal, place};
use crate::rapid::names::{DeclarationId, Kind, Meaning, Names, Role};
use crate::rapid::text::{FileId, Span};
use crate::tool::lsp::entity::{Entity, identifier};
use crate::tool::lsp::workspace::View;

/// Refuses a name (`key` in lower case) with which data would stand before a routine that is called.
pub(super) fn check(
    view: View<'_>,
    entity: &Entity,
    kind: Kind,
    new: &str,
    key: &str,
) -> Result<(), Refusal> {
    let found = match kind {
        Kind::Routine(_) => calls_behind_data(view, entity, key),
        Kind::Data(_) | Kind::Parameter(_) | Kind::Counter => called_inside(view, entity, key),
        _ => None,
    };
    match found {
        Some(span) => Err(Refusal::Captured { name: new.to_owned(), place: place(view, span) }),
        None => Ok(()),
    }
}

fn is_call(role: Role) -> bool {
    matches!(role, Role::Procedure | Role::Function | Role::Trap)
}

/// A call of the renamed routine at a place where data have the new name.
fn calls_behind_data(view: View<'_>, entity: &Entity, key: &str) -> Option<Span> {
    let calls = entity.uses.iter().filter(|(_, role)| is_call(**role)).map(|(span, _)| *span);
    let mut calls = calls.filter(|span| view.project.module(span.file).mentions(key));
    calls.find(|span| {
        view.project.names_of(span.file).any(|names| has_data(names, span.file, span.start, key))
    })
}

/// Whether data of the module or routine around a byte have a name.
fn has_data(names: &Names, file: FileId, byte: u32, key: &str) -> bool {
    let around = |id: &DeclarationId| {
        let whole = names.declaration(*id).whole;
        whole.file == file && whole.start <= byte && byte < whole.end
    };
    let is_data = |id: DeclarationId| {
        let kind = names.declaration(id).kind;
        names.key(id) == key && matches!(kind, Kind::Data(_) | Kind::Parameter(_) | Kind::Counter)
    };
    let Some(module) = names.modules().find(around) else { return false };
    let mut routines = names.inside(module).filter(around);
    names.inside(module).any(is_data) || routines.any(|routine| names.inside(routine).any(is_data))
}

/// A call of a routine with the new name inside the scope of the renamed data.
fn called_inside(view: View<'_>, entity: &Entity, key: &str) -> Option<Span> {
    for declared in &entity.declarations {
        let file = declared.file;
        if !view.project.module(file).mentions(key) {
            continue;
        }
        for names in view.project.names_of(file) {
            let Some(Meaning::Declared(id)) =
                identifier(names, file, declared.start).map(|one| one.meaning)
            else {
                continue;
            };
            let Some(parent) = names.declaration(id).parent else { continue };
            let scope = names.declaration(parent).whole;
            let calls = names.uses(file).iter().filter(|one| {
                is_call(one.role) && scope.start <= one.start && one.end <= scope.end
            });
            let mut calls = calls.map(|one| Span { file, start: one.start, end: one.end });
            let found = calls.find(|span| view.project.text(*span).to_lowercase() == key);
            if found.is_some() {
                return found;
            }
        }
    }
    None
}

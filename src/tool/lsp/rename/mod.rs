//! Renaming over all files of a project.
//!
//! `new_name` tells whether a text can be a name, `clash` whether another declaration has it, `hidden`
//! whether data would hide a called routine, `entry` whether the controller looks for the old name.
//! `late` finds the strings that call a procedure by its name, `check` reads the result again: if any
//! identifier would mean something else than before, nothing is renamed. `refusal` has the reasons.

mod check;
mod clash;
mod entry;
mod hidden;
mod late;
mod new_name;
mod refusal;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use gen_lsp_types::{Range, TextEdit, WorkspaceEdit};

use self::late::Strings;
pub(super) use self::refusal::Refusal;
use super::entity::{Declared, declared, entity, identifier};
use super::workspace::View;
use crate::rapid::names::{Kind, Meaning, Role};
use crate::rapid::text::{Edit, FileId, Span};

/// The identifier that would be renamed, and its text.
pub(super) fn prepare(view: View<'_>, byte: u32) -> Result<(Range, String), Refusal> {
    let (span, _) = target(view, byte)?;
    Ok((view.positions().range(span), view.project.text(span).into_owned()))
}

/// The edits that give what is named at a byte another name.
pub(super) fn rename(view: View<'_>, byte: u32, new: &str) -> Result<WorkspaceEdit, Refusal> {
    let (span, found) = target(view, byte)?;
    let old = view.project.text(span).into_owned();
    let key = new_name::checked(new)?;
    let Some(entity) = entity(view, byte) else { return Err(Refusal::NoName) };
    let kind = found.declaration().kind;
    if key != old.to_lowercase() {
        entry::check(view, &entity)?;
        clash::check(view, &entity, new, &key)?;
        hidden::check(view, &entity, kind, new, &key)?;
    }
    late::doubtful(view, &entity, kind, &old)?;
    let mut places: BTreeSet<Span> = entity.uses.keys().copied().collect();
    places.extend(late::strings(view, &entity, &old, Strings::of(kind)));
    let mut edits: BTreeMap<FileId, Vec<Edit>> = BTreeMap::new();
    for span in places {
        let file = &view.project.module(span.file).file;
        let Some(text) = file.charset.encode(new) else {
            let (file, encoding) = (file.path.clone(), file.encoding());
            return Err(Refusal::Encoding { file, encoding, name: new.to_owned() });
        };
        edits.entry(span.file).or_default().push(Edit { span, text });
    }
    check::check(view, &edits, new)?;
    let changes: HashMap<_, _> = edits
        .iter()
        .map(|(file, edits)| {
            let text = |edit: &Edit| TextEdit {
                range: view.positions_of(*file).range(edit.span),
                new_text: new.to_owned(),
            };
            (view.uri_of(*file).into(), edits.iter().map(text).collect())
        })
        .collect();
    Ok(WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() })
}

/// The identifier at a byte and a declaration of a file that it names.
fn target(view: View<'_>, byte: u32) -> Result<(Span, Declared<'_>), Refusal> {
    let mut all = view.project.names_of(view.file);
    let one = all.find_map(|names| identifier(names, view.file, byte)).ok_or(Refusal::NoName)?;
    let span = Span { file: view.file, start: one.start, end: one.end };
    let text = || view.project.text(span).into_owned();
    if one.role == Role::Procedure && one.meaning == Meaning::Late {
        return Err(Refusal::NoName);
    }
    let found = declared(view, byte);
    if let Some(own) = found.iter().find(|one| !one.names.is_predefined(one.id)) {
        let unnamed = own.declaration().kind == Kind::Module && own.key().is_empty();
        return if unnamed { Err(Refusal::NoName) } else { Ok((span, *own)) };
    }
    match one.meaning {
        Meaning::Declared(_) | Meaning::Predefined(_) | Meaning::Known => {
            Err(Refusal::BuiltIn(text()))
        }
        Meaning::Late | Meaning::Open | Meaning::Unknown => Err(Refusal::NotDeclared(text())),
    }
}

//! The procedure that starts a program.

use super::refusal::Refusal;
use crate::rapid::names::{Kind, Meaning, Reach};
use crate::tool::lsp::entity::{Entity, identifier};
use crate::tool::lsp::workspace::View;

/// Refuses to rename the procedure that starts a task.
pub(super) fn check(view: View<'_>, entity: &Entity) -> Result<(), Refusal> {
    for task in &view.project.tasks {
        let entry = &task.files.entry;
        let starting = entity.declarations.iter().filter(|span| {
            task.files.files.contains(&(span.file.0 as usize))
                && view.project.text(**span).eq_ignore_ascii_case(entry)
        });
        for span in starting {
            let names = task.names(&view.project.modules);
            let Some(Meaning::Declared(id)) =
                identifier(names, span.file, span.start).map(|one| one.meaning)
            else {
                continue;
            };
            let declaration = names.declaration(id);
            if matches!(declaration.kind, Kind::Routine(_)) && declaration.reach != Reach::Local {
                return Err(Refusal::Entry(view.project.text(*span).into_owned()));
            }
        }
    }
    Ok(())
}

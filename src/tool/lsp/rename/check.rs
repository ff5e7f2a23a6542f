//! Whether all identifiers of a renamed program mean what they meant.

use std::collections::BTreeMap;

use super::refusal::{Refusal, place};
use crate::rapid::names::{Names, SourceText, Use};
use crate::rapid::syntax::{Parse, parse};
use crate::rapid::text::{Edit, FileId, SourceFile, Span};
use crate::tool::lsp::workspace::View;

/// Reads the edited files again and compares the meaning of every identifier in all tasks that load one
/// of them.
pub(super) fn check(
    view: View<'_>,
    edits: &BTreeMap<FileId, Vec<Edit>>,
    new: &str,
) -> Result<(), Refusal> {
    let project = view.project;
    let mut edited: BTreeMap<usize, (SourceFile, Parse)> = BTreeMap::new();
    for (file, edits) in edits {
        // The identifiers do not overlap.
        let Ok(source) = project.module(*file).file.edited(edits) else { continue };
        let parse = parse(&source.bytes);
        edited.insert(file.0 as usize, (source, parse));
    }
    for task in &project.tasks {
        let files = &task.files.files;
        if !files.iter().any(|file| edited.contains_key(file)) {
            continue;
        }
        let before = task.names(&project.modules);
        let sources: Vec<SourceText<'_>> = files
            .iter()
            .map(|file| match edited.get(file) {
                Some((file, parse)) => SourceText { file, parse },
                None => project.modules[*file].source(),
            })
            .collect();
        let after = Names::new(&sources);
        for file in files.iter().map(|file| FileId(*file as u32)) {
            if let Some(span) = changed(before, &after, file) {
                let (name, place) = (new.to_owned(), place(view, span));
                return Err(Refusal::Captured { name, place });
            }
        }
    }
    Ok(())
}

/// The first identifier of a file that has another meaning. Declarations have numbers by their order,
/// which a new name leaves as it is.
fn changed(before: &Names, after: &Names, file: FileId) -> Option<Span> {
    let (old, new) = (before.uses(file), after.uses(file));
    let span = |one: &Use| Span { file, start: one.start, end: one.end };
    let mut pairs = old.iter().zip(new);
    let other = pairs.find(|(old, new)| (old.role, old.meaning) != (new.role, new.meaning));
    let more = || old.get(new.len()).or(old.last()).filter(|_| old.len() != new.len());
    other.map(|(old, _)| old).or_else(more).map(span)
}

//! What an identifier names, and all identifiers that name the same, in all tasks of a project.

use std::collections::{BTreeMap, BTreeSet};

use super::project::Project;
use super::workspace::View;
use crate::rapid::names::{
    Declaration, DeclarationId, Kind, Meaning, Names, Reach, Role, Storage, Use,
};
use crate::rapid::text::{FileId, Span};

/// A declaration and the names of a task that has it.
#[derive(Clone, Copy)]
pub(super) struct Declared<'p> {
    pub(super) names: &'p Names,
    pub(super) id: DeclarationId,
}

impl<'p> Declared<'p> {
    pub(super) fn declaration(self) -> &'p Declaration {
        self.names.declaration(self.id)
    }

    pub(super) fn key(self) -> &'p str {
        self.names.key(self.id)
    }
}

/// One thing of a program.
pub(super) struct Entity {
    /// The names in its declarations: several, where tasks share a file or persistents.
    pub(super) declarations: BTreeSet<Span>,
    /// All identifiers that name it, the declarations included.
    pub(super) uses: BTreeMap<Span, Role>,
}

/// The identifier at a byte, or that ends there.
pub(super) fn identifier(names: &Names, file: FileId, byte: u32) -> Option<&Use> {
    let before = || names.at(file, byte.checked_sub(1)?).filter(|one| one.end == byte);
    names.at(file, byte).or_else(before)
}

/// What the identifier at a byte names in each task that has another answer than those before.
pub(super) fn meanings(view: View<'_>, byte: u32) -> Vec<(&Names, Use)> {
    let mut found: Vec<(&Names, Use)> = Vec::new();
    for names in view.project.names_of(view.file) {
        let Some(one) = identifier(names, view.file, byte) else { continue };
        let place = |names: &Names, one: &Use| match one.meaning {
            Meaning::Declared(id) => Some(names.declaration(id).name),
            _ => None,
        };
        if found.iter().all(|(other, known)| place(other, known) != place(names, one)) {
            found.push((names, *one));
        }
    }
    found
}

/// The declarations that the identifier at a byte names.
pub(super) fn declared(view: View<'_>, byte: u32) -> Vec<Declared<'_>> {
    let declared = |(names, one): (_, Use)| match one.meaning {
        Meaning::Declared(id) => Some(Declared { names, id }),
        _ => None,
    };
    meanings(view, byte).into_iter().filter_map(declared).collect()
}

/// The thing of a user that the identifier at a byte names.
pub(super) fn entity(view: View<'_>, byte: u32) -> Option<Entity> {
    let own = |one: &Declared<'_>| !one.names.is_predefined(one.id);
    let found: Vec<Declared<'_>> = declared(view, byte).into_iter().filter(own).collect();
    let key = found.first()?.key().to_owned();
    let places = found.iter().map(|one| one.declaration().name).collect();
    Some(named(view.project, &key, places))
}

/// An identifier and the declaration that it names in one task.
struct Pair {
    place: Span,
    role: Role,
    declaration: Span,
    /// Of a global persistent: its controller.
    shared: Option<usize>,
}

/// The thing that has at least these declarations, all with one name.
pub(super) fn named(project: &Project, key: &str, mut declarations: BTreeSet<Span>) -> Entity {
    let pairs = pairs(project, key);
    loop {
        let before = declarations.len();
        let places: BTreeSet<Span> = pairs
            .iter()
            .filter(|pair| declarations.contains(&pair.declaration))
            .map(|pair| pair.place)
            .collect();
        let controllers: BTreeSet<usize> = pairs
            .iter()
            .filter(|pair| declarations.contains(&pair.declaration))
            .filter_map(|pair| pair.shared)
            .collect();
        // An identifier in a file of several tasks may name another declaration in each of them.
        let same = |pair: &&Pair| {
            places.contains(&pair.place)
                || pair.shared.is_some_and(|controller| controllers.contains(&controller))
        };
        declarations.extend(pairs.iter().filter(same).map(|pair| pair.declaration));
        if declarations.len() == before {
            break;
        }
    }
    let own = pairs.iter().filter(|pair| declarations.contains(&pair.declaration));
    let uses = own.map(|pair| (pair.place, pair.role)).collect();
    Entity { declarations, uses }
}

/// All identifiers of a name (lower case) that name a declaration of a file.
fn pairs(project: &Project, key: &str) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for task in &project.tasks {
        let with: Vec<usize> = (task.files.files.iter().copied())
            .filter(|index| project.modules[*index].mentions(key))
            .collect();
        if with.is_empty() {
            continue;
        }
        let names = task.names(&project.modules);
        for file in with.into_iter().map(|index| FileId(index as u32)) {
            for one in names.uses(file) {
                let Meaning::Declared(id) = one.meaning else { continue };
                if names.is_predefined(id) || names.key(id) != key {
                    continue;
                }
                let declaration = names.declaration(id);
                pairs.push(Pair {
                    place: Span { file, start: one.start, end: one.end },
                    role: one.role,
                    declaration: declaration.name,
                    shared: is_shared(names, declaration).then_some(task.files.controller),
                });
            }
        }
    }
    pairs
}

/// Whether all tasks of a controller have one value of it: global persistent data of a module.
pub(super) fn is_shared(names: &Names, declaration: &Declaration) -> bool {
    let in_module = |id: DeclarationId| names.declaration(id).kind == Kind::Module;
    declaration.kind == Kind::Data(Storage::Pers)
        && declaration.reach == Reach::Global
        && declaration.parent.is_some_and(in_module)
}

/// The identifiers of the file that have the meaning of the predefined one at a byte.
pub(super) fn alike(view: View<'_>, byte: u32) -> Vec<Span> {
    let Some(names) = view.project.names_of(view.file).next() else { return Vec::new() };
    let Some(one) = identifier(names, view.file, byte) else { return Vec::new() };
    let text = |one: &Use| {
        let span = Span { file: view.file, start: one.start, end: one.end };
        (view.project.text(span).to_lowercase(), span)
    };
    let (key, _) = text(one);
    let same = |other: &&Use| other.meaning == one.meaning && one.meaning != Meaning::Unknown;
    let found = names.uses(view.file).iter().filter(same).map(text);
    found.filter(|(other, _)| *other == key).map(|(_, span)| span).collect()
}

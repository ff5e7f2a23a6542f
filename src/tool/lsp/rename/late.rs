//! Names in strings: procedures that are called by a string, and names whose meaning is not known.

use super::refusal::{Refusal, place};
use crate::rapid::names::{Kind, Meaning, Role, RoutineKind};
use crate::rapid::syntax::{Node, NodeKind};
use crate::rapid::text::{FileId, Span};
use crate::tool::lsp::entity::Entity;
use crate::tool::lsp::module::Module;
use crate::tool::lsp::workspace::View;

/// The name in lower case of the argument that names a procedure: `MoveLSync … "proc"`.
const CALLBACK: &str = "procname";

/// Whether strings may name a thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Strings {
    /// They may: it is a procedure.
    Call,
    /// They may not.
    Mean,
}

impl Strings {
    pub(super) fn of(kind: Kind) -> Strings {
        if kind == Kind::Routine(RoutineKind::Proc) { Strings::Call } else { Strings::Mean }
    }
}

/// The files that are loaded together with a declaration.
fn files(view: View<'_>, entity: &Entity) -> Vec<usize> {
    let mut files: Vec<usize> = Vec::new();
    for task in &view.project.tasks {
        let own = &task.files.files;
        if entity.declarations.iter().any(|span| own.contains(&(span.file.0 as usize))) {
            files.extend(own);
        }
    }
    files.sort_unstable();
    files.dedup();
    files
}

/// The names inside the strings that call the procedure: `%"proc"%`, and the argument of `MoveLSync`.
pub(super) fn strings(view: View<'_>, entity: &Entity, old: &str, strings: Strings) -> Vec<Span> {
    if strings == Strings::Mean {
        return Vec::new();
    }
    let key = old.to_lowercase();
    let mut found = Vec::new();
    for index in files(view, entity) {
        let module = &view.project.modules[index];
        for node in module.parse().tree.nodes() {
            let callback = || callbacks(view, module, node);
            let literals: Vec<Node<'_>> = match node.kind() {
                NodeKind::LateBinding => node.children().collect(),
                NodeKind::CallStatement => callback(),
                _ => continue,
            };
            let names = literals.into_iter().filter(|it| it.kind() == NodeKind::StringLiteral);
            found.extend(
                names
                    .map(|literal| inside(module, literal))
                    .filter(|span| module.file.text(*span).to_lowercase() == key),
            );
        }
    }
    found
}

/// The bytes between the quotation marks.
fn inside(module: &Module, literal: Node<'_>) -> Span {
    let range = literal.range();
    let (start, end) = (range.start + 1, range.end.saturating_sub(1));
    Span { file: module.file.id, start: start.min(end), end }
}

/// The arguments of a call that name a procedure.
fn callbacks<'t>(view: View<'_>, module: &'t Module, call: Node<'t>) -> Vec<Node<'t>> {
    let callee = call.callee().map(|name| name.range().start);
    let file: FileId = module.file.id;
    let position = callee.and_then(|start| {
        let names = view.project.names_of(file).next()?;
        let Meaning::Declared(id) = names.at(file, start)?.meaning else { return None };
        let required = names.inside(id).filter(|inner| {
            matches!(names.declaration(*inner).kind, Kind::Parameter(mode) if mode.group.is_none())
        });
        names.is_predefined(id).then_some(())?;
        required.map(|inner| names.key(inner)).position(|key| key == CALLBACK)
    });
    let Some(position) = position else { return Vec::new() };
    let positional = call.children().skip(1).filter(|it| !it.kind().is_named_argument());
    positional.skip(position).take(1).collect()
}

/// Refuses where a place may mean the thing and nobody knows: a component or argument of something
/// unknown, or a string that is put together.
pub(super) fn doubtful(
    view: View<'_>,
    entity: &Entity,
    kind: Kind,
    old: &str,
) -> Result<(), Refusal> {
    let key = old.to_lowercase();
    let refuse = |span: Span, why| {
        Err(Refusal::Doubtful { name: old.to_owned(), place: place(view, span), why })
    };
    for index in files(view, entity) {
        let module = &view.project.modules[index];
        if kind == Kind::Routine(RoutineKind::Proc) {
            let begins = |span: &Span| {
                let start = module.file.text(*span).to_lowercase();
                !start.is_empty() && key.starts_with(&start) && start != key
            };
            if let Some(span) = composed(module).find(begins) {
                return refuse(span, "a string that is put together names the procedure");
            }
        }
        if kind != Kind::Component || !module.mentions(&key) {
            continue;
        }
        let file = module.file.id;
        for names in view.project.names_of(file) {
            for one in names.uses(file) {
                let span = Span { file, start: one.start, end: one.end };
                if one.role == Role::Component
                    && one.meaning == Meaning::Open
                    && view.project.text(span).to_lowercase() == key
                {
                    return refuse(span, "the type of the value before the dot has no declaration");
                }
            }
        }
    }
    Ok(())
}

/// The beginnings of the strings that are put together to call a procedure.
fn composed(module: &Module) -> impl Iterator<Item = Span> {
    let nodes = module.parse().tree.nodes();
    let bindings = nodes.filter(|node| node.kind() == NodeKind::LateBinding);
    bindings.filter_map(|node| {
        let whole = node.children().next().filter(|it| it.kind() != NodeKind::StringLiteral)?;
        let first = whole.subtree().find(|it| it.kind() == NodeKind::StringLiteral)?;
        (first.range().start == whole.range().start).then(|| inside(module, first))
    })
}

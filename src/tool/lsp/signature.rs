//! Declarations as one line of RAPID.

use super::entity::Declared;
use super::project::Project;
use crate::rapid::builtins::OTHERS;
use crate::rapid::names::{Kind, Reach, RoutineKind};

/// Longest text of data, in characters.
const LONGEST: usize = 160;

/// A declaration as one line.
pub(super) struct Signature {
    /// The line.
    pub(super) text: String,
    /// Of a routine: its parameters.
    pub(super) parameters: Vec<Parameter>,
}

/// A parameter in a signature.
pub(super) struct Parameter {
    /// Its place in the line, in bytes.
    pub(super) start: usize,
    pub(super) end: usize,
    /// Its name, in lower case; empty for options that are not declared.
    pub(super) key: String,
    /// Whether it is `\name`.
    pub(super) optional: bool,
}

/// The declaration as one line.
pub(super) fn signature(project: &Project, one: Declared<'_>) -> Signature {
    match one.declaration().kind {
        Kind::Routine(RoutineKind::Proc | RoutineKind::Func) => routine(project, one),
        Kind::Module | Kind::Routine(RoutineKind::Trap) => {
            let keyword = if one.declaration().kind == Kind::Module { "MODULE" } else { "TRAP" };
            line(format!("{}{keyword} {}", scope(one), name(project, one)))
        }
        Kind::Counter => line(format!("FOR {}", name(project, one))),
        Kind::Component => {
            let record = one.declaration().parent.map(|id| Declared { id, ..one });
            let record = record.map_or_else(String::new, |record| name(project, record));
            let text = whole(project, one);
            line(format!("{} (RECORD {record})", text.trim_end_matches(';')))
        }
        Kind::Parameter(mode) => {
            let mark = if mode.group.is_some() { "\\" } else { "" };
            line(format!("{mark}{}", whole(project, one)))
        }
        Kind::Basic(_) => line(format!("type {}", name(project, one))),
        Kind::Record | Kind::Alias | Kind::Data(_) | Kind::Label => line(whole(project, one)),
    }
}

fn line(text: String) -> Signature {
    Signature { text, parameters: Vec::new() }
}

fn routine(project: &Project, one: Declared<'_>) -> Signature {
    let function = one.declaration().kind == Kind::Routine(RoutineKind::Func);
    let mut text = scope(one).to_owned();
    text.push_str(if function { "FUNC " } else { "PROC " });
    if function {
        let of_type = one.declaration().value.declaration.map(|id| Declared { id, ..one });
        let of_type = of_type.map_or_else(|| "?".to_owned(), |of_type| name(project, of_type));
        text.push_str(&of_type);
        text.push(' ');
    }
    text.push_str(&name(project, one));
    text.push('(');
    let mut parameters = Vec::new();
    let mut last_group = None;
    for id in one.names.inside(one.id) {
        let inner = Declared { id, ..one };
        let Kind::Parameter(mode) = inner.declaration().kind else { continue };
        let alternative = mode.group.is_some() && mode.group == last_group;
        last_group = mode.group;
        if !parameters.is_empty() {
            text.push_str(if alternative { " | " } else { ", " });
        }
        let others = one.names.is_predefined(one.id) && inner.key() == OTHERS;
        let start = text.len();
        if mode.group.is_some() && !alternative {
            text.push('\\');
        }
        if others {
            text.push('…');
        } else {
            text.push_str(&whole(project, inner));
        }
        let key = if others { String::new() } else { inner.key().to_owned() };
        let optional = mode.group.is_some();
        parameters.push(Parameter { start, end: text.len(), key, optional });
    }
    text.push(')');
    Signature { text, parameters }
}

fn scope(one: Declared<'_>) -> &'static str {
    match one.declaration().reach {
        Reach::Local => "LOCAL ",
        Reach::Task => "TASK ",
        Reach::Global => "",
    }
}

/// The name as it is declared.
pub(super) fn name(project: &Project, one: Declared<'_>) -> String {
    match one.names.predefined_name(one.id) {
        Some(name) => name.to_owned(),
        None => project.text(one.declaration().name).into_owned(),
    }
}

/// The whole declaration in one line, shortened if it is long.
fn whole(project: &Project, one: Declared<'_>) -> String {
    let text = match one.names.built_in_text(one.id) {
        Some(text) => text.into(),
        None => project.text(one.declaration().whole),
    };
    let joined: Vec<&str> = text.split_whitespace().collect();
    let joined = joined.join(" ");
    match joined.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &joined[..end]),
        None => joined,
    }
}

//! Changes of declared data.

use super::canonical::{Writer, scope};
use super::change::{Action, Subject};
use super::context::{Context, Reworded, source};
use super::exact::same_data;
use super::names::Names;
use super::state::is_state;
use super::statement::Found;
use crate::rapid::ir::hir::{Data, DataKind};
use crate::rapid::text::{SourceFile, Span};

/// What data of a type are about.
pub(super) fn subject(type_key: &str) -> Subject {
    match type_key {
        "robtarget" | "jointtarget" => Subject::Target,
        "speeddata" => Subject::Speed,
        "zonedata" | "stoppointdata" => Subject::Zone,
        "tooldata" => Subject::Tool,
        "wobjdata" => Subject::WorkObject,
        "loaddata" => Subject::Load,
        _ => Subject::Data,
    }
}

/// What two declarations have in common with each other.
pub(super) enum Compared {
    /// They mean the same.
    Same,
    /// Only the value differs, which the controller saves.
    State,
    /// They differ.
    Changed(Found),
}

/// Compares two declarations with corresponding names.
pub(super) fn compare(context: &Context<'_>, old: &Data, new: &Data) -> Compared {
    let identity = Names::default();
    let writer = Writer { files: context.new.files, names: &identity };
    let (before, after) = (context.old_writer().declaration(old), writer.declaration(new));
    let found = |message: String, differences| {
        Compared::Changed(Found {
            subject: subject(&new.type_name.key),
            action: Action::Changed,
            spans: [Some(old.span), Some(new.span)],
            message,
            differences,
        })
    };
    let name = &new.name.text;
    if before != after {
        let [before, after] = [(context.old.files, old), (context.new.files, new)]
            .map(|(files, data)| short(files, data));
        return found(format!("{name}: {before} → {after}"), Vec::new());
    }
    if context.old_writer().data(old) == writer.data(new) && same_data(old, new) {
        return Compared::Same;
    }
    if is_state(&context.new.program, new) {
        return Compared::State;
    }
    match (&old.init, &new.init) {
        (Some(a), Some(b)) => match context.reworded(&new.type_name.key, a, b) {
            None => Compared::Same,
            Some(Reworded { message, differences }) => {
                found(format!("{name} {message}"), differences)
            }
        },
        (Some(value), None) => {
            let value = source(context.old.files, value.span);
            found(format!("{name}: {value} → no value"), Vec::new())
        }
        (None, Some(value)) => {
            let value = source(context.new.files, value.span);
            found(format!("{name}: no value → {value}"), Vec::new())
        }
        (None, None) => Compared::Same,
    }
}

/// Data that only one side has.
pub(super) fn alone(files: &[SourceFile], data: &Data, action: Action) -> Found {
    let span = Some(data.span);
    Found {
        subject: subject(&data.type_name.key),
        action,
        spans: if action == Action::Removed { [span, None] } else { [None, span] },
        message: format!("{} {}", kind(data.kind), named(files, data)),
        differences: Vec::new(),
    }
}

/// Data with another name and the same value.
pub(super) fn renamed(old: &Data, new: &Data) -> Found {
    let spans: [Option<Span>; 2] = [Some(old.span), Some(new.span)];
    Found {
        subject: subject(&new.type_name.key),
        action: Action::Renamed,
        spans,
        message: format!("{} {} → {}", new.type_name.text, old.name.text, new.name.text),
        differences: Vec::new(),
    }
}

fn named(files: &[SourceFile], data: &Data) -> String {
    let dims: Vec<String> = data.dims.iter().map(|dim| source(files, dim.span)).collect();
    let dims = if dims.is_empty() { String::new() } else { format!("{{{}}}", dims.join(",")) };
    format!("{} {}{dims}", data.type_name.text, data.name.text)
}

/// The declaration without its name and value.
fn short(files: &[SourceFile], data: &Data) -> String {
    let dims: Vec<String> = data.dims.iter().map(|dim| source(files, dim.span)).collect();
    let dims = if dims.is_empty() { String::new() } else { format!("{{{}}}", dims.join(",")) };
    format!("{}{} {}{dims}", scope(data.scope), kind(data.kind), data.type_name.text)
}

fn kind(kind: DataKind) -> &'static str {
    match kind {
        DataKind::Const => "CONST",
        DataKind::Var => "VAR",
        DataKind::Pers => "PERS",
    }
}

//! Routines and modules as canonical text, one declaration or statement a line.

use std::fmt::Write as _;

use super::canonical::{Writer, parameter, scope};
use super::declared;
use super::names::Names;
use super::node::{Builder, Interner, Label, Node};
use super::state::is_state;
use super::unread::{unread, words};
use crate::rapid::ir::hir::{Data, Module, Routine, RoutineKind, TypeDef, TypeDefKind};
use crate::rapid::ir::lower;
use crate::rapid::ir::program::Program;
use crate::rapid::syntax::{self, TokenKind};
use crate::rapid::text::{FileId, SourceFile, is_encoded_module};

/// What a file means, as text that does not change with layout, comments, the order of declarations,
/// the form of numbers, or values that a controller saves with a program: for `git diff` with a
/// `textconv`. Statements with syntax errors stand as their words.
#[must_use]
pub fn meaning(file: &SourceFile) -> String {
    let file = SourceFile { id: FileId(0), ..file.clone() };
    if is_encoded_module(&file.bytes) {
        let mut out = "encoded module ".to_owned();
        for byte in &file.bytes {
            let _ = write!(out, "{byte:02x}");
        }
        return out + "\n";
    }
    let parse = syntax::parse(&file.bytes);
    let program = Program::new(lower(file.id, &parse, &file.bytes));
    let files = std::slice::from_ref(&file);
    let names = Names::default();
    let writer = Writer { files, names: &names };
    let mut out = String::new();
    for text in unread(&file, &parse) {
        let _ = writeln!(out, "unreadable: {}", text.words);
    }
    let mut modules: Vec<&Module> =
        program.modules.iter().filter(|module| module.span.end > 0).collect();
    modules.sort_by_key(|module| &module.name.key);
    for module in modules {
        out.push_str(&module_text(&writer, &program, module));
    }
    out
}

fn module_text(writer: &Writer<'_>, program: &Program, module: &Module) -> String {
    let mut out = format!("MODULE {}{}\n", module.name.key, attributes(module));
    let mut types: Vec<String> = module.types.iter().map(type_text).collect();
    types.sort();
    let data_line = |data: &Data| {
        if is_state(program, data) {
            format!("{}:=…", writer.declaration(data))
        } else {
            writer.data(data)
        }
    };
    let mut data: Vec<(&str, String)> =
        module.data.iter().map(|data| (data.name.key.as_str(), data_line(data))).collect();
    data.sort();
    for line in types.iter().chain(data.iter().map(|(_, line)| line)) {
        let _ = writeln!(out, "  {line};");
    }
    let mut routines: Vec<&Routine> = module.routines.iter().collect();
    routines.sort_by_key(|routine| &routine.name.key);
    for routine in routines {
        out.push('\n');
        for line in routine_text(writer, routine, &routine.name.key).lines() {
            let _ = writeln!(out, "  {line}");
        }
    }
    out.push_str("ENDMODULE\n");
    out
}

/// ` (SYSMODULE,NOVIEW)`, or nothing.
pub(super) fn attributes(module: &Module) -> String {
    let mut attributes = module.attributes.clone();
    attributes.sort();
    attributes.dedup();
    if attributes.is_empty() { String::new() } else { format!(" ({})", attributes.join(",")) }
}

/// A record with its components, or an alias.
pub(super) fn type_text(def: &TypeDef) -> String {
    match &def.kind {
        TypeDefKind::Record(parts) => {
            let parts: Vec<String> =
                parts.iter().map(|(ty, name)| format!("{} {}", ty.key, name.key)).collect();
            format!("RECORD {} {{{}}}", def.name.key, parts.join("; "))
        }
        TypeDefKind::Alias(of) => format!("ALIAS {} {}", of.key, def.name.key),
    }
}

/// A routine under a name.
pub(super) fn routine_text(writer: &Writer<'_>, routine: &Routine, name: &str) -> String {
    let mut out = format!("{} {name}\n", header(writer, routine));
    let mut data: Vec<(&str, String)> = declared::data(routine)
        .map(|data| (writer.names.of(&data.name.key), writer.data(data)))
        .collect();
    data.sort();
    for (_, line) in data {
        let _ = writeln!(out, "  {line};");
    }
    let mut interner = Interner::default();
    let mut builder = Builder::new(*writer, &mut interner);
    let nodes = builder.routine(routine);
    write_nodes(writer, &nodes, 1, &mut out);
    out.push_str("END\n");
    out
}

fn write_nodes(writer: &Writer<'_>, nodes: &[Node<'_>], depth: usize, out: &mut String) {
    for node in nodes {
        let indent = match node.label {
            Label::Statement(_) => depth,
            _ => depth.saturating_sub(1),
        };
        let end = if node.label.is_block() { "" } else { ";" };
        let _ = writeln!(out, "{}{}{end}", "  ".repeat(indent), node.label.text(writer));
        let below = if matches!(node.label, Label::Statement(_)) { depth + 1 } else { depth };
        write_nodes(writer, &node.children, below, out);
        if matches!(node.label, Label::Statement(_)) && node.label.is_block() {
            let _ = writeln!(out, "{}END{}", "  ".repeat(depth), node.label.word());
        }
    }
}

/// Scope, kind, type and parameters of a routine, without its name.
pub(super) fn header(writer: &Writer<'_>, routine: &Routine) -> String {
    let Some(file) = writer.files.get(routine.span.file.0 as usize) else { return String::new() };
    let bytes = file.slice(routine.span);
    let tokens = syntax::tokenize(bytes);
    // The words up to the name, then those of the parameters.
    let mut end = 0;
    let mut depth = 0_i32;
    for index in 0..tokens.count() {
        let kind = tokens.kind(index);
        let is_parameters = depth > 0 || kind == TokenKind::LeftParen;
        depth += match kind {
            TokenKind::LeftParen => 1,
            TokenKind::RightParen => -1,
            _ => 0,
        };
        let at_name = tokens.range(index).start + routine.span.start == routine.name.span.start;
        let is_trap = matches!(routine.kind, RoutineKind::Trap);
        if kind == TokenKind::Semicolon || kind == TokenKind::Identifier && is_trap && !at_name {
            break;
        }
        end = tokens.range(index).end;
        if is_parameters && depth <= 0 || at_name && is_trap {
            break;
        }
    }
    let start = routine.span.start;
    let name = routine.name.span;
    let part = |from: u32, to: u32| {
        let span = crate::rapid::text::Span { start: from, end: to.max(from), ..routine.span };
        words(file, span)
    };
    if name.start >= start && name.end <= start + end {
        format!("{}{}", part(start, name.start), part(name.end, start + end))
    } else {
        let params: Vec<String> = routine.params.iter().map(parameter).collect();
        format!("{}{}", scope(routine.scope), params.join(","))
    }
}

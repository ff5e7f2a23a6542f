//! Module attributes, the entry of the program, and PERS inside routines.

use super::context::{Context, Place};
use super::fault::error;
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::names::{Kind, Reach, RoutineKind};
use crate::rapid::syntax::{Node, NodeKind, Token, TokenKind};
use crate::rapid::text::Span;

/// The attributes in the order that RAPID needs.
const ORDER: [&str; 5] = ["SYSMODULE", "NOVIEW", "NOSTEPIN", "VIEWONLY", "READONLY"];

/// Attributes that exclude each other.
const EXCLUSIVE: [(&str, &str); 4] = [
    ("NOVIEW", "NOSTEPIN"),
    ("NOVIEW", "VIEWONLY"),
    ("NOVIEW", "READONLY"),
    ("VIEWONLY", "READONLY"),
];

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    for place in context.nodes() {
        if place.kind() == NodeKind::ModuleAttributes {
            attributes(place, out);
        } else if place.kind().is_routine() {
            let data = place.node.subtree().filter(|node| node.kind() == NodeKind::DataDeclaration);
            for node in data {
                persistent(place.at(node), out);
            }
        }
    }
    entry(context, out);
}

fn attributes(place: Place<'_>, out: &mut Vec<Diagnostic>) {
    let mut seen: Vec<(String, Span)> = Vec::new();
    for token in place.node.own_tokens().filter(|token| token.kind() == TokenKind::Identifier) {
        let range = token.range();
        let span = Span { start: range.start, end: range.end, ..place.span() };
        let word = String::from_utf8_lossy(token.text(&place.file.bytes)).to_uppercase();
        let rank = |word: &str| ORDER.iter().position(|known| *known == word);
        let fault = seen.iter().find_map(|(other, _)| {
            let excludes =
                |(a, b): &(&str, &str)| *a == word && *b == other || *b == word && *a == other;
            if *other == word {
                Some((format!("{word} is given twice"), "remove one".to_owned()))
            } else if EXCLUSIVE.iter().any(excludes) {
                let message = format!("{other} and {word} exclude each other");
                Some((message, format!("keep {other} or {word}")))
            } else if rank(&word) < rank(other) {
                let message = format!("{word} stands after {other}");
                Some((message, format!("the order is {}", ORDER.join(", "))))
            } else {
                None
            }
        });
        if let Some((message, help)) = fault {
            out.push(error("attributes", span, message, help));
        }
        seen.push((word, span));
    }
}

fn persistent(place: Place<'_>, out: &mut Vec<Diagnostic>) {
    let keyword = |node: Node<'_>| node.own_token(TokenKind::Pers).map(Token::range);
    if let Some(range) = keyword(place.node) {
        let span = Span { start: range.start, end: range.end, ..place.span() };
        let message = "PERS inside a routine".to_owned();
        let help = "declare it in the module, or as VAR".to_owned();
        out.push(error("data", span, message, help));
    }
}

/// The routine that starts the program has to be a PROC without parameters.
fn entry(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    let names = &context.names;
    let wanted = context.task.entry.to_lowercase();
    for id in names.modules().flat_map(|module| names.inside(module)) {
        let declaration = names.declaration(id);
        let Kind::Routine(kind) = declaration.kind else { continue };
        if names.key(id) != wanted || declaration.reach == Reach::Local {
            continue;
        }
        let name = context.name(declaration);
        if kind != RoutineKind::Proc {
            let message = format!("{name}, which starts the program, is no PROC");
            let help = "declare it as PROC".to_owned();
            out.push(error("entry", declaration.name, message, help));
        } else if let Some(parameter) = names
            .inside(id)
            .find(|inner| matches!(names.declaration(*inner).kind, Kind::Parameter(_)))
        {
            let message = format!("{name}, which starts the program, has a parameter");
            let help = "remove its parameters".to_owned();
            out.push(error("entry", names.declaration(parameter).name, message, help));
        }
    }
}

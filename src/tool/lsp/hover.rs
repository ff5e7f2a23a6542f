//! What the identifier under the pointer is, and what the statement costs.

use gen_lsp_types::{Contents, Hover, MarkupContent, MarkupKind};

use super::comment::comment_of;
use super::costs::StatementCosts;
use super::entity::{Declared, identifier, meanings};
use super::signature::{name, signature};
use super::workspace::View;
use crate::rapid::names::{Meaning, Names, Use};
use crate::rapid::text::Span;

/// Time and energy of the movement or wait at a byte, summed over its executions in a cycle, then the
/// declaration of the identifier with its comment.
pub(super) fn hover(view: View<'_>, byte: u32, costs: Option<&StatementCosts>) -> Option<Hover> {
    let mut parts: Vec<String> = costs.map(ToString::to_string).into_iter().collect();
    for (names, one) in meanings(view, byte) {
        parts.extend(described(view, names, one));
    }
    let own = || {
        let names = view.project.names_of(view.file).next()?;
        let one = identifier(names, view.file, byte)?;
        Some(Span { file: view.file, start: one.start, end: one.end })
    };
    let span = costs.map(|costs| costs.span).or_else(own)?;
    let value = parts.join("\n\n---\n\n");
    (!value.is_empty()).then(|| Hover {
        contents: Contents::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value }),
        range: Some(view.positions().range(span)),
    })
}

fn described(view: View<'_>, names: &Names, one: Use) -> Option<String> {
    match one.meaning {
        Meaning::Declared(id) => Some(declared(view, Declared { names, id })),
        Meaning::Predefined(value) => {
            let id = value.declaration?;
            let of_type = name(view.project, Declared { names, id });
            let span = Span { file: view.file, start: one.start, end: one.end };
            Some(rapid(&format!("CONST {of_type} {}", view.project.text(span))))
        }
        Meaning::Known => Some("A name of RobotWare or one of its options.".to_owned()),
        Meaning::Late | Meaning::Open | Meaning::Unknown => None,
    }
}

fn declared(view: View<'_>, one: Declared<'_>) -> String {
    let code = rapid(&signature(view.project, one).text);
    if one.names.is_predefined(one.id) {
        return code;
    }
    let whole = one.declaration().whole;
    match comment_of(view.project.module(whole.file), whole) {
        Some(comment) => format!("{code}\n\n{}", as_text(&comment)),
        None => code,
    }
}

fn rapid(code: &str) -> String {
    format!("```rapid\n{code}\n```")
}

/// The lines of a comment as Markdown in which no sign has a meaning.
pub(super) fn as_text(comment: &str) -> String {
    let mut text = String::with_capacity(comment.len());
    for sign in comment.chars() {
        match sign {
            '\n' => text.push_str("  \n"),
            '\\' | '`' | '*' | '_' | '{' | '}' | '[' | ']' | '<' | '>' | '#' | '|' | '~' => {
                text.extend(['\\', sign]);
            }
            _ => text.push(sign),
        }
    }
    text
}

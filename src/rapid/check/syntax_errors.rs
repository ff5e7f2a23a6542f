//! Syntax errors: a module with one is not loaded.

use super::context::Context;
use super::fault::{error, with_place};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::syntax::{SyntaxError, TokenKind};
use crate::rapid::text::{SourceFile, Span};

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    for source in context.task.files {
        for one in &source.parse.errors {
            let span = Span { file: source.file.id, start: one.start, end: one.end };
            let finding = error("syntax", span, one.message.clone(), help(source.file, one));
            out.push(match &one.related {
                Some(related) => {
                    let place = Span { start: related.start, end: related.end, ..span };
                    with_place(finding, place, &related.message)
                }
                None => finding,
            });
        }
    }
}

fn help(file: &SourceFile, one: &SyntaxError) -> String {
    let span = Span { file: file.id, start: one.start, end: one.end };
    let word = file.text(span);
    if one.message.starts_with("expected a name") && TokenKind::keyword(word.as_bytes()).is_some() {
        return format!("{} is a reserved word: choose another name", word.to_uppercase());
    }
    "correct it: the controller loads no module with a syntax error".to_owned()
}

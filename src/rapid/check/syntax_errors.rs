//! Syntax errors: a module with one is not loaded.

use super::context::Context;
use super::fault::{error, with_place};
use crate::rapid::diagnostics::Diagnostic;
use crate::rapid::text::Span;

const HELP: &str = "correct it: the controller loads no module with a syntax error";

pub(super) fn check(context: &Context<'_>, out: &mut Vec<Diagnostic>) {
    for source in context.task.files {
        for one in &source.parse.errors {
            let span = Span { file: source.file.id, start: one.start, end: one.end };
            let finding = error("syntax", span, one.message.clone(), HELP.to_owned());
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

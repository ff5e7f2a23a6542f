//! Other orders of visits, where a comment of the user says that the order is free.

use super::lever::{Lever, Offers, Visits};
use crate::rapid::ir::hir::Stmt;
use crate::rapid::text::{SourceFile, Span};
use crate::tool::lint::context::Context;
use crate::tool::lint::process::Kept;
use crate::tool::retrofit::comments;

/// The comments before the first visit and behind the last one.
const BEGIN: &[u8] = b"joulepath: free order";
const END: &[u8] = b"joulepath: end of free order";

/// The marked statements.
pub(super) fn levers(context: &Context<'_>) -> Vec<Lever> {
    context.files.iter().flat_map(|file| of_file(context, file)).collect()
}

fn of_file(context: &Context<'_>, file: &SourceFile) -> Vec<Lever> {
    let ends = comments(file, END);
    let range = |begin: u32| Some((begin, *ends.iter().find(|end| **end > begin)?));
    let ranges = comments(file, BEGIN).into_iter().filter_map(range);
    ranges.filter_map(|range| lever(context, file, range)).collect()
}

fn lever(context: &Context<'_>, file: &SourceFile, (begin, end): (u32, u32)) -> Option<Lever> {
    let line = |at: u32| file.position(at).line;
    let is_between =
        |span: Span| span.file == file.id && line(span.start) > begin && line(span.end) < end;
    let all = context.program.routines().flat_map(|(_, routine)| routine.statements());
    let mut spans: Vec<Span> = Vec::new();
    for Stmt { span, .. } in all.filter(|stmt| is_between(stmt.span)) {
        // A statement in a block belongs to the visit of the block.
        if spans.last().is_none_or(|last| span.start >= last.end) {
            spans.push(*span);
        }
    }
    let texts: Vec<String> = spans.iter().map(|span| file.text(*span).trim().to_owned()).collect();
    let whole = Span { end: spans.last()?.end, ..*spans.first()? };
    (spans.len() > 1).then_some(Lever {
        span: whole,
        risk: "outputs and waits come in another order",
        kept: Kept::Work,
        offers: Offers::Order(Visits { spans, texts }),
    })
}

//! Other orders of visits, where a comment of the user says that the order is free.

use super::lever::{Lever, Offers, Visits};
use crate::rapid::ir::hir::{Stmt, StmtKind};
use crate::rapid::text::{SourceFile, Span};
use crate::tool::lint::context::Context;
use crate::tool::lint::process::Kept;
use crate::tool::retrofit::comments;

/// The comments before the first visit and behind the last one.
const BEGIN: &str = "joulepath: free order";
const END: &str = "joulepath: end of free order";

/// The marked statements, and what is wrong with marks that cannot be used.
pub(super) fn levers(context: &Context<'_>) -> (Vec<Lever>, Vec<String>) {
    let mut levers = Vec::new();
    let mut faults = Vec::new();
    for file in context.files {
        let [begins, ends] = [BEGIN, END].map(|mark| comments(file, mark.as_bytes()));
        let mut marks: Vec<(u32, bool)> = begins.iter().map(|line| (*line, true)).collect();
        marks.extend(ends.iter().map(|line| (*line, false)));
        marks.sort_unstable();
        let mut open = None;
        let mut fault =
            |line: u32, what: &str| faults.push(format!("{}:{line}: {what}", file.path));
        for (line, is_begin) in marks {
            match (open, is_begin) {
                (None, true) => open = Some(line),
                (None, false) => fault(line, "no free order begins before this end"),
                (Some(first), true) => {
                    fault(line, &format!("the free order of line {first} has not ended"));
                }
                (Some(first), false) => {
                    open = None;
                    match visits(context, file, (first, line)) {
                        Ok(visits) => levers.push(lever(file, visits)),
                        Err(why) => fault(first, why),
                    }
                }
            }
        }
        if let Some(first) = open {
            fault(
                first,
                "this free order has no end: write ! joulepath: end of free order behind it",
            );
        }
    }
    (levers, faults)
}

fn lever(file: &SourceFile, spans: Vec<Span>) -> Lever {
    let texts = spans.iter().map(|span| file.text(*span).trim().to_owned()).collect();
    let (first, last) = (spans[0], spans[spans.len() - 1]);
    Lever {
        span: Span { end: last.end, ..first },
        risk: "the visits come in another order",
        kept: Kept::Work,
        offers: Offers::Order(Visits { spans, texts }),
    }
}

/// The statements between two lines, or why they are no visits.
fn visits(
    context: &Context<'_>,
    file: &SourceFile,
    (begin, end): (u32, u32),
) -> Result<Vec<Span>, &'static str> {
    let line = |at: u32| file.position(at).line;
    let is_between =
        |span: Span| span.file == file.id && line(span.start) > begin && line(span.end) < end;
    let mut found: Vec<Vec<&Stmt>> = Vec::new();
    let mut open: Vec<&[Stmt]> = Vec::new();
    for (_, routine) in context.program.routines() {
        open.extend(routine.blocks().map(Vec::as_slice));
    }
    while let Some(block) = open.pop() {
        let own: Vec<&Stmt> = block.iter().filter(|stmt| is_between(stmt.span)).collect();
        if !own.is_empty() {
            found.push(own);
        }
        let outside = block.iter().filter(|stmt| !is_between(stmt.span));
        open.extend(outside.flat_map(|stmt| stmt.kind.blocks()).map(Vec::as_slice));
    }
    match found.as_slice() {
        [] => Err("no statement stands in this free order"),
        [own] if own.len() == 1 => Err("this free order has one statement only"),
        [own] if own.iter().any(|stmt| !matches!(stmt.kind, StmtKind::Call(_))) => Err(
            "a free order may only have calls of procedures and instructions: put each visit into a procedure",
        ),
        [own] => Ok(own.iter().map(|stmt| stmt.span).collect()),
        _ => Err("begin and end of this free order stand in different blocks"),
    }
}

//! Removes the streams from a retrofitted program: the original text with its current data.
//!
//! A retrofit only inserts text; the names of its module identify the insertions.

use memchr::memmem;

use crate::rapid::ir::hir::{Block, Callee, Expr, ExprKind, Routine, Stmt, StmtKind};
use crate::rapid::ir::lower;
use crate::rapid::syntax;
use crate::rapid::text::{Edit, SourceFile, Span, apply};
use crate::tool::emit::EDIT_REMARKS;

/// Text in the header of each module of streams.
const HEAD: &[u8] = b"! Joint streams, written by joulepath";
/// The declaration that follows the prefix.
const COUNTERS: &[u8] = b"ByStream{";

/// Whether a file is a module of streams.
pub fn is_streams(bytes: &[u8]) -> bool {
    memmem::find(bytes, HEAD).is_some()
}

/// The name prefix of a module of streams; `None` for a continuation module.
pub fn prefix(bytes: &[u8]) -> Option<String> {
    let end = memmem::find(bytes, COUNTERS)?;
    let is_word = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_';
    let length = bytes[..end].iter().rev().take_while(|b| is_word(b)).count();
    String::from_utf8(bytes[end - length..end].to_vec()).ok()
}

/// The bytes of a file without the guards and records of the module with this prefix.
pub fn without_streams(file: &SourceFile, prefix: &str) -> Vec<u8> {
    let parse = syntax::parse(&file.bytes);
    let prefix = prefix.to_lowercase();
    let mut remover = StreamRemover { bytes: &file.bytes, prefix, edits: Vec::new() };
    for module in lower(file.id, &parse, &file.bytes) {
        for block in module.routines.iter().flat_map(Routine::blocks) {
            remover.block(block);
        }
    }
    apply(&file.bytes, &remover.edits).unwrap_or_else(|_| file.bytes.clone())
}

struct StreamRemover<'a> {
    bytes: &'a [u8],
    prefix: String,
    edits: Vec<Edit>,
}

impl StreamRemover<'_> {
    fn block(&mut self, block: &Block) {
        for stmt in block {
            match &stmt.kind {
                StmtKind::If { branches, otherwise } => match (branches.as_slice(), otherwise) {
                    ([(condition, _)], Some(original)) if self.is_guard(condition) => {
                        self.guard(stmt, original);
                        continue;
                    }
                    ([(condition, body)], None) => self.compact(stmt, condition, body),
                    _ => {}
                },
                _ if self.records(stmt) => self.note(stmt.span),
                _ if self.makes_up(stmt) => self.made_up_for(stmt.span),
                _ => {}
            }
            for inner in stmt.kind.blocks() {
                self.block(inner);
            }
        }
    }

    /// Whether an expression is a name of the module of streams.
    fn is_own(&self, expr: &Expr) -> bool {
        matches!(&expr.kind, ExprKind::Ref(name) if name.key.starts_with(&self.prefix))
    }

    fn is_guard(&self, condition: &Expr) -> bool {
        let ExprKind::Call(name, _) = &condition.kind else { return false };
        let rest = name.key.strip_prefix(&self.prefix).and_then(|rest| rest.strip_prefix("fits"));
        rest.is_some_and(|number| number.parse::<usize>().is_ok())
    }

    /// Whether a statement records a load or setting.
    fn records(&self, stmt: &Stmt) -> bool {
        matches!(&stmt.kind, StmtKind::Assign { target, .. } if self.is_own(target))
    }

    /// Whether a statement makes up for movements that were put off.
    fn makes_up(&self, stmt: &Stmt) -> bool {
        let StmtKind::Call(call) = &stmt.kind else { return false };
        let Callee::Name(name) = &call.callee else { return false };
        name.key.strip_prefix(&self.prefix) == Some("back")
    }

    /// Deletes such a call, with the blanks up to the next statement.
    fn made_up_for(&mut self, span: Span) {
        let rest = &self.bytes[span.end as usize..];
        let blanks = rest.iter().take_while(|b| b.is_ascii_whitespace()).count();
        self.delete(span, span.start as usize, span.end as usize + blanks);
    }

    /// Deletes a guard: the text through the line of ELSE, and ENDIF with its line.
    fn guard(&mut self, stmt: &Stmt, original: &Block) {
        let (Some(first), Some(last)) = (original.first(), original.last()) else { return };
        let head = &self.bytes[stmt.span.start as usize..first.span.start as usize];
        let Some(at) = head.windows(4).rposition(|word| word.eq_ignore_ascii_case(b"else")) else {
            return;
        };
        let mut end = stmt.span.start as usize + at + 4;
        let has = |remark: &&&str| self.bytes[end..].starts_with(remark.as_bytes());
        end += EDIT_REMARKS.iter().find(has).map_or(0, |remark| remark.len());
        let is_end = |b: &u8| matches!(b, b'\r' | b'\n');
        let is_blank = |b: &u8| matches!(b, b' ' | b'\t');
        let eol = match &self.bytes[end..] {
            [b'\r', b'\n', ..] => 2,
            rest => rest.iter().take(1).filter(|b| is_end(b)).count(),
        };
        end += eol;
        end += self.bytes[end..].iter().take_while(|b| is_blank(b)).count();
        self.delete(stmt.span, stmt.span.start as usize, end);
        let endif = stmt.span.end as usize - b"ENDIF".len();
        let tail = &self.bytes[last.span.end as usize..endif];
        let space = tail.iter().rev().take_while(|b| is_blank(b)).count();
        let eol = match &tail[..tail.len() - space] {
            [.., b'\r', b'\n'] => 2,
            rest => rest.iter().rev().take(1).filter(|b| is_end(b)).count(),
        };
        self.delete(stmt.span, endif - space - eol, stmt.span.end as usize);
        self.block(original);
    }

    /// Deletes a record of a load or setting, with the space before it.
    fn note(&mut self, span: Span) {
        let start = span.start as usize;
        let space = usize::from(start > 0 && self.bytes[start - 1] == b' ');
        self.delete(span, start - space, span.end as usize);
    }

    /// Restores a compact IF that became a block for an inserted statement.
    fn compact(&mut self, stmt: &Stmt, condition: &Expr, body: &Block) {
        let start = condition.span.end as usize;
        let after_condition = start..start + b" THEN".len();
        let (then, last) = match body.as_slice() {
            // THEN is behind the condition.
            [_, record] if self.records(record) => (after_condition, record),
            [back, _, record] if self.makes_up(back) && self.records(record) => {
                (after_condition, record)
            }
            // THEN is before the inserted call.
            [back, last] if self.makes_up(back) => {
                let end = back.span.start as usize;
                (end - b"THEN ".len()..end, last)
            }
            _ => return,
        };
        let (begin, end) = (last.span.end as usize, stmt.span.end as usize);
        let has_then = self.bytes.get(then.clone()).is_some_and(|it| it.trim_ascii() == b"THEN");
        let in_line = !self.bytes[then.start..end].iter().any(|b| matches!(b, b'\r' | b'\n'));
        if has_then && in_line && self.bytes[begin..end] == *b" ENDIF" {
            self.delete(stmt.span, then.start, then.end);
            self.delete(stmt.span, begin, end);
        }
    }

    fn delete(&mut self, of: Span, start: usize, end: usize) {
        let span = Span { start: start as u32, end: end as u32, ..of };
        self.edits.push(Edit { span, text: Vec::new() });
    }
}

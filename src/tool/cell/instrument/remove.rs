//! Takes a recorder out of a program: the original bytes.

use memchr::memmem;

use super::insert::line_start;
use crate::rapid::ir::hir::{Callee, Routine, StmtKind};
use crate::rapid::ir::lower;
use crate::rapid::syntax;
use crate::rapid::text::{Edit, SourceFile, Span, apply};

/// Text in the head of each module of a recorder.
const HEAD: &[u8] = b"! Recorder, written by joulepath";
/// The declaration that follows the prefix of its names.
const FIRST: &[u8] = b"Program:=\"";
/// Calls that stand before a statement, and those that stand behind one, without the prefix.
const BEFORE: [&str; 3] = ["cycle", "move", "wait"];
const BEHIND: [&str; 4] = ["done", "end", "out", "load"];

/// Whether a file is the module of a recorder.
pub fn is_recorder(bytes: &[u8]) -> bool {
    memmem::find(bytes, HEAD).is_some()
}

/// The prefix of the names of a recorder's module.
pub fn recorder_prefix(bytes: &[u8]) -> Option<String> {
    let end = memmem::find(bytes, FIRST)?;
    let is_word = |byte: &&u8| byte.is_ascii_alphanumeric() || **byte == b'_';
    let length = bytes[..end].iter().rev().take_while(is_word).count();
    String::from_utf8(bytes[end - length..end].to_vec()).ok()
}

/// The hash of the program into which a recorder was put, from its module.
pub fn recorded_program(bytes: &[u8]) -> Option<String> {
    let rest = &bytes[memmem::find(bytes, FIRST)? + FIRST.len()..];
    let end = memchr::memchr(b'"', rest)?;
    String::from_utf8(rest[..end].to_vec()).ok()
}

/// The bytes of a file without the calls of the recorder with this prefix.
pub fn without_recorder(file: &SourceFile, prefix: &str) -> Vec<u8> {
    let parse = syntax::parse(&file.bytes);
    let prefix = prefix.to_lowercase();
    let mut edits = Vec::new();
    for module in lower(file.id, &parse, &file.bytes) {
        for stmt in module.routines.iter().flat_map(Routine::statements) {
            let StmtKind::Call(call) = &stmt.kind else { continue };
            let Callee::Name(name) = &call.callee else { continue };
            let Some(rest) = name.key.strip_prefix(&prefix) else { continue };
            if BEFORE.contains(&rest) || BEHIND.contains(&rest) {
                let is_before = BEFORE.contains(&rest);
                edits.push(Edit { span: removed(file, stmt.span, is_before), text: Vec::new() });
            }
        }
    }
    apply(&file.bytes, &edits).unwrap_or_else(|_| file.bytes.clone())
}

/// What an insertion covers: the whole line, or the call and the blank on its side.
fn removed(file: &SourceFile, span: Span, is_before: bool) -> Span {
    let (start, end) = (span.start as usize, span.end as usize);
    let line = line_start(&file.bytes, start);
    let rest = &file.bytes[end..];
    let is_alone = file.bytes[line..start].iter().all(|byte| matches!(byte, b' ' | b'\t'));
    let end_of_line = match rest {
        [b'\r', b'\n', ..] => 2,
        [b'\n' | b'\r', ..] => 1,
        _ => 0,
    };
    let (start, end) = if is_alone && end_of_line > 0 {
        (line, end + end_of_line)
    } else if is_before {
        (start, end + usize::from(rest.first() == Some(&b' ')))
    } else {
        (start - usize::from(start > 0 && file.bytes[start - 1] == b' '), end)
    };
    Span { start: start as u32, end: end as u32, ..span }
}

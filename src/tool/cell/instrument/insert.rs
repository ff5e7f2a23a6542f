//! The insertions of a recorder's calls.

use crate::rapid::text::{Edit, SourceFile, Span};
use crate::tool::emit::end_of_line;

/// The insertion of a call before a statement.
pub(super) fn before(file: &SourceFile, span: Span, call: &str) -> Edit {
    let start = span.start as usize;
    let line = line_start(&file.bytes, start);
    let blank = &file.bytes[line..start];
    if blank.iter().all(|byte| matches!(byte, b' ' | b'\t')) {
        let indent = String::from_utf8_lossy(blank);
        return inserted(span, line, format!("{indent}{call};{}", end_of_line(&file.bytes)));
    }
    inserted(span, start, format!("{call}; "))
}

/// The insertion of a call behind a statement.
pub(super) fn behind(file: &SourceFile, span: Span, call: &str) -> Edit {
    let end = span.end as usize;
    let rest = &file.bytes[end..];
    let length = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
    let text = rest[..length.unwrap_or(rest.len())].trim_ascii_start();
    let ends_line = text.is_empty() || text.starts_with(b"!");
    if let Some(length) = length.filter(|_| ends_line) {
        let next = end + length + if rest[length..].starts_with(b"\r\n") { 2 } else { 1 };
        let first = line_start(&file.bytes, span.start as usize);
        let blank = file.bytes[first..].iter().take_while(|byte| matches!(byte, b' ' | b'\t'));
        let indent: String = blank.map(|byte| char::from(*byte)).collect();
        return inserted(span, next, format!("{indent}{call};{}", end_of_line(&file.bytes)));
    }
    inserted(span, end, format!(" {call};"))
}

/// The beginning of the line with a byte.
pub(super) fn line_start(bytes: &[u8], at: usize) -> usize {
    bytes[..at].iter().rposition(|byte| matches!(byte, b'\n' | b'\r')).map_or(0, |i| i + 1)
}

fn inserted(span: Span, at: usize, text: String) -> Edit {
    let at = at as u32;
    Edit { span: Span { start: at, end: at, ..span }, text: text.into_bytes() }
}

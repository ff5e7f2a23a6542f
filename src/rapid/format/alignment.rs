//! Comments behind statements.
//!
//! Such a comment follows after one blank. Comments on lines that follow each other stay aligned if
//! they were: the longest of these lines has one blank before its comment.

/// A comment behind a statement.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trailing {
    /// Number of the white space before it.
    pub(super) gap: usize,
    /// Formatted line.
    pub(super) line: usize,
    /// Width of the formatted text before the white space, in characters.
    pub(super) code: usize,
    /// Column that it had.
    pub(super) from: u32,
}

/// The number of blanks before each comment, by the number of the white space.
pub(super) fn align(comments: &[Trailing]) -> Vec<(usize, usize)> {
    let mut found = Vec::with_capacity(comments.len());
    let is_next = |a: &Trailing, b: &Trailing| b.line == a.line + 1 && b.from == a.from;
    for group in comments.chunk_by(is_next) {
        let widest = group.iter().map(|comment| comment.code).max().unwrap_or(0);
        found.extend(group.iter().map(|comment| (comment.gap, widest + 1 - comment.code)));
    }
    found
}

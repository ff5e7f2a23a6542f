//! The comment of a declaration.

use super::module::Module;
use super::tokens::token_at;
use crate::rapid::syntax::TokenKind;
use crate::rapid::text::Span;

/// The text of the comment lines directly above a declaration, or of the comment behind it.
pub(super) fn comment_of(module: &Module, whole: Span) -> Option<String> {
    let tokens = module.parse().tree.tokens();
    let first = token_at(tokens, whole.start);
    let line = |byte: u32| module.file.position(byte).line;
    let mut lines = Vec::new();
    let mut below = line(whole.start);
    for index in (0..first).rev() {
        let range = tokens.range(index);
        match tokens.kind(index) {
            TokenKind::Whitespace => {}
            TokenKind::Comment if line(range.start) + 1 == below => {
                below = line(range.start);
                lines.push(Span { file: whole.file, start: range.start, end: range.end });
            }
            // What stands before a comment on its line has it.
            _ => {
                if line(range.end) == below && !lines.is_empty() {
                    lines.pop();
                }
                break;
            }
        }
    }
    lines.reverse();
    if lines.is_empty() {
        let last = token_at(tokens, whole.end.saturating_sub(1));
        let behind =
            (last + 1..tokens.count()).find(|one| tokens.kind(*one) != TokenKind::Whitespace);
        let range = behind.filter(|one| tokens.kind(*one) == TokenKind::Comment);
        let range = range.map(|one| tokens.range(one));
        let same_line = |range: &std::ops::Range<u32>| {
            line(range.start) == line(whole.end) && line(whole.start) == line(whole.end)
        };
        let range = range.filter(same_line)?;
        lines.push(Span { file: whole.file, start: range.start, end: range.end });
    }
    let text = |span: Span| {
        let text = module.file.text(span);
        text.trim_start_matches('!').trim().to_owned()
    };
    // Lines of stars and dashes are frames.
    let worded = |line: &String| line.chars().any(char::is_alphanumeric);
    let words: Vec<String> = lines.into_iter().map(text).filter(worded).collect();
    (!words.is_empty()).then(|| words.join("\n"))
}

//! Movements and waits that a comment of the user makes free.

use crate::rapid::builtins::is_movement;
use crate::rapid::syntax::{self, NodeKind, TokenKind};
use crate::rapid::text::{SourceFile, Span};

/// Text of the comment without `!` and white space.
const MARK: &[u8] = b"joulepath: free";

/// The movement and wait statements that have the comment on their last line.
pub fn freed(file: &SourceFile) -> Vec<Span> {
    let marks = comments(file, MARK);
    if marks.is_empty() {
        return Vec::new();
    }
    let parse = syntax::parse(&file.bytes);
    let calls = parse.tree.nodes().filter(|node| node.kind() == NodeKind::CallStatement);
    let free = calls.filter(|node| {
        let name = node.callee().map(|name| String::from_utf8_lossy(name.text(&file.bytes)));
        name.is_some_and(|name| is_movement(&name) || name.eq_ignore_ascii_case("WaitTime"))
    });
    free.map(|node| Span { file: file.id, start: node.range().start, end: node.range().end })
        .filter(|span| marks.contains(&file.position(span.end).line))
        .collect()
}

/// The lines with a comment of this text in lower case, without `!` and white space.
pub(in crate::tool) fn comments(file: &SourceFile, text: &[u8]) -> Vec<u32> {
    if memchr::memmem::find(&file.bytes.to_ascii_lowercase(), text).is_none() {
        return Vec::new();
    }
    let parse = syntax::parse(&file.bytes);
    let tokens = parse.tree.root().all_tokens();
    let is_it = |comment: &[u8]| {
        comment.get(1..).unwrap_or_default().trim_ascii().eq_ignore_ascii_case(text)
    };
    tokens
        .filter(|token| token.kind() == TokenKind::Comment && is_it(token.text(&file.bytes)))
        .map(|token| file.position(token.range().start).line)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::text::FileId;

    #[test]
    fn only_movements_and_waits_on_a_line_with_the_comment_are_free() {
        let text = "MODULE m\nPROC a()\nMoveL p,v1,fine,t; ! joulepath: free\n\
                    MoveL p,v1,fine,t;\nStop; ! joulepath: free\n\
                    MoveC p,\n  q,v1,fine,t; !joulepath: free\n\
                    TPWrite \"! joulepath: free\"; WaitTime 2; ! joulepath: free\nENDPROC\nENDMODULE\n";
        let file = SourceFile::new(FileId(0), "m.mod".into(), text.into());
        let spans = freed(&file);
        let found: Vec<_> = spans.iter().map(|span| file.text(*span)).collect();
        assert_eq!(found, ["MoveL p,v1,fine,t;", "MoveC p,\n  q,v1,fine,t;", "WaitTime 2;"]);
    }
}

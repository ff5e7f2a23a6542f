//! Text that the parser cannot read: it is compared word by word.

use super::number;
use crate::rapid::syntax::{self, Node, NodeKind, Parse, TokenKind};
use crate::rapid::text::{SourceFile, Span};

/// Text outside of statements and declarations.
#[derive(Clone, Debug)]
pub(super) struct Unread {
    pub(super) span: Span,
    /// Its words, separated by blanks.
    pub(super) words: String,
}

/// The text of a file that belongs to no statement and no declaration.
pub(super) fn unread(file: &SourceFile, parse: &Parse) -> Vec<Unread> {
    let mut found = Vec::new();
    collect(file, parse.tree.root(), &mut found);
    found
}

fn collect(file: &SourceFile, node: Node<'_>, found: &mut Vec<Unread>) {
    for child in node.children() {
        match child.kind() {
            NodeKind::Error | NodeKind::OutsideText | NodeKind::EncodedModule => {
                let range = child.range();
                let span = Span { file: file.id, start: range.start, end: range.end };
                let words = words(file, span);
                if !words.is_empty() {
                    found.push(Unread { span, words });
                }
            }
            NodeKind::Module | NodeKind::RecordDeclaration => collect(file, child, found),
            kind if kind.is_routine() => {
                // A header with an error is compared as words, statements stand in blocks.
                let is_between = |inner: &Node<'_>| inner.kind() == NodeKind::Error;
                for inner in child.children().filter(is_between) {
                    let range = inner.range();
                    let span = Span { file: file.id, start: range.start, end: range.end };
                    let words = words(file, span);
                    if !words.is_empty() {
                        found.push(Unread { span, words });
                    }
                }
            }
            _ => {}
        }
    }
}

/// The words of a span: keywords in upper case, names in lower case, numbers without their form.
pub(super) fn words(file: &SourceFile, span: Span) -> String {
    let bytes = file.slice(span);
    let tokens = syntax::tokenize(bytes);
    let mut words: Vec<String> = Vec::new();
    for index in 0..tokens.count() {
        let range = tokens.range(index);
        let text = file.charset.decode(&bytes[range.start as usize..range.end as usize]);
        match tokens.kind(index) {
            kind if kind.is_trivia() => {}
            kind if kind.is_keyword() => words.push(kind.describe().to_owned()),
            TokenKind::Identifier => words.push(text.to_lowercase()),
            TokenKind::Number => {
                words.push(text.parse().map_or_else(|_| text.to_lowercase(), number::coarse));
            }
            _ => words.push(text.into_owned()),
        }
    }
    words.join(" ")
}

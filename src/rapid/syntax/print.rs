//! The tree as indented text.

use std::fmt;

use super::token::TokenKind;
use super::tree::{Element, Node, Token, Tree};
use crate::rapid::text::{self, Charset};

/// Displays a tree: one line for each node and each token that is not trivia.
#[derive(Clone, Copy, Debug)]
pub struct Dump<'a> {
    tree: &'a Tree,
    bytes: &'a [u8],
    charset: Charset,
}

/// The display of the tree of `bytes`.
#[must_use]
pub fn dump<'a>(tree: &'a Tree, bytes: &'a [u8]) -> Dump<'a> {
    Dump { tree, bytes, charset: text::charset(bytes) }
}

impl fmt::Display for Dump<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write_node(f, self.tree.root(), 0)
    }
}

impl Dump<'_> {
    // The depth of a tree is limited by the parser.
    fn write_node(&self, f: &mut fmt::Formatter<'_>, node: Node<'_>, depth: usize) -> fmt::Result {
        let range = node.range();
        let indent = "  ".repeat(depth);
        write!(f, "{indent}{}@{}..{}", node.kind().production(), range.start, range.end)?;
        let mut own = node.own_tokens();
        if let (Some(only), None, None) = (own.next(), own.next(), node.children().next()) {
            return writeln!(f, " {}", self.excerpt(only));
        }
        writeln!(f)?;
        for element in node.elements() {
            match element {
                Element::Node(child) => self.write_node(f, child, depth + 1)?,
                Element::Token(token) if token.kind().is_trivia() => {}
                Element::Token(token) => writeln!(f, "{indent}  {}", self.excerpt(token))?,
            }
        }
        Ok(())
    }

    /// The text of a token, quoted.
    fn excerpt(&self, token: Token<'_>) -> String {
        if token.kind() == TokenKind::Encoded {
            return "(encoded)".to_owned();
        }
        format!("{:?}", self.charset.decode(token.text(self.bytes)))
    }
}

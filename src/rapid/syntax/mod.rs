//! RAPID's syntax: bytes → tokens → a lossless tree. Never fails, loses no byte.
//!
//! The productions of `grammar/` are the node kinds of the tree, one to one;
//! `parser` has a file for each file of the grammar.

pub mod ast;
mod error;
mod lexer;
mod node;
mod parser;
mod print;
mod token;
mod tolerance;
mod tree;

pub use error::{Related, SyntaxError};
pub use lexer::tokenize;
pub use node::NodeKind;
pub use print::{Dump, dump};
pub use token::{KEYWORDS, TokenKind, Tokens};
pub use tolerance::{Tolerance, Tolerated};
pub use tree::{Element, Node, Token, Tree};

/// Deepest nesting of statements and of brackets that is read; what is deeper
/// is one error and becomes one [`NodeKind::Error`].
pub const MAX_DEPTH: u32 = 200;

/// Most levels of the tree of one expression, long chains of operators
/// included.
pub const MAX_EXPRESSION_HEIGHT: u32 = 500;

/// What was read from one file.
#[derive(Clone, Debug)]
pub struct Parse {
    /// The whole file.
    pub tree: Tree,
    /// Errors in the order of the file.
    pub errors: Vec<SyntaxError>,
    /// Deviations from the strict grammar that controllers or their users
    /// produce and that are accepted, in the order of the file.
    pub tolerances: Vec<Tolerated>,
    /// Tokens that the parser looked at, repeated looks counted: its work,
    /// which grows linearly with the file.
    pub steps: u64,
}

/// Parses a file. Any bytes give a tree whose tokens joined are those bytes.
///
/// Offsets are `u32`: of a file of 4 GiB or more the tail is one token that no
/// production claims, and an error says so.
#[must_use]
pub fn parse(bytes: &[u8]) -> Parse {
    parser::parse(bytes)
}

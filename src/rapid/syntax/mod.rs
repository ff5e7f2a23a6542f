//! RAPID's syntax: bytes → tokens → a lossless tree. Never fails, loses no byte.
//!
//! The productions of `grammar/` are the node kinds of the tree, one to one;
//! `parser` has a file for each file of the grammar.

pub mod ast;
mod error;
mod lexer;
mod node;
mod parsed;
mod parser;
mod print;
mod token;
mod tolerance;
mod tree;

pub use error::{Related, SyntaxError};
pub use lexer::tokenize;
pub use node::NodeKind;
pub use parsed::{MAX_DEPTH, MAX_EXPRESSION_HEIGHT, Parse};
pub use parser::parse;
pub use print::{Dump, dump};
pub use token::{KEYWORDS, TokenKind, Tokens};
pub use tolerance::{Tolerance, Tolerated};
pub use tree::{Element, Node, Token, Tree};

//! Syntax of RAPID: from bytes to tokens to a lossless tree, for any input.
//!
//! The node kinds of the tree are the productions of `grammar/`, one to one; `parser` has one
//! file for each file of the grammar.

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

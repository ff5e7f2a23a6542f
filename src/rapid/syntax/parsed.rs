//! The result of parsing, and its limits.

use super::error::SyntaxError;
use super::tolerance::Tolerated;
use super::tree::Tree;

/// Deepest nesting of statements and brackets that is parsed; deeper text becomes one error node.
pub const MAX_DEPTH: u32 = 200;

/// Largest number of tree levels of one expression, including long chains of operators.
pub const MAX_EXPRESSION_HEIGHT: u32 = 500;

/// The result of parsing one file.
#[derive(Clone, Debug)]
pub struct Parse {
    /// The whole file.
    pub tree: Tree,
    /// Errors in the order of the file.
    pub errors: Vec<SyntaxError>,
    /// Accepted deviations from the strict grammar, in the order of the file.
    pub tolerances: Vec<Tolerated>,
    /// Number of token visits by the parser, repetitions included; linear in the size of the file.
    pub steps: u64,
}

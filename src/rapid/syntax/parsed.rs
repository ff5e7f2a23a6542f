//! The result of parsing, and its limits.

use super::error::SyntaxError;
use super::tolerance::Tolerated;
use super::tree::Tree;

/// Deepest nesting of statements and of brackets that is read; what is deeper
/// is one error and becomes one error node.
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

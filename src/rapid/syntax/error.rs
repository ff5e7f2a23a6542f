//! Syntax errors.

/// A violation of the syntax of RAPID.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxError {
    /// First byte; for a missing element, the place where it is expected.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
    /// What was expected and what was found.
    pub message: String,
    /// Another place that explains the error.
    pub related: Option<Related>,
}

/// A place that explains an error, such as an `IF` without its `ENDIF`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Related {
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
    /// Its relation to the error.
    pub message: String,
}

//! Syntax errors.

/// Something that RAPID does not allow.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxError {
    /// First byte; for something missing, the place where it should stand.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
    /// What was expected and what is there.
    pub message: String,
    /// Another place that explains the error.
    pub related: Option<Related>,
}

/// A place that explains an error, such as the `IF` that is never closed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Related {
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
    /// What it has to do with the error.
    pub message: String,
}

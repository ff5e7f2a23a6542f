//! A message about a place in the source.

use crate::rapid::text::Span;

/// The severity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Information.
    Info,
    /// The program should be changed.
    Warning,
    /// The program cannot be used.
    Error,
}

/// A message about a place in the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The place.
    pub span: Span,
    /// The severity.
    pub severity: Severity,
    /// Code of the rule that reports it, if any.
    pub code: Option<String>,
    /// The text: lower case, no full stop.
    pub message: String,
    /// The text beside the place.
    pub label: Option<String>,
    /// Further places.
    pub labels: Vec<Label>,
    /// Further messages without a place.
    pub notes: Vec<Note>,
}

/// A further place that explains a diagnostic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// The text beside it.
    pub message: String,
}

/// A message below the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Note {
    /// Additional information.
    Note(String),
    /// A proposed solution.
    Help(String),
}

impl Diagnostic {
    /// An error with only a message.
    #[must_use]
    pub fn error(span: Span, message: String) -> Diagnostic {
        Diagnostic {
            span,
            severity: Severity::Error,
            code: None,
            message,
            label: None,
            labels: Vec::new(),
            notes: Vec::new(),
        }
    }
}

impl Severity {
    /// Its name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Severity::Info => "info",
            Severity::Warning => "warning",
            Severity::Error => "error",
        }
    }
}

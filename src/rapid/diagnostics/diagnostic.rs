//! A remark about a place in the source.

use crate::rapid::text::Span;

/// How much it matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Info,
    /// Should be changed.
    Warning,
    /// Cannot be used as it is.
    Error,
}

/// A remark about a place in the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The place.
    pub span: Span,
    /// How much it matters.
    pub severity: Severity,
    /// Code of the rule it comes from, if from one.
    pub code: Option<String>,
    /// What is said: lower case, no full stop.
    pub message: String,
    /// What is said about the place itself, beside it.
    pub label: Option<String>,
    /// Further places.
    pub labels: Vec<Label>,
    /// Further remarks without a place.
    pub notes: Vec<Note>,
}

/// A further place that explains a diagnostic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// What is said about it.
    pub message: String,
}

/// A remark below the source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Note {
    /// A circumstance.
    Note(String),
    /// A way out.
    Help(String),
}

impl Diagnostic {
    /// An error with nothing but its message.
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

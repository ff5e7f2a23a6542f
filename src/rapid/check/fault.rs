//! Makes findings.

use crate::rapid::diagnostics::{Diagnostic, Label, Note, Severity};
use crate::rapid::text::Span;

/// What prevents the program from being loaded or stops it at once. `help` tells the way out.
pub(super) fn error(code: &str, span: Span, message: String, help: String) -> Diagnostic {
    let mut diagnostic = Diagnostic::error(span, message);
    diagnostic.code = Some(code.to_owned());
    diagnostic.notes.push(Note::Help(help));
    diagnostic
}

/// What is probably not meant, or may be declared elsewhere.
pub(super) fn warning(code: &str, span: Span, message: String, help: String) -> Diagnostic {
    Diagnostic { severity: Severity::Warning, ..error(code, span, message, help) }
}

/// The finding with another place that explains it.
pub(super) fn with_place(mut finding: Diagnostic, span: Span, message: &str) -> Diagnostic {
    finding.labels.push(Label { span, message: message.to_owned() });
    finding
}

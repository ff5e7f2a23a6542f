//! One line per diagnostic.

use super::diagnostic::Diagnostic;
use crate::rapid::text::SourceFile;

/// `path:line:column: severity[code]: message`, without a line end.
#[must_use]
pub fn concise(diagnostic: &Diagnostic, file: &SourceFile) -> String {
    let position = file.position(diagnostic.span.start);
    let code = diagnostic.code.as_ref().map(|code| format!("[{code}]")).unwrap_or_default();
    format!(
        "{}:{}:{}: {}{code}: {}",
        file.path,
        position.line,
        position.column,
        diagnostic.severity.name(),
        diagnostic.message
    )
}

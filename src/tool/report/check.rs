//! What would keep a program from being loaded, as text and JSON.

use std::fmt::Write as _;

use serde_json::{Value, json};

use crate::rapid::diagnostics::{self, Diagnostic, Note, Paint, Severity};
use crate::rapid::text::SourceFile;

/// Each finding with its source, separated by empty lines.
#[must_use]
pub fn full(findings: &[Diagnostic], files: &[SourceFile], paint: Paint) -> String {
    let shown = findings.iter().map(|finding| {
        let file = &files[finding.span.file.0 as usize];
        let mut shown = finding.clone();
        let elsewhere = finding.labels.iter().filter(|label| label.span.file != file.id);
        shown.notes.extend(elsewhere.map(|label| {
            let other = &files[label.span.file.0 as usize];
            let line = other.position(label.span.start).line;
            Note::Note(format!("{}: {}:{line}", label.message, other.path))
        }));
        format!("{}\n\n", diagnostics::full(&shown, file, paint))
    });
    shown.collect()
}

/// Each finding in one line.
#[must_use]
pub fn concise(findings: &[Diagnostic], files: &[SourceFile]) -> String {
    let mut out = String::new();
    for finding in findings {
        let file = &files[finding.span.file.0 as usize];
        let _ = writeln!(out, "{}; {}", diagnostics::concise(finding, file), help(finding));
    }
    out
}

/// The JSON of the stable interface.
#[must_use]
pub fn json(findings: &[Diagnostic], files: &[SourceFile], checked: usize) -> Value {
    let shown: Vec<Value> = findings
        .iter()
        .map(|finding| {
            let file = &files[finding.span.file.0 as usize];
            let (start, end) = (file.position(finding.span.start), file.position(finding.span.end));
            json!({
                "code": finding.code,
                "severity": finding.severity.name(),
                "file": file.path,
                "line": start.line,
                "column": start.column,
                "end_line": end.line,
                "end_column": end.column,
                "message": finding.message,
                "help": help(finding),
            })
        })
        .collect();
    json!({
        "findings": shown,
        "totals": {
            "files": checked,
            "errors": count(findings, Severity::Error),
            "warnings": count(findings, Severity::Warning),
        },
    })
}

/// The summary line.
#[must_use]
pub fn summary(findings: &[Diagnostic], checked: usize) -> String {
    let counted =
        |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    format!(
        "{}: {}, {}\n",
        counted(checked, "file"),
        counted(count(findings, Severity::Error), "error"),
        counted(count(findings, Severity::Warning), "warning"),
    )
}

/// The number of findings of a severity.
#[must_use]
pub fn count(findings: &[Diagnostic], severity: Severity) -> usize {
    findings.iter().filter(|finding| finding.severity == severity).count()
}

/// The way out of a finding.
fn help(finding: &Diagnostic) -> &str {
    let help = finding.notes.iter().find_map(|note| match note {
        Note::Help(text) => Some(text.as_str()),
        Note::Note(_) => None,
    });
    help.unwrap_or_default()
}

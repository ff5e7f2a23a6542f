//! Findings as a Code Quality report of GitLab.

use serde_json::{Value, json};

use super::fingerprints;
use crate::rapid::diagnostics::Severity;
use crate::rapid::text::SourceFile;
use crate::tool::lint::Report;

/// A list with one entry per finding.
#[must_use]
pub fn gitlab(report: &Report, files: &[SourceFile]) -> Value {
    let prints = fingerprints(&report.findings, files);
    let entries = report.findings.iter().zip(prints).map(|(finding, fingerprint)| {
        let file = &files[finding.span.file.0 as usize];
        let severity = match finding.severity {
            Severity::Error => "major",
            Severity::Warning => "minor",
            Severity::Info => "info",
        };
        json!({
            "description": finding.full_message(),
            "check_name": finding.rule.code,
            "fingerprint": fingerprint,
            "severity": severity,
            "location": {
                "path": file.path,
                "lines": {
                    "begin": file.position(finding.span.start).line,
                    "end": file.position(finding.span.end).line,
                },
            },
        })
    });
    Value::Array(entries.collect())
}

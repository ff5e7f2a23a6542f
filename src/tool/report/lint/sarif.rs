//! Findings as SARIF 2.1.0, for code scanning services.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::fingerprints;
use crate::rapid::diagnostics::Severity;
use crate::rapid::text::SourceFile;
use crate::tool::lint::{ALL, Finding, Report};

/// URL of the schema.
const SCHEMA: &str = "https://json.schemastore.org/sarif-2.1.0.json";

/// One run with all rules and findings.
#[must_use]
pub fn sarif(report: &Report, files: &[SourceFile]) -> Value {
    let rules: Vec<Value> = ALL
        .iter()
        .map(|rule| {
            json!({
                "id": rule.code,
                "name": pascal(rule.name),
                "shortDescription": { "text": rule.summary() },
                "fullDescription": { "text": rule.summary() },
                "help": { "text": rule.manual(), "markdown": rule.manual() },
                "defaultConfiguration": { "level": level(rule.severity) },
                "properties": { "tags": ["energy", rule.family.name()] },
            })
        })
        .collect();
    let prints = fingerprints(&report.findings, files);
    let results: Vec<Value> = report
        .findings
        .iter()
        .zip(prints)
        .map(|(finding, print)| result(finding, &print, files))
        .collect();
    json!({
        "$schema": SCHEMA,
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "joulepath",
                "version": env!("CARGO_PKG_VERSION"),
                "rules": rules,
            }},
            "columnKind": "unicodeCodePoints",
            "results": results,
        }],
    })
}

fn result(finding: &Finding, fingerprint: &str, files: &[SourceFile]) -> Value {
    let file = &files[finding.span.file.0 as usize];
    let index = ALL.iter().position(|rule| rule.code == finding.rule.code);
    let mut result = json!({
        "ruleId": finding.rule.code,
        "ruleIndex": index,
        "level": level(finding.severity),
        "message": { "text": finding.full_message() },
        "locations": [{ "physicalLocation": place(file, finding.span) }],
        "partialFingerprints": { "joulepath/v1": fingerprint },
    });
    if let Some(saving) = &finding.saving {
        result["properties"] = json!({
            "saving_j": saving.energy_j,
            "saving_s": saving.time_s,
            "saving_low_j": saving.low_j,
            "saving_high_j": saving.high_j,
            "per": "cycle",
        });
    }
    let related: Vec<Value> = (finding.related.iter())
        .map(|(span, text)| {
            let place = place(&files[span.file.0 as usize], *span);
            json!({ "physicalLocation": place, "message": { "text": text } })
        })
        .collect();
    if !related.is_empty() {
        result["relatedLocations"] = json!(related);
    }
    if let Some(fix) = &finding.fix {
        let changes: Vec<Value> = fix
            .edits
            .iter()
            .map(|edit| {
                let file = &files[edit.span.file.0 as usize];
                let deleted = json!({
                    "byteOffset": edit.span.start,
                    "byteLength": edit.span.end - edit.span.start,
                });
                let inserted = json!({ "text": String::from_utf8_lossy(&edit.text) });
                json!({
                    "artifactLocation": { "uri": uri(&file.path) },
                    "replacements": [{ "deletedRegion": deleted, "insertedContent": inserted }],
                })
            })
            .collect();
        let text = format!("{} ({})", finding.change, fix.applicability.name());
        result["fixes"] = json!([{ "description": { "text": text }, "artifactChanges": changes }]);
    }
    result
}

fn place(file: &SourceFile, span: crate::rapid::text::Span) -> Value {
    let (start, end) = (file.position(span.start), file.position(span.end));
    json!({
        "artifactLocation": { "uri": uri(&file.path) },
        "region": {
            "startLine": start.line,
            "startColumn": start.column,
            "endLine": end.line,
            "endColumn": end.column,
            "byteOffset": span.start,
            "byteLength": span.end - span.start,
        },
    })
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Info => "note",
    }
}

/// `unneeded-stop-point` as `UnneededStopPoint`.
fn pascal(name: &str) -> String {
    let word = |word: &str| {
        let mut signs = word.chars();
        signs.next().map(|first| first.to_ascii_uppercase()).into_iter().chain(signs).collect()
    };
    name.split('-').map(word).collect::<Vec<String>>().concat()
}

/// A path as a relative reference: letters, digits and `-._~/` stay, others become `%XX`.
fn uri(path: &str) -> String {
    let mut out = String::with_capacity(path.len());
    for byte in path.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                out.push(char::from(byte));
            }
            _ => {
                let _ = write!(out, "%{byte:02X}");
            }
        }
    }
    out
}

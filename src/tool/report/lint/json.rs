//! Findings as JSON.

use serde_json::{Value, json};

use super::top::{self, Year};
use crate::rapid::text::SourceFile;
use crate::tool::lint::{Finding, Report};

/// The JSON of the stable interface.
#[must_use]
pub fn json(report: &Report, files: &[SourceFile], year: &Year) -> Value {
    let findings: Vec<Value> = report.findings.iter().map(|it| finding(it, files)).collect();
    json!({
        "findings": findings,
        "top": top::json(report, files, year),
        "totals": {
            "findings": report.findings.len(),
            "saving_j": report.saving_j(),
            "cycle_energy_j": report.cycle_energy_j,
            "unresolved": report.unresolved,
            "movements": report.coverage.movements,
            "movements_simulated": report.coverage.simulated,
            "not_simulated": report.coverage.missing,
        },
    })
}

fn finding(finding: &Finding, files: &[SourceFile]) -> Value {
    let file = &files[finding.span.file.0 as usize];
    let (start, end) = (file.position(finding.span.start), file.position(finding.span.end));
    let saving = finding.saving.as_ref();
    let fix = finding.fix.as_ref().map(|fix| {
        let edits: Vec<Value> = fix
            .edits
            .iter()
            .map(|edit| {
                json!({
                    "file": files[edit.span.file.0 as usize].path,
                    "start": edit.span.start,
                    "end": edit.span.end,
                    "text": String::from_utf8_lossy(&edit.text),
                })
            })
            .collect();
        json!({ "applicability": fix.applicability.name(), "edits": edits })
    });
    let related: Vec<Value> = (finding.related.iter())
        .map(|(span, message)| {
            let file = &files[span.file.0 as usize];
            let line = file.position(span.start).line;
            json!({ "file": file.path, "line": line, "message": message })
        })
        .collect();
    json!({
        "code": finding.rule.code,
        "name": finding.rule.name,
        "severity": finding.severity.name(),
        "file": file.path,
        "line": start.line,
        "column": start.column,
        "end_line": end.line,
        "end_column": end.column,
        "message": finding.full_message(),
        "saving_j": saving.map(|s| s.energy_j),
        "saving_s": saving.map(|s| s.time_s),
        "saving_low_j": saving.map(|s| s.low_j),
        "saving_high_j": saving.map(|s| s.high_j),
        "saving_interval_j": saving.map(|s| [s.low_j, s.high_j]),
        "per": if saving.is_some() { "cycle" } else { "execution" },
        "at_stake_j": finding.at_stake_j,
        "related": related,
        "needs": finding.needs,
        "confidence": finding.confidence.name(),
        "places": finding.count,
        "assumptions": finding.assumptions,
        "fix": fix,
    })
}

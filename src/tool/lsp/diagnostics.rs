//! Findings and faults as diagnostics.

use gen_lsp_types::{Code, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity};
use serde_json::json;

use super::client::Client;
use super::findings::Analysis;
use super::position::Positions;
use super::workspace::View;
use crate::rapid::diagnostics::{self, Note, Severity};
use crate::tool::lint::Finding;

/// The name of the tool in a list of diagnostics.
const SOURCE: &str = "joulepath";

/// The diagnostics of a document: why a controller would not load it, and the findings of the linter.
pub(super) fn of_document(
    view: View<'_>,
    client: &Client,
    analysis: Option<&Analysis>,
) -> Vec<Diagnostic> {
    let faults = faults(view).into_iter().map(|fault| of_fault(view, client, fault));
    let findings = analysis.into_iter().flat_map(|analysis| {
        let positions = Positions::new(&analysis.file, client.units);
        analysis.own_findings().map(move |finding| of_finding(finding, positions))
    });
    faults.chain(findings).collect()
}

/// The faults of a file: those that all tasks have in which it is loaded.
fn faults(view: View<'_>) -> Vec<&diagnostics::Diagnostic> {
    let modules = &view.project.modules;
    let own = |fault: &&diagnostics::Diagnostic| fault.span.file == view.file;
    let mut tasks = view.project.tasks_of(view.file);
    let Some(first) = tasks.next() else { return Vec::new() };
    let mut found: Vec<_> = first.faults(modules).iter().filter(own).collect();
    for task in tasks {
        if found.is_empty() {
            break;
        }
        let others: Vec<_> = task.faults(modules).iter().filter(own).collect();
        let same = |fault: &diagnostics::Diagnostic| {
            let equal = |other: &&diagnostics::Diagnostic| {
                other.span == fault.span && other.message == fault.message
            };
            others.iter().any(equal)
        };
        found.retain(|fault| same(fault));
    }
    found
}

fn of_fault(view: View<'_>, client: &Client, fault: &diagnostics::Diagnostic) -> Diagnostic {
    let notes = fault.notes.iter().map(|note| match note {
        Note::Note(text) | Note::Help(text) => text.as_str(),
    });
    let lines: Vec<&str> = std::iter::once(fault.message.as_str()).chain(notes).collect();
    let related = fault.labels.iter().map(|label| DiagnosticRelatedInformation {
        location: view.location(label.span),
        message: label.message.clone(),
    });
    let related: Vec<_> = related.filter(|_| client.related_places).collect();
    Diagnostic {
        range: view.positions().range(fault.span),
        severity: Some(severity(fault.severity)),
        code: fault.code.clone().map(Code::String),
        source: Some(SOURCE.to_owned()),
        message: lines.join("\n").into(),
        related_information: (!related.is_empty()).then_some(related),
        ..Diagnostic::default()
    }
}

pub(super) fn of_finding(finding: &Finding, positions: Positions<'_>) -> Diagnostic {
    Diagnostic {
        range: positions.range(finding.span),
        severity: Some(severity(finding.severity)),
        code: Some(Code::String(finding.rule.code.to_owned())),
        source: Some(SOURCE.to_owned()),
        message: finding.full_message().into(),
        data: Some(json!({ "saving_j": finding.saving.map(|saving| saving.energy_j) })),
        ..Diagnostic::default()
    }
}

fn severity(severity: Severity) -> DiagnosticSeverity {
    match severity {
        Severity::Error => DiagnosticSeverity::Error,
        Severity::Warning => DiagnosticSeverity::Warning,
        Severity::Info => DiagnosticSeverity::Information,
    }
}

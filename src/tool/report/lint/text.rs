//! Findings as text: with source, in one line each, and counted.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::rapid::diagnostics::{self, Diagnostic, Label, Note, Paint};
use crate::rapid::text::SourceFile;
use crate::tool::lint::{Applicability, Finding, Report};
use crate::tool::report::table::{Align, table};

/// Number of findings in the list of largest savings.
const MAX_LISTED: usize = 10;

/// Each finding with its source, separated by empty lines.
#[must_use]
pub fn full(report: &Report, files: &[SourceFile], paint: Paint) -> String {
    let shown = report.findings.iter().map(|finding| {
        let file = &files[finding.span.file.0 as usize];
        format!("{}\n\n", diagnostics::full(&diagnostic(finding), file, paint))
    });
    shown.collect()
}

/// Each finding in one line.
#[must_use]
pub fn concise(report: &Report, files: &[SourceFile]) -> String {
    let shown = report.findings.iter().map(|finding| {
        let file = &files[finding.span.file.0 as usize];
        format!("{}\n", diagnostics::concise(&diagnostic(finding), file))
    });
    shown.collect()
}

fn diagnostic(finding: &Finding) -> Diagnostic {
    let mut diagnostic = Diagnostic::error(finding.span, finding.full_message());
    diagnostic.severity = finding.rule.severity;
    diagnostic.code = Some(finding.rule.code.to_owned());
    diagnostic.label = Some(finding.rule.name.to_owned());
    let related = finding.related.iter();
    diagnostic
        .labels
        .extend(related.map(|(span, message)| Label { span: *span, message: message.clone() }));
    let assumed = finding.assumptions.iter().map(|text| Note::Note(format!("assumes that {text}")));
    diagnostic.notes.extend(assumed);
    if let Some(fix) = &finding.fix {
        diagnostic.notes.push(Note::Help(
            match fix.applicability {
                Applicability::Safe => "--fix applies it",
                Applicability::Unsafe => "--unsafe-fixes applies it: look at it first",
            }
            .to_owned(),
        ));
    }
    diagnostic
}

/// The summary line.
#[must_use]
pub fn summary(report: &Report) -> String {
    let count = report.findings.len();
    let mut out = match count {
        0 => "no findings".to_owned(),
        1 => "1 finding".to_owned(),
        count => format!("{count} findings"),
    };
    let saving = report.saving_j();
    if let Some(cycle) = report.cycle_energy_j.filter(|cycle| *cycle > 0.0) {
        let share = 100.0 * saving / cycle;
        let _ = write!(out, ", {saving:.1} J of {cycle:.1} J a cycle ({share:.1} %)");
    }
    out.push('\n');
    out
}

/// The number of findings by rule (`-` without energies), and the findings with the largest
/// savings.
#[must_use]
pub fn statistics(report: &Report, files: &[SourceFile]) -> String {
    let mut by_rule: BTreeMap<(&str, &str), (usize, Option<f64>)> = BTreeMap::new();
    for finding in &report.findings {
        let entry = by_rule.entry((finding.rule.code, finding.rule.name)).or_default();
        entry.0 += 1;
        if let Some(saving) = &finding.saving {
            *entry.1.get_or_insert(0.0) += saving.energy_j;
        }
    }
    let rows: Vec<Vec<String>> = by_rule
        .into_iter()
        .map(|((code, name), (count, joules))| {
            let joules = joules.map_or("-".to_owned(), |joules| format!("{joules:.1}"));
            vec![code.to_owned(), name.to_owned(), count.to_string(), joules]
        })
        .collect();
    let columns = [
        ("code", Align::Left),
        ("rule", Align::Left),
        ("findings", Align::Right),
        ("J", Align::Right),
    ];
    let mut out = table(&columns, &rows);
    let mut most: Vec<&Finding> =
        report.findings.iter().filter(|finding| finding.saving.is_some()).collect();
    let joules = |finding: &Finding| finding.saving.map_or(0.0, |saving| saving.energy_j);
    most.sort_by(|a, b| joules(b).total_cmp(&joules(a)));
    let rows: Vec<Vec<String>> = most
        .into_iter()
        .take(MAX_LISTED)
        .map(|finding| {
            let file = &files[finding.span.file.0 as usize];
            let place = format!("{}:{}", file.path, file.position(finding.span.start).line);
            vec![format!("{:.1}", joules(finding)), finding.rule.code.to_owned(), place]
        })
        .collect();
    if !rows.is_empty() {
        let columns = [("J", Align::Right), ("code", Align::Left), ("place", Align::Left)];
        let _ = write!(out, "\n{}", table(&columns, &rows));
    }
    out
}

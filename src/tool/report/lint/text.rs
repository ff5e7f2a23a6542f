//! Findings as text: with source, in one line each, and counted.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::rapid::diagnostics::{self, Diagnostic, Label, Note, Paint};
use crate::rapid::text::SourceFile;
use crate::tool::lint::{Applicability, Finding, Report};
use crate::tool::report::table::{Align, table};

/// Most further places that a text shows: enough to see what they have in common. JSON and SARIF have all.
const SHOWN: usize = 4;

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
    diagnostic.severity = finding.severity;
    diagnostic.code = Some(finding.rule.code.to_owned());
    diagnostic.label = Some(finding.rule.name.to_owned());
    let related = finding.related.iter().take(SHOWN);
    diagnostic
        .labels
        .extend(related.map(|(span, message)| Label { span: *span, message: message.clone() }));
    let assumed = finding.assumptions.iter().map(|text| Note::Note(format!("assumes that {text}")));
    diagnostic.notes.extend(assumed);
    let needs = finding.needs.as_ref().map(|needs| Note::Note(format!("its joules need {needs}")));
    diagnostic.notes.extend(needs);
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
    if let Some(note) = report.coverage.note() {
        let _ = writeln!(out, "{note}");
    }
    out
}

/// The number of findings by rule (`-` without energies).
#[must_use]
pub fn statistics(report: &Report) -> String {
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
    table(&columns, &rows)
}

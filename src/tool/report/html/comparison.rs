//! The report of a comparison: figures of the cycle, changes by procedure with both sources, costs of
//! the procedures, what was left out.

use serde::Serialize;
use tera::Context;

use super::format::{fixed, joules, seconds};
use super::page::{ReportError, render};
use crate::rapid::text::{SourceFile, Span};
use crate::tool::compare::{Change, Costs, Cycle, Procedure};
use crate::tool::report::comparison::{Compared, deltas};

/// Maximum number of lines of the source that are shown for a side of a change.
const MAX_LINES: usize = 12;
/// Maximum number of characters of such a line.
const MAX_CHARACTERS: usize = 200;

#[derive(Serialize)]
struct Section {
    title: String,
    changes: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    action: &'static str,
    subject: String,
    message: String,
    old: Option<Excerpt>,
    new: Option<Excerpt>,
}

/// The source of one side of a change.
#[derive(Serialize)]
struct Excerpt {
    place: String,
    text: String,
}

#[derive(Serialize)]
struct CycleRows {
    task: String,
    reason: Option<String>,
    time: Option<Delta>,
    energy: Option<Delta>,
    interval: Option<String>,
    procedures: Vec<ProcedureRow>,
}

/// A figure on both sides, and its change.
#[derive(Serialize)]
struct Delta {
    old: String,
    new: String,
    by: String,
    /// Whether the new figure is the smaller one, larger, or neither.
    class: &'static str,
}

#[derive(Serialize)]
struct ProcedureRow {
    name: String,
    old_s: String,
    new_s: String,
    old_j: String,
    new_j: String,
    time: Option<Delta>,
    energy: Option<Delta>,
    reason: Option<String>,
}

/// The HTML report of a comparison.
///
/// # Errors
/// A template does not fit its data.
pub fn comparison_report(of: Compared<'_>) -> Result<String, ReportError> {
    let mut context = Context::new();
    let section = |section: crate::tool::report::comparison::Section<'_>| Section {
        title: section.title,
        changes: section.changes.into_iter().map(|change| row(of, change)).collect(),
    };
    let sections: Vec<Section> = of.sections().into_iter().map(section).collect();
    context.insert("old", of.names[0]);
    context.insert("new", of.names[1]);
    context.insert("robot", &of.robot);
    context.insert("count", &of.comparison.changes.len());
    context.insert("sections", &sections);
    let cycles: Vec<CycleRows> = of.comparison.cycles.iter().map(cycle).collect();
    context.insert("cycles", &cycles);
    context.insert("notes", &of.notes());
    render(include_str!("../../../../templates/diff.html.tera"), context)
}

fn row(of: Compared<'_>, change: &Change) -> Row {
    let [old, new] = of.places(change);
    let excerpt = |side: usize, place: Option<(String, u32)>, span: Option<Span>| {
        let (file, line) = place?;
        Some(Excerpt { place: format!("{file}:{line}"), text: source(of.files[side], span?) })
    };
    Row {
        action: change.action.name(),
        subject: change.subject.name().replace('_', " "),
        message: change.message.clone(),
        old: excerpt(0, old, change.old),
        new: excerpt(1, new, change.new),
    }
}

/// The lines of a span, without their common indentation.
fn source(files: &[SourceFile], span: Span) -> String {
    let Some(file) = files.get(span.file.0 as usize) else { return String::new() };
    let first = file.lines.range(file.position(span.start).line);
    let text = file.text(Span { start: first.start, ..span });
    let lines: Vec<&str> = text.lines().collect();
    let indent = |line: &&&str| line.len() - line.trim_start().len();
    let common =
        lines.iter().filter(|line| !line.trim().is_empty()).map(|line| indent(&line)).min();
    let shown = lines.iter().take(MAX_LINES).map(|line| {
        let line = line.get(common.unwrap_or(0)..).unwrap_or_default();
        line.chars().take(MAX_CHARACTERS).collect::<String>()
    });
    let mut out = shown.collect::<Vec<_>>().join("\n");
    if lines.len() > MAX_LINES {
        out.push_str("\n…");
    }
    out
}

fn delta(old: f64, new: f64, decimals: usize) -> Delta {
    let change = if old == new { 0.0 } else { new - old };
    let text = fixed(change, decimals);
    let is_zero = !text.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
    let (sign, class) = match change {
        _ if is_zero => ("", ""),
        x if x > 0.0 => ("+", "bad"),
        _ => ("", "good"),
    };
    Delta {
        old: fixed(old, decimals),
        new: fixed(new, decimals),
        by: format!("{sign}{text}"),
        class,
    }
}

fn both(old: Option<Costs>, new: Option<Costs>) -> [Option<Delta>; 2] {
    let time = old.zip(new).map(|(old, new)| delta(old.time_s, new.time_s, 3));
    let energies = old.and_then(|costs| costs.energy_j).zip(new.and_then(|costs| costs.energy_j));
    [time, energies.map(|(old, new)| delta(old, new, 1))]
}

fn cycle(cycle: &Cycle) -> CycleRows {
    let totals = &cycle.totals;
    let [time, energy] = both(totals.old, totals.new);
    let known = deltas(totals.old, totals.new)[1].and(totals.energy_interval_j);
    CycleRows {
        task: cycle.task.clone(),
        reason: totals.reason.clone(),
        time,
        energy,
        interval: known.map(|[low, high]| format!("{} to {}", joules(low), joules(high))),
        procedures: cycle.procedures.iter().map(procedure).collect(),
    }
}

fn procedure(procedure: &Procedure) -> ProcedureRow {
    let Procedure { name, old, new, reason } = procedure;
    let [time, energy] = both(*old, *new);
    let shown =
        |costs: &Option<Costs>| costs.map(|costs| seconds(costs.time_s)).unwrap_or_default();
    let energy_of = |costs: &Option<Costs>| {
        costs.and_then(|costs| costs.energy_j).map(joules).unwrap_or_default()
    };
    ProcedureRow {
        name: name.clone(),
        old_s: shown(old),
        new_s: shown(new),
        old_j: energy_of(old),
        new_j: energy_of(new),
        time,
        energy,
        reason: reason.clone(),
    }
}

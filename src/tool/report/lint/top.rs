//! The findings that are most worth a look, with joules of a cycle and kilowatt hours of a year.

use std::fmt::Write as _;

use serde_json::{Value, json};

use crate::rapid::text::SourceFile;
use crate::tool::lint::ranking::{joules, top};
use crate::tool::lint::{Finding, Report};
use crate::tool::report::table::{Align, table};

/// Joules of a kilowatt hour.
const J_PER_KWH: f64 = 3.6e6;
/// Seconds of an hour.
const S_PER_H: f64 = 3600.0;

/// How the list is made.
#[derive(Clone, Copy, Debug)]
pub struct Year {
    /// Most findings.
    pub count: usize,
    /// Hours in which the cell works in a year.
    pub hours: f64,
    /// Price of a kilowatt hour, in any currency.
    pub price: f64,
}

/// A finding of the list.
struct Row<'r> {
    finding: &'r Finding,
    joules: f64,
    /// Share of the cycle's energy.
    share: Option<f64>,
    kwh: Option<f64>,
}

fn rows<'r>(report: &'r Report, year: &Year) -> Vec<Row<'r>> {
    let row = |finding: &'r Finding| {
        let joules = joules(finding)?;
        let cycle = finding.cycle.filter(|it| it.energy_j > 0.0 && it.time_s > 0.0);
        let share = cycle.map(|cycle| joules / cycle.energy_j);
        let kwh = cycle.map(|it| joules * year.hours * S_PER_H / it.time_s / J_PER_KWH);
        Some(Row { finding, joules, share, kwh })
    };
    top(&report.findings, year.count).into_iter().filter_map(row).collect()
}

/// The list as a table, with what it assumes; empty without joules.
#[must_use]
pub fn text(report: &Report, files: &[SourceFile], year: &Year) -> String {
    let rows = rows(report, year);
    if rows.is_empty() {
        return String::new();
    }
    let cells = rows.iter().map(|row| {
        let finding = row.finding;
        let file = &files[finding.span.file.0 as usize];
        let number = |value: Option<f64>, digits: usize| {
            value.map_or("-".to_owned(), |value| format!("{value:.digits$}"))
        };
        let limit = if finding.saving.is_none() { "up to " } else { "" };
        let place = format!("{}:{}", file.path, file.position(finding.span.start).line);
        vec![
            format!("{limit}{:.1}", row.joules),
            number(row.share.map(|share| 100.0 * share), 1),
            number(row.kwh, 1),
            number(row.kwh.map(|kwh| kwh * year.price), 2),
            finding.confidence.name().to_owned(),
            finding.rule.code.to_owned(),
            finding.change.clone(),
            place,
        ]
    });
    let columns = [
        ("J a cycle", Align::Right),
        ("%", Align::Right),
        ("kWh a year", Align::Right),
        ("cost a year", Align::Right),
        ("confidence", Align::Left),
        ("code", Align::Left),
        ("change", Align::Left),
        ("place", Align::Left),
    ];
    let mut out = String::from("To fix first\n");
    out.push_str(&table(&columns, &cells.collect::<Vec<_>>()));
    let Year { hours, price, .. } = year;
    let _ = writeln!(
        out,
        "a year has {hours:.0} h of this cycle (--hours), a kWh costs {price} (--price); savings of \
         several places may overlap"
    );
    out
}

/// The list as JSON.
#[must_use]
pub fn json(report: &Report, files: &[SourceFile], year: &Year) -> Value {
    let row = |(index, row): (usize, &Row<'_>)| {
        let finding = row.finding;
        let file = &files[finding.span.file.0 as usize];
        let saving = finding.saving.is_some().then_some(row.joules);
        json!({
            "rank": index + 1,
            "code": finding.rule.code,
            "name": finding.rule.name,
            "file": file.path,
            "line": file.position(finding.span.start).line,
            "change": finding.change,
            "confidence": finding.confidence.name(),
            "places": finding.count,
            "saving_j": saving,
            "at_stake_j": finding.at_stake_j,
            "share": row.share,
            "kwh_per_year": row.kwh,
            "cost_per_year": row.kwh.map(|kwh| kwh * year.price),
        })
    };
    rows(report, year).iter().enumerate().map(row).collect()
}

//! The report of a cell's waits: the table, the cycle as a chart, the distributions, the signals.

use std::collections::BTreeMap;

use serde::Serialize;
use tera::Context;

use super::format::{fixed, percent, seconds};
use super::page::{ReportError, render};
use crate::tool::cell::events::{Cycle, What};
use crate::tool::cell::waits::{Shift, Wait, WaitKind};
use crate::tool::report::diagnose::quoted;
use crate::tool::report::svg::{Bar, Row, gantt, histogram};
use crate::tool::report::waits::{Waits, remarks, signal_text, why};

/// Ways that are drawn.
const MAX_WAYS: usize = 3;
/// Signals of a chart.
const MAX_SIGNALS: usize = 24;
/// Steps of a distribution.
const STEPS: usize = 28;

/// A wait.
#[derive(Serialize)]
struct WaitRow {
    place: String,
    signal: String,
    kind: &'static str,
    n: usize,
    median: String,
    low: String,
    high: String,
    at_once: String,
    why: String,
    remarks: Vec<String>,
    source: Option<String>,
    picture: String,
    /// Where the picture ends, s.
    end: String,
    experiment: Option<[String; 3]>,
}

/// A way through the program.
#[derive(Serialize)]
struct WayChart {
    cycles: usize,
    share: String,
    duration: String,
    chart: String,
}

/// The HTML report of `waits`; `notes` are shown.
///
/// # Errors
/// A template does not fit its data.
pub fn waits_report(of: Waits<'_>, notes: &[String]) -> Result<String, ReportError> {
    let found = of.found;
    let mut context = Context::new();
    context.insert("program", &found.shift.program);
    context.insert("cycles", &found.shift.cycles.len());
    context.insert("sessions", &found.shift.offsets.len());
    context.insert("incomplete", &found.shift.incomplete);
    let count =
        |kind: WaitKind| found.waits.iter().filter(|wait| wait.verdict.kind == kind).count();
    context.insert("slack", &count(WaitKind::Slack));
    context.insert("process", &count(WaitKind::Process));
    context.insert("unknown", &count(WaitKind::Unknown));
    let rows: Vec<WaitRow> = found.waits.iter().map(|wait| row(of, wait)).collect();
    context.insert("waits", &rows);
    context.insert("experiments", &rows.iter().any(|row| row.experiment.is_some()));
    context.insert("ways", &ways(&found.shift, &found.waits));
    let signals: Vec<String> = found.signals.iter().map(signal_text).collect();
    context.insert("signals", &signals);
    context.insert("notes", notes);
    context.insert("path", of.path);
    render(include_str!("../../../../templates/waits.html.tera"), context)
}

fn row(of: Waits<'_>, wait: &Wait) -> WaitRow {
    let [low, _, median, _, high] = wait.quantiles_s;
    let key = &wait.samples.key;
    let (picture, end) = distribution(wait);
    WaitRow {
        place: key.place.to_string(),
        signal: key.signal.clone().unwrap_or_default(),
        kind: wait.verdict.kind.word(),
        n: wait.samples.samples.len(),
        median: fixed(median, 2),
        low: fixed(low, 2),
        high: fixed(high, 2),
        at_once: percent(wait.at_once),
        why: why(wait),
        remarks: remarks(wait),
        source: of.lines.get(&key.place).cloned(),
        picture,
        end: fixed(end, 1),
        experiment: wait.experiment.as_ref().map(|experiment| {
            [
                experiment.cycles.to_string(),
                format!("{}", experiment.late_s),
                experiment.command(&quoted(of.program)),
            ]
        }),
    }
}

/// The lengths of a wait as a picture, and where it ends, s.
fn distribution(wait: &Wait) -> (String, f64) {
    // Stops of minutes fall into the last step.
    let end = (1.25 * wait.quantiles_s[4]).max(0.1);
    let mut counts = vec![0; STEPS];
    for length in wait.samples.lengths() {
        let step = (length / end * STEPS as f64) as usize;
        counts[step.min(STEPS - 1)] += 1;
    }
    (histogram("how long it lasts", &counts, wait.verdict.kind.word()), end)
}

/// A cycle of median duration for each of the most frequent ways.
fn ways(shift: &Shift, waits: &[Wait]) -> Vec<WayChart> {
    let frequencies = shift.frequencies();
    let chart = |(way, count): (usize, &usize)| {
        let mut of_way: Vec<&Cycle> = shift
            .cycles
            .iter()
            .zip(&shift.ways)
            .filter(|(_, of)| **of == way)
            .map(|(cycle, _)| cycle)
            .collect();
        of_way.sort_by(|a, b| a.duration().total_cmp(&b.duration()));
        let cycle = of_way.get(of_way.len() / 2)?;
        Some(WayChart {
            cycles: *count,
            share: percent(*count as f64 / shift.cycles.len() as f64),
            duration: seconds(cycle.duration()),
            chart: gantt("the cycle", &rows(cycle, waits), cycle.end - cycle.start),
        })
    };
    frequencies.iter().enumerate().take(MAX_WAYS).filter_map(chart).collect()
}

fn rows(cycle: &Cycle, waits: &[Wait]) -> Vec<Row<'static>> {
    let from = |t: f64| t - cycle.start;
    let mut moving = Vec::new();
    let mut started = None;
    let mut levels: BTreeMap<(bool, &str), Vec<(f64, f64)>> = BTreeMap::new();
    for event in &cycle.events {
        match (event.what, &event.signal) {
            (What::Start, _) => started = started.or(Some(event.t)),
            (What::Arrive, _) => {
                if let Some(start) = started.take() {
                    moving.push(Bar { from: from(start), to: from(event.t), class: "moving" });
                }
            }
            (What::Output(level), Some(name)) => {
                levels.entry((false, name)).or_default().push((from(event.t), level));
            }
            (What::Signal(level), Some(name)) => {
                levels.entry((true, name)).or_default().push((from(event.t), level));
            }
            _ => {}
        }
    }
    let mut rows = vec![Row { name: "robot moves".to_owned(), bars: moving }];
    for visit in &cycle.visits {
        let name = match &visit.signal {
            Some(signal) => format!("{} {signal}", visit.place),
            None => visit.place.to_string(),
        };
        let kind = waits
            .iter()
            .find(|wait| {
                wait.samples.key.place == visit.place && wait.samples.key.signal == visit.signal
            })
            .map_or("unknown", |wait| wait.verdict.kind.word());
        let to = from(visit.ended.unwrap_or(cycle.end));
        let bar = Bar { from: from(visit.came), to, class: kind };
        match rows.iter_mut().find(|row| row.name == name) {
            Some(row) => row.bars.push(bar),
            None => rows.push(Row { name, bars: vec![bar] }),
        }
    }
    for ((is_input, name), changes) in levels.into_iter().take(MAX_SIGNALS) {
        let class = if is_input { "high" } else { "set" };
        let bars = high(&changes, cycle.end - cycle.start, class);
        let name = format!("{} {name}", if is_input { "in" } else { "out" });
        rows.push(Row { name, bars });
    }
    rows
}

/// When a signal is high. What it was before its first change is the opposite of that.
fn high(changes: &[(f64, f64)], end: f64, class: &'static str) -> Vec<Bar<'static>> {
    let before = changes.first().map(|(_, level)| (0.0, f64::from(u8::from(*level == 0.0))));
    let starts = before.into_iter().chain(changes.iter().copied());
    let ends = changes.iter().map(|(t, _)| *t).chain([end]);
    let parts = starts.zip(ends).filter(|((_, level), _)| *level != 0.0);
    parts.map(|((from, _), to)| Bar { from, to, class }).collect()
}

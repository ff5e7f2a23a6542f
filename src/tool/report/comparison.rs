//! The result of `diff` as text and as JSON.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde_json::{Value, json};

use super::place::Places;
use super::table::{Align, table};
use crate::rapid::text::{SourceFile, Span};
use crate::tool::compare::{
    Change, Comparison, Costs, Cycle, Difference, DifferenceKind, Procedure, Totals,
};

/// A comparison with what is needed to show it.
#[derive(Clone, Copy)]
pub struct Compared<'a> {
    /// The comparison.
    pub comparison: &'a Comparison,
    /// Old and new, as the user named them.
    pub names: [&'a str; 2],
    /// The files of both sides.
    pub files: [&'a [SourceFile]; 2],
    /// The robot, if one is known.
    pub robot: Option<&'a str>,
}

/// The changes of a procedure, or of what a module declares.
pub(super) struct Section<'a> {
    pub(super) title: String,
    pub(super) changes: Vec<&'a Change>,
}

impl<'a> Compared<'a> {
    /// The changes by procedure, in their order.
    pub(super) fn sections(&self) -> Vec<Section<'a>> {
        let mut sections: Vec<Section<'a>> = Vec::new();
        let mut places: BTreeMap<String, usize> = BTreeMap::new();
        for change in &self.comparison.changes {
            let title = title(change);
            let place = *places.entry(title.clone()).or_insert(sections.len());
            if place == sections.len() {
                sections.push(Section { title, changes: Vec::new() });
            }
            sections[place].changes.push(change);
        }
        sections
    }

    /// File and line on both sides.
    pub(super) fn places(&self, change: &Change) -> [Option<(String, u32)>; 2] {
        let place = |side: usize, span: Option<Span>| {
            let place = Places::new(self.files[side]).of(span?);
            Some((place.file, place.first))
        };
        [place(0, change.old), place(1, change.new)]
    }

    /// What was left out, and what was compared otherwise.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        for (side, name) in ["old", "new"].iter().enumerate() {
            for (file, errors) in &self.comparison.errors[side] {
                let path = &self.files[side][*file].path;
                let plural = if *errors == 1 { "" } else { "s" };
                notes.push(format!(
                    "{path} ({name}) has {errors} syntax error{plural}: what has one is compared word by \
                     word, the rest by its meaning; joulepath parse shows them"
                ));
            }
        }
        match self.comparison.state {
            0 => {}
            1 => notes.push(
                "the value of 1 PERS differs that defines no motion: the controller saves it with \
                 the program, so it is not listed"
                    .to_owned(),
            ),
            count => notes.push(format!(
                "the values of {count} PERS differ that define no motion: the controller saves them \
                 with the program, so they are not listed"
            )),
        }
        for cycle in &self.comparison.cycles {
            let [old, new] = cycle.totals.unresolved;
            if old + new > 0 {
                notes.push(format!(
                    "{}statements that could not be simulated: {old} of the old program, {new} of the \
                     new one; joulepath simulate lists them",
                    of_task(&cycle.task)
                ));
            }
        }
        notes
    }
}

fn title(change: &Change) -> String {
    let task = if change.task.is_empty() { String::new() } else { format!("{} ", change.task) };
    match (&change.routine, change.module.as_str()) {
        (Some(routine), "") => format!("{task}{routine}"),
        (Some(routine), module) => format!("{task}{module}.{routine}"),
        (None, "") => format!("{task}outside of modules"),
        (None, module) => format!("{task}{module}, declarations"),
    }
}

fn of_task(task: &str) -> String {
    if task.is_empty() { String::new() } else { format!("{task}: ") }
}

/// The comparison for people.
pub fn text(of: Compared<'_>) -> String {
    let mut out = String::new();
    if of.comparison.changes.is_empty() {
        out.push_str("Nothing changed in meaning.\n");
    }
    for section in of.sections() {
        let _ = writeln!(out, "{}", section.title);
        for change in section.changes {
            let [old, new] =
                of.places(change).map(|place| place.map(|(file, line)| format!("{file}:{line}")));
            let place = match (old, new) {
                (Some(old), Some(new)) => format!("{old} → {new}"),
                (old, new) => old.or(new).unwrap_or_default(),
            };
            let _ = writeln!(
                out,
                "  {:<8}{:<13}{}  [{place}]",
                change.action.name(),
                change.subject.name().replace('_', " "),
                change.message,
            );
        }
        out.push('\n');
    }
    for cycle in &of.comparison.cycles {
        out.push_str(&cycle_text(cycle));
    }
    out
}

fn cycle_text(cycle: &Cycle) -> String {
    let Totals { old, new, reason, .. } = &cycle.totals;
    let task = of_task(&cycle.task);
    if let Some(reason) = reason {
        return format!("{task}the cycles are not compared: {reason}\n");
    }
    let mut out = String::new();
    let rows: Vec<Vec<String>> = cycle.procedures.iter().map(procedure_row).collect();
    if !rows.is_empty() {
        let header = [
            ("procedure", Align::Left),
            ("old (s)", Align::Right),
            ("new (s)", Align::Right),
            ("Δ (s)", Align::Right),
            ("old (J)", Align::Right),
            ("new (J)", Align::Right),
            ("Δ (J)", Align::Right),
            ("", Align::Left),
        ];
        out.push_str(&table(&header, &rows));
        out.push('\n');
    }
    let [time, energy] = deltas(*old, *new);
    let time = time.map_or_else(|| "unknown".to_owned(), |x| format!("{x:+.3} s"));
    let energy = energy.map_or_else(|| "energy not known".to_owned(), |x| format!("{x:+.1} J"));
    let interval = cycle
        .totals
        .energy_interval_j
        .map(|[low, high]| format!(" ({low:+.1} to {high:+.1} J in 90 % of the plausible robots)"));
    let _ = writeln!(out, "{task}one cycle: {time}, {energy}{}", interval.unwrap_or_default());
    out
}

/// The cells of a procedure; the last one says why figures are missing.
fn procedure_row(procedure: &Procedure) -> Vec<String> {
    let time =
        |costs: Option<Costs>| costs.map_or("\u{2013}".into(), |c| format!("{:.3}", c.time_s));
    let energy = |costs: Option<Costs>| {
        let energy = costs.and_then(|costs| costs.energy_j);
        energy.map_or("\u{2013}".into(), |x| format!("{x:.1}"))
    };
    let [delta_s, delta_j] = deltas(procedure.old, procedure.new);
    vec![
        procedure.name.clone(),
        time(procedure.old),
        time(procedure.new),
        delta_s.map_or_else(String::new, |x| format!("{x:+.3}")),
        energy(procedure.old),
        energy(procedure.new),
        delta_j.map_or_else(String::new, |x| format!("{x:+.1}")),
        procedure.reason.clone().unwrap_or_default(),
    ]
}

/// New minus old: s and J.
pub(super) fn deltas(old: Option<Costs>, new: Option<Costs>) -> [Option<f64>; 2] {
    let (Some(old), Some(new)) = (old, new) else { return [None, None] };
    // No negative zero.
    let delta = |old: f64, new: f64| if old == new { 0.0 } else { new - old };
    let energy = old.energy_j.zip(new.energy_j).map(|(old, new)| delta(old, new));
    [Some(delta(old.time_s, new.time_s)), energy]
}

/// The comparison for programs.
pub fn json(of: Compared<'_>) -> Value {
    let side = |index: usize| {
        let files: Vec<&str> = of.files[index].iter().map(|file| file.path.as_str()).collect();
        let errors: Vec<Value> = of.comparison.errors[index]
            .iter()
            .map(|(file, errors)| json!({ "file": files[*file], "errors": errors }))
            .collect();
        json!({ "name": of.names[index], "files": files, "syntax_errors": errors })
    };
    let sum = |delta: fn(&Cycle) -> Option<f64>| -> Option<f64> {
        let all: Option<Vec<f64>> = of.comparison.cycles.iter().map(delta).collect();
        all.filter(|all| !all.is_empty()).map(|all| all.iter().sum())
    };
    json!({
        "same": of.comparison.changes.is_empty(),
        "robot": of.robot,
        "old": side(0),
        "new": side(1),
        "changes": of.comparison.changes.iter().map(|change| change_json(of, change)).collect::<Vec<_>>(),
        "cycles": of.comparison.cycles.iter().map(cycle_json).collect::<Vec<_>>(),
        "totals": {
            "changes": of.comparison.changes.len(),
            "delta_s": sum(|cycle| deltas(cycle.totals.old, cycle.totals.new)[0]),
            "delta_j": sum(|cycle| deltas(cycle.totals.old, cycle.totals.new)[1]),
        },
        "state_values": of.comparison.state,
        "notes": of.notes(),
    })
}

fn change_json(of: Compared<'_>, change: &Change) -> Value {
    let [old, new] = of
        .places(change)
        .map(|place| place.map(|(file, line)| json!({ "file": file, "line": line })));
    json!({
        "subject": change.subject.name(),
        "action": change.action.name(),
        "task": (!change.task.is_empty()).then_some(&change.task),
        "module": (!change.module.is_empty()).then_some(&change.module),
        "routine": change.routine,
        "old": old,
        "new": new,
        "message": change.message,
        "differences": change.differences.iter().map(difference_json).collect::<Vec<_>>(),
    })
}

fn difference_json(difference: &Difference) -> Value {
    let mut value = match &difference.kind {
        DifferenceKind::Position(by) => {
            let far = by.iter().map(|x| x * x).sum::<f64>().sqrt();
            json!({ "kind": "position", "distance_mm": far, "delta_mm": by })
        }
        DifferenceKind::Orientation(angle) => {
            json!({ "kind": "orientation", "angle_deg": angle })
        }
        DifferenceKind::Configuration([old, new]) => {
            json!({ "kind": "configuration", "old": old, "new": new })
        }
        DifferenceKind::Axes(by) => json!({ "kind": "axes", "delta_deg": by }),
        DifferenceKind::External(axis, [old, new]) => {
            json!({ "kind": "external_axis", "axis": axis + 1, "old": old, "new": new })
        }
        DifferenceKind::Value([old, new]) => json!({ "kind": "value", "old": old, "new": new }),
    };
    value["component"] = json!(difference.path);
    value
}

fn costs_json(costs: Option<Costs>) -> Value {
    costs.map_or(Value::Null, |costs| json!({ "time_s": costs.time_s, "energy_j": costs.energy_j }))
}

fn cycle_json(cycle: &Cycle) -> Value {
    let Totals { old, new, reason, energy_interval_j, unresolved } = &cycle.totals;
    let [delta_s, delta_j] = deltas(*old, *new);
    let procedure = |procedure: &Procedure| {
        let [delta_s, delta_j] = deltas(procedure.old, procedure.new);
        json!({
            "name": procedure.name,
            "old": costs_json(procedure.old),
            "new": costs_json(procedure.new),
            "delta_s": delta_s,
            "delta_j": delta_j,
            "reason": procedure.reason,
        })
    };
    json!({
        "task": (!cycle.task.is_empty()).then_some(&cycle.task),
        "old": costs_json(*old),
        "new": costs_json(*new),
        "delta_s": delta_s,
        "delta_j": delta_j,
        "delta_interval_j": energy_interval_j,
        "reason": reason,
        "unresolved": { "old": unresolved[0], "new": unresolved[1] },
        "procedures": cycle.procedures.iter().map(procedure).collect::<Vec<_>>(),
    })
}

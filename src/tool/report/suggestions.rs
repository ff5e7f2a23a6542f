//! The suggestions of `optimize --suggest`. The JSON field names are a stable interface.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::json::interval;
use super::place::Places;
use super::table::{Align, table};
use crate::rapid::text::SourceFile;
use crate::retime::energy::EnergyParts;
use crate::tool::suggest::{Applied, Suggestion, Suggestions};

/// s in an hour.
const HOUR_S: f64 = 3600.0;
/// J in a kWh.
const KWH_J: f64 = 3.6e6;

/// Suggestions, and what their figures are of.
#[derive(Clone, Copy)]
pub struct Shown<'a> {
    /// The suggestions.
    pub found: &'a Suggestions,
    /// Hours in which the cell works in a year.
    pub hours_per_year: f64,
    /// The files, by id.
    pub files: &'a [SourceFile],
}

impl Shown<'_> {
    /// Saving in a year, kWh.
    fn kwh_per_year(&self, joules: f64) -> f64 {
        joules / KWH_J * self.hours_per_year * HOUR_S / self.found.cycle_s
    }

    fn percent(&self, joules: f64) -> f64 {
        100.0 * joules / self.found.energy.energy_j()
    }
}

/// The suggestions as JSON.
pub fn json(of: Shown<'_>) -> Value {
    let places = Places::new(of.files);
    let value = |(number, one): (usize, &Suggestion)| {
        let place = places.of(one.span);
        let saved = one.saved.energy_j();
        json!({
            "number": number + 1,
            "file": place.file,
            "line": place.first,
            "change": one.title,
            "risk": one.risk,
            "saving_j": saved,
            "saving_interval_j": one.saved_j.map(interval),
            "saving_percent": of.percent(saved),
            "motion_saving_j": one.saved.motion_energy_j(),
            "saving_s": one.time_s,
            "kwh_per_year": of.kwh_per_year(saved),
            "leaves_m": one.leaves_m,
            "edits": edits(of.files, one),
        })
    };
    json!({
        "cycle_s": of.found.cycle_s,
        "energy_j": of.found.energy.energy_j(),
        "motion_energy_j": of.found.energy.motion_energy_j(),
        "hours_per_year": of.hours_per_year,
        "suggestions": of.found.all.iter().enumerate().map(value).collect::<Vec<_>>(),
    })
}

fn edits(files: &[SourceFile], one: &Suggestion) -> Vec<Value> {
    let value = |edit: &crate::rapid::text::Edit| {
        let file = &files[edit.span.file.0 as usize];
        json!({
            "file": file.path,
            "start": edit.span.start,
            "end": edit.span.end,
            "text": file.charset.decode(&edit.text),
        })
    };
    one.edits.iter().map(value).collect()
}

/// The suggestions for people.
pub fn text(of: Shown<'_>) -> String {
    let places = Places::new(of.files);
    let mut out = format!(
        "today: cycle {:.3} s, energy {:.1} J, of which motions take {:.1} J\n",
        of.found.cycle_s,
        of.found.energy.energy_j(),
        of.found.energy.motion_energy_j()
    );
    if of.found.all.is_empty() {
        out.push_str("no change that was tried saves energy in the same time\n");
        return out;
    }
    let _ = writeln!(
        out,
        "each change was simulated alone in the whole cycle; --apply NUMBERS makes some of them, \
         --apply all those that save beside each other\n"
    );
    let row = |(number, one): (usize, &Suggestion)| {
        let saved = one.saved.energy_j();
        vec![
            (number + 1).to_string(),
            places.of(one.span).to_string(),
            one.title.clone(),
            format!("{saved:.1}"),
            format!("{:.2}", of.percent(saved)),
            format!("{:.0}", of.kwh_per_year(saved)),
            format!("{:.3}", one.time_s),
            format!("{:.0}", 1e3 * one.leaves_m),
            one.risk.to_owned(),
        ]
    };
    let rows: Vec<Vec<String>> = of.found.all.iter().enumerate().map(row).collect();
    let header = [
        ("number", Align::Right),
        ("place", Align::Left),
        ("change", Align::Left),
        ("saves J", Align::Right),
        ("%", Align::Right),
        ("kWh a year", Align::Right),
        ("s", Align::Right),
        ("leaves by mm", Align::Right),
        ("risk", Align::Left),
    ];
    out.push_str(&table(&header, &rows));
    out
}

/// What was applied, as JSON.
pub fn applied_json(of: &Applied) -> Value {
    let numbers = |list: &[usize]| list.iter().map(|n| n + 1).collect::<Vec<usize>>();
    let side = |i: usize| {
        json!({
            "cycle_s": of.cycle_s[i],
            "energy_j": of.energy[i].energy_j(),
            "motion_energy_j": of.energy[i].motion_energy_j(),
        })
    };
    json!({
        "taken": numbers(&of.taken),
        "left": numbers(&of.left),
        "before": side(0),
        "after": side(1),
    })
}

/// What was applied, as a sentence.
pub fn applied_text(of: &Applied) -> String {
    let numbers = |list: &[usize]| {
        let all: Vec<String> = list.iter().map(|n| (n + 1).to_string()).collect();
        if all.is_empty() { "none".to_owned() } else { all.join(", ") }
    };
    let percent =
        |part: fn(&EnergyParts) -> f64| 100.0 * (1.0 - part(&of.energy[1]) / part(&of.energy[0]));
    format!(
        "suggestions applied: {}; left, as they save nothing beside those: {}; energy {:.1} J of {:.1} J \
         ({:.2} % less), motions {:.2} % less, cycle {:.3} s of {:.3} s",
        numbers(&of.taken),
        numbers(&of.left),
        of.energy[1].energy_j(),
        of.energy[0].energy_j(),
        percent(EnergyParts::energy_j),
        percent(EnergyParts::motion_energy_j),
        of.cycle_s[1],
        of.cycle_s[0],
    )
}

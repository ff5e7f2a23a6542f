//! The report of a search for placements: the map, the best placements, what was refused.

use serde::Serialize;
use tera::Context;

use super::format::{fixed, joules, seconds};
use super::page::{ReportError, render};
use crate::tool::place::{Best, Found, Outlook};
use crate::tool::report::placement::Placements;
use crate::tool::report::svg::{Cells, Shade, Size};

const SIZE: Size = Size { width: 760.0, height: 560.0 };

/// One of the best placements.
#[derive(Serialize)]
struct Row {
    coordinates: Vec<String>,
    cycle: String,
    energy: String,
    saving: String,
    motion: String,
    /// 90 % of the plausible robots, of all energy.
    interval: Option<String>,
    chosen: bool,
}

/// The HTML report of `place`. `entry` is the routine that starts the program; `notes` are shown.
///
/// # Errors
/// A template does not fit its data.
pub fn place_report(
    of: Placements<'_>,
    entry: &str,
    notes: &[String],
) -> Result<String, ReportError> {
    let Found { today, best, accepted, count, refusals, surrogate_error_percent, .. } = of.found;
    let mut context = Context::new();
    context.insert("robot", of.robot);
    context.insert("entry", entry);
    context.insert("cycle", &seconds(today.cycle_s));
    context.insert("energy", &joules(today.energy.energy_j()));
    context.insert("motion_energy", &joules(today.energy.motion_energy_j()));
    context.insert("axes", &of.axes());
    let row = |(number, Best { placement, saving_percent, .. }): (usize, &Best)| {
        let [saving, motion] = of.saving_percent(placement);
        Row {
            coordinates: of.coordinates(placement).iter().map(|x| fixed(*x, 1)).collect(),
            cycle: seconds(placement.cycle_s),
            energy: joules(placement.energy.energy_j()),
            saving: fixed(saving, 2),
            motion: fixed(motion, 2),
            interval: saving_percent
                .as_ref()
                .map(|[all, _]| format!("{} to {}", fixed(all.low, 2), fixed(all.high, 2))),
            chosen: number + 1 == of.chosen,
        }
    };
    let rows: Vec<Row> = best.iter().enumerate().map(row).collect();
    context.insert("first", &rows.first());
    context.insert("best", &rows);
    context.insert("tried", &count.tried);
    context.insert("reached", &count.reached);
    context.insert("simulated", &count.simulated);
    context.insert("accepted", &accepted.len());
    context.insert("refused_reach", &refusals.reach);
    context.insert("refused_singular", &refusals.singular);
    context.insert("refused_keep_out", &refusals.keep_out);
    context.insert("refused_slower", &refusals.slower);
    context.insert("surrogate_error", &surrogate_error_percent.map(|x| fixed(x, 2)));
    context.insert("map", &map(of));
    let largest = best.first().map_or(0.0, |best| of.saving_percent(&best.placement)[0]);
    context.insert("largest", &fixed(largest, 2));
    context.insert("notes", notes);
    render(include_str!("../../../../templates/place.html.tera"), context)
}

/// The saving over the first two axes, the best of all others; `None` with fewer than two axes.
fn map(of: Placements<'_>) -> Option<String> {
    let axes = of.axes();
    let [first, second, ..] = axes.as_slice() else { return None };
    let ranges: Vec<[f64; 2]> = of.ranges();
    let ranges = [*ranges.first()?, *ranges.get(1)?];
    let at = |point: &[f64]| {
        [0, 1].map(|axis| {
            let [low, high] = ranges[axis];
            low + (high - low) * point.get(axis).copied().unwrap_or(0.5)
        })
    };
    let today = of.found.today.energy.energy_j();
    let shade = |outlook: &Outlook| match outlook {
        Outlook::OutOfReach => Shade::Impossible,
        Outlook::Refused => Shade::Refused,
        Outlook::Energy(energy) => Shade::Value(100.0 * (1.0 - energy / today)),
    };
    let points: Vec<([f64; 2], Shade)> =
        of.found.map.iter().map(|(point, outlook)| (at(point), shade(outlook))).collect();
    let is_inside = ranges.iter().all(|[low, high]| (*low..=*high).contains(&0.0));
    let mut marks = Vec::new();
    if is_inside {
        marks.push(([0.0, 0.0], "mark today", "today"));
    }
    if let Some(chosen) = of.found.best.get(of.chosen - 1) {
        marks.push((at(&chosen.placement.point), "mark chosen", "chosen"));
    }
    let cells = Cells {
        name: "saving by place",
        titles: [first, second],
        ranges,
        points: &points,
        marks: &marks,
    };
    Some(cells.svg(SIZE))
}

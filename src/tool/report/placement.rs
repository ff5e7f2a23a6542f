//! The result of `place`. The JSON field names are a stable interface.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::json::interval;
use super::table::{Align, table};
use crate::tool::place::{AXES, Best, Bounds, Found, Placement, Room};

/// Placements in the table of the text.
const ROWS: usize = 10;

/// The result and its request.
#[derive(Clone, Copy)]
pub struct Placements<'a> {
    /// Name of the robot.
    pub robot: &'a str,
    /// What was asked for.
    pub bounds: &'a [Bounds],
    /// What was found.
    pub found: &'a Found,
    /// Number of the placement that is written, from 1.
    pub chosen: usize,
}

impl Placements<'_> {
    /// Saving of a placement, % of all energy and of the motion energy.
    pub(super) fn saving_percent(&self, of: &Placement) -> [f64; 2] {
        let today = &self.found.today.energy;
        [
            100.0 * (1.0 - of.energy.energy_j() / today.energy_j()),
            100.0 * (1.0 - of.energy.motion_energy_j() / today.motion_energy_j()),
        ]
    }

    /// Names of the axes along which frames may move, with their units.
    pub(super) fn axes(&self) -> Vec<String> {
        self.free()
            .map(|(group, axis)| {
                let unit = if axis < 3 { "mm" } else { "deg" };
                let name = if self.bounds.len() > 1 {
                    format!("{} {}", self.bounds[group].names.join("+"), AXES[axis])
                } else {
                    AXES[axis].to_owned()
                };
                format!("{name} {unit}")
            })
            .collect()
    }

    /// A placement along those axes, mm and degrees.
    pub(super) fn coordinates(&self, of: &Placement) -> Vec<f64> {
        let value = |(group, axis): (usize, usize)| shown(axis, of.shifts[group][axis]);
        self.free().map(value).collect()
    }

    /// The bounds along those axes, mm and degrees.
    pub(super) fn ranges(&self) -> Vec<[f64; 2]> {
        let range = |(group, axis): (usize, usize)| {
            let bounds: &Bounds = &self.bounds[group];
            bounds.axes[axis].map(|ends| ends.map(|end| shown(axis, end)))
        };
        self.free().filter_map(range).collect()
    }

    fn free(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.bounds.iter().enumerate().flat_map(|(group, bounds)| {
            (0..6).filter(|axis| bounds.axes[*axis].is_some()).map(move |axis| (group, axis))
        })
    }
}

/// m as mm, rad as degrees.
fn shown(axis: usize, value: f64) -> f64 {
    if axis < 3 { 1e3 * value } else { value.to_degrees() }
}

/// The result as JSON; `written` are the paths of written files.
pub fn json(of: Placements<'_>, written: &[String], notes: &[String]) -> Value {
    let Found { today, best, accepted, count, refusals, surrogate_error_percent, .. } = of.found;
    let best: Vec<Value> = best
        .iter()
        .map(|Best { placement, saving_percent, .. }| {
            let mut value = placement_json(of, placement);
            let intervals = saving_percent.as_ref();
            value["saving_interval_percent"] = json!(intervals.map(|x| interval(x[0])));
            value["motion_saving_interval_percent"] = json!(intervals.map(|x| interval(x[1])));
            value
        })
        .collect();
    json!({
        "robot": of.robot,
        "original": {
            "cycle_s": today.cycle_s,
            "energy_j": today.energy.energy_j(),
            "motion_energy_j": today.energy.motion_energy_j(),
            "limits": room(&today.room),
        },
        "candidates": {
            "tried": count.tried,
            "reached": count.reached,
            "simulated": count.simulated,
            "accepted": accepted.len(),
            "refused": {
                "reach": refusals.reach,
                "singular": refusals.singular,
                "keep_out": refusals.keep_out,
                "slower": refusals.slower,
            },
        },
        "surrogate_error_percent": surrogate_error_percent,
        "best": best,
        "chosen": of.found.best.get(of.chosen - 1).map(|_| of.chosen),
        "outputs": written,
        "notes": notes,
    })
}

fn placement_json(of: Placements<'_>, placement: &Placement) -> Value {
    let shifts = of.bounds.iter().zip(&placement.shifts).map(|(bounds, shift)| {
        let mut value = json!({ "frames": bounds.names });
        for (axis, name) in AXES.iter().enumerate() {
            let unit = if axis < 3 { "mm" } else { "deg" };
            value[format!("{name}_{unit}")] = json!(shown(axis, shift[axis]));
        }
        value
    });
    let [saving, motion] = of.saving_percent(placement);
    json!({
        "shifts": shifts.collect::<Vec<_>>(),
        "cycle_s": placement.cycle_s,
        "energy_j": placement.energy.energy_j(),
        "motion_energy_j": placement.energy.motion_energy_j(),
        "saving_percent": saving,
        "motion_saving_percent": motion,
        "limits": room(&placement.room),
    })
}

/// The least distances; null where nothing is near.
fn room(room: &Room) -> Value {
    let finite = |x: f64| x.is_finite().then_some(x);
    json!({
        "wrist_deg": finite(room.wrist).map(|x| x.asin().to_degrees()),
        "elbow_deg": finite(room.elbow).map(|x| x.asin().to_degrees()),
        "shoulder_m": finite(room.shoulder_m),
        "clearance_m": finite(room.clearance_m),
    })
}

/// All accepted placements as CSV: shifts, duration, energies, least distances.
pub fn csv(of: Placements<'_>) -> String {
    let mut names = Vec::new();
    for bounds in of.bounds {
        for (axis, name) in AXES.iter().enumerate() {
            let unit = if axis < 3 { "mm" } else { "deg" };
            names.push(format!("{}_{name}_{unit}", bounds.names.join("+")));
        }
    }
    let mut out = format!(
        "{},cycle_s,energy_j,motion_energy_j,wrist_deg,elbow_deg,shoulder_m,clearance_m\n",
        names.join(",")
    );
    for placement in &of.found.accepted {
        let shifts = placement.shifts.iter().flat_map(|shift| shift.iter().enumerate());
        let room = &placement.room;
        let figures = [
            placement.cycle_s,
            placement.energy.energy_j(),
            placement.energy.motion_energy_j(),
            room.wrist.asin().to_degrees(),
            room.elbow.asin().to_degrees(),
            room.shoulder_m,
            room.clearance_m,
        ];
        let cells = shifts.map(|(axis, value)| shown(axis, *value)).chain(figures);
        let cells = cells.map(|x| if x.is_finite() { x.to_string() } else { String::new() });
        let _ = writeln!(out, "{}", cells.collect::<Vec<_>>().join(","));
    }
    out
}

/// The result for people.
pub fn text(of: Placements<'_>) -> String {
    let Found { today, best, accepted, count, refusals, .. } = of.found;
    let mut out = format!(
        "today: cycle {:.3} s, energy {:.1} J, of which motions take {:.1} J\n\
         {} candidates: {} with all targets in reach, {} simulated as a whole, {} accepted \
         (refused: {} out of reach on the way, {} near a singularity, {} in a keep-out, {} slower \
         than today)\n",
        today.cycle_s,
        today.energy.energy_j(),
        today.energy.motion_energy_j(),
        count.tried,
        count.reached,
        count.simulated,
        accepted.len(),
        refusals.reach,
        refusals.singular,
        refusals.keep_out,
        refusals.slower,
    );
    let Some(first) = best.first() else {
        out.push_str(
            "no accepted placement uses less energy than today: leave the frames where they are\n",
        );
        return out;
    };
    let [saving, motion] = of.saving_percent(&first.placement);
    let _ = writeln!(
        out,
        "the best one saves {saving:.2} % of all energy, {motion:.2} % of the motion energy{}",
        first.saving_percent.as_ref().map_or_else(String::new, |[all, _]| format!(
            "; in 90 % of the plausible robots {:.2} to {:.2} % of all",
            all.low, all.high
        ))
    );
    let axes = of.axes();
    let mut header: Vec<(&str, Align)> = vec![("number", Align::Right)];
    header.extend(axes.iter().map(|axis| (axis.as_str(), Align::Right)));
    header.extend(
        ["cycle s", "energy J", "saving %", "of motion %"].map(|name| (name, Align::Right)),
    );
    let row = |(number, best): (usize, &Best)| {
        let [saving, motion] = of.saving_percent(&best.placement);
        let mut row = vec![(number + 1).to_string()];
        row.extend(of.coordinates(&best.placement).iter().map(|x| format!("{x:.1}")));
        row.push(format!("{:.3}", best.placement.cycle_s));
        row.push(format!("{:.1}", best.placement.energy.energy_j()));
        row.push(format!("{saving:.2}"));
        row.push(format!("{motion:.2}"));
        row
    };
    let rows: Vec<Vec<String>> = best.iter().take(ROWS).enumerate().map(row).collect();
    out.push('\n');
    out.push_str(&table(&header, &rows));
    out
}

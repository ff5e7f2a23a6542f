//! The result of `calibrate`. The JSON field names are a stable interface.

use std::fmt::Write;

use serde_json::{Value, json};

use super::json::interval;
use crate::learn::calibrate::{Calibrated, Found};
use crate::retime::energy::plausible::{Interval, Plausibility};

/// Maximum number of groups in the text, and maximum ratio of new to old deviation that is
/// reported.
const MAX_GROUPS: usize = 5;
const MAX_RATIO: f64 = 0.9;
/// Misfit relative to the noise from which on the log probably belongs to another robot or program.
const MAX_MISFIT: f64 = 10.0;

/// The result as JSON; `path` is the robot's file.
pub fn json(calibrated: &Calibrated, path: &str) -> Value {
    let intervals = |of: &Plausibility| {
        json!({
            "energy_j": interval(of.energy_j),
            "motion_energy_j": interval(of.motion_energy_j),
            "energy_median_j": of.energy_j.median,
            "motion_energy_median_j": of.motion_energy_j.median,
        })
    };
    let Found { kilowatts, cycles, pace, explained, misfit, torques } = calibrated.found;
    let narrowed: Vec<Value> = narrower(calibrated)
        .map(|(group, left)| json!({ "group": group, "deviation_left": left }))
        .collect();
    json!({
        "draws": calibrated.robots,
        "accepted": calibrated.model.calibration.as_ref().map_or(0, |c| c.robots),
        "interval_before": intervals(&calibrated.before),
        "interval_after": intervals(&calibrated.after),
        "robot": path,
        "log": {
            "cycles": cycles, "pace": pace, "explained": explained, "misfit": misfit,
            "kilowatts": kilowatts, "torques": torques,
        },
        "narrowed": narrowed,
    })
}

/// The result as text.
pub fn text(calibrated: &Calibrated, path: &str) -> String {
    let Found { kilowatts, cycles, pace, explained, misfit, torques } = calibrated.found;
    let mut out = String::new();
    let accepted = calibrated.model.calibration.as_ref().map_or(0, |c| c.robots);
    let _ = writeln!(
        out,
        "{cycles} cycle{}{}{}, {:.2} % {} than simulated; the fitted robot explains {:.1} % of how the \
         power changes",
        if cycles == 1 { "" } else { "s" },
        if kilowatts { ", power in kW" } else { "" },
        if torques { ", with torques of the joints" } else { "" },
        100.0 * (pace - 1.0).abs(),
        if pace < 1.0 { "shorter" } else { "longer" },
        100.0 * explained
    );
    if misfit > 2.0 {
        let _ = writeln!(
            out,
            "what it leaves is {:.1} times the noise of the log: intervals are as much wider{}",
            misfit.sqrt(),
            if misfit.sqrt() > MAX_MISFIT {
                ". So much is rare: check waits, inputs and columns"
            } else {
                ""
            }
        );
    }
    let _ = writeln!(out, "{accepted} of {} plausible robots fit the log", calibrated.robots);
    let change = |what: &str, before: &Interval, after: &Interval| {
        let width = |i: &Interval| i.high - i.low;
        format!(
            "{what}: {:.0} to {:.0} J before, {:.0} to {:.0} J now: {:.1} % of the width",
            before.low,
            before.high,
            after.low,
            after.high,
            100.0 * width(after) / width(before).max(f64::MIN_POSITIVE)
        )
    };
    let (before, after) = (&calibrated.before, &calibrated.after);
    let _ = writeln!(out, "{}", change("energy of the cycle", &before.energy_j, &after.energy_j));
    let motion = change("of which motions", &before.motion_energy_j, &after.motion_energy_j);
    let _ = writeln!(out, "{motion}");
    let groups: Vec<String> = narrower(calibrated)
        .take(MAX_GROUPS)
        .map(|(group, left)| format!("{group} {:.0} %", 100.0 * left))
        .collect();
    if !groups.is_empty() {
        let _ = writeln!(out, "how uncertain figures still are, of before: {}", groups.join(", "));
    }
    let _ = writeln!(out, "what the meter itself is wrong by is in no interval");
    let _ = writeln!(out, "{path} is the robot: use it with --robot {path}");
    out
}

fn narrower(calibrated: &Calibrated) -> impl Iterator<Item = &(String, f64)> {
    calibrated.narrowed.iter().filter(|(_, left)| *left < MAX_RATIO)
}

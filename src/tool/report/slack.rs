//! The slack of recorded waits in the result of `optimize`.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::arm::robot::Model;
use crate::retime::energy::{Account, EnergyParts};
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::What;
use crate::tool::cell::slack::Planned;
use crate::tool::retrofit::Retrofit;

/// What the use of recorded slack brings.
pub struct Outcome {
    /// How much later the robot comes to each wait, s.
    pub later_s: Vec<f64>,
    /// Recorded cycles that would have become longer.
    pub longer: usize,
    /// Mean time by which they would have become longer, s.
    pub longer_s: f64,
    /// Expected saving in a recorded cycle, J.
    pub saving_j: f64,
    /// Its interval over plausible robots.
    pub interval_j: Option<[f64; 2]>,
    /// The same saving in percent of the energy of a typical recorded cycle.
    pub percent: f64,
}

/// What the use of recorded slack brings in the emitted program.
#[must_use]
pub fn outcome(model: &Model, planned: &Planned, result: &Retrofit) -> Outcome {
    let waits = |(simulation, account): &(Simulation, Account)| -> Vec<(f64, f64)> {
        let events = simulation.events.iter().zip(&account.events);
        let waits = events.filter(|(event, _)| matches!(event.what, What::Wait(_)));
        let energy = |parts: &[EnergyParts]| parts.iter().map(EnergyParts::energy_j).sum();
        waits.map(|(event, parts)| (event.duration, energy(parts))).collect()
    };
    let [old, new] = [&result.before, &result.after].map(waits);
    let length = |of: &[(f64, f64)], number: usize| of.get(number).map_or(0.0, |wait| wait.0);
    let numbers = planned.uses.iter().map(|it| it.number);
    let later_s: Vec<f64> =
        numbers.map(|number| (length(&old, number) - length(&new, number)).max(0.0)).collect();
    let (longer, longer_s) = planned.longer(&later_s);
    let (before, after) = (result.original.energy_j, result.optimized.energy_j);
    // Cycles of another way save nothing that is known; longer ones take the base power for longer.
    let of = |saved: f64| planned.share * (saved - model.drive.base_w * longer_s);
    // The simulated waits end as early as the risk allows; a typical one takes longer.
    let waited = planned.uses.iter().filter_map(|it| {
        let (length, energy) = old.get(it.number).filter(|wait| wait.0 > 0.0)?;
        Some(energy / length * (it.median_s - length))
    });
    let typical = before + waited.sum::<f64>();
    let saving_j = of(before - after);
    let range = result.uncertainty.as_ref().map(|it| it.saving_percent[0]);
    let interval_j = range.map(|it| [it.low, it.high].map(|percent| of(0.01 * percent * before)));
    let percent = 100.0 * saving_j / typical;
    Outcome { later_s, longer, longer_s, saving_j, interval_j, percent }
}

/// The entry `waits` of the JSON.
#[must_use]
pub fn json(model: &Model, planned: &Planned, result: &Retrofit) -> Value {
    let outcome = outcome(model, planned, result);
    let used = planned.uses.iter().zip(&outcome.later_s).map(|(it, later_s)| {
        json!({
            "place": it.place,
            "later_s": later_s,
            "allowed_s": it.delay_s,
            "median_s": it.median_s,
        })
    });
    json!({
        "cycles": planned.cycles,
        "share": planned.share,
        "longer": outcome.longer,
        "longer_mean_s": outcome.longer_s,
        "used": used.collect::<Vec<_>>(),
        "expected_saving_percent": outcome.percent,
        "expected_saving_j": {
            "value": outcome.saving_j,
            "low": outcome.interval_j.map(|it| it[0]),
            "high": outcome.interval_j.map(|it| it[1]),
        },
    })
}

/// The same as text.
#[must_use]
pub fn text(model: &Model, planned: &Planned, result: &Retrofit) -> String {
    let outcome = outcome(model, planned, result);
    let mut out = String::new();
    for (it, later_s) in planned.uses.iter().zip(&outcome.later_s) {
        let _ = writeln!(
            out,
            "{}: the robot comes {later_s:.2} s later, up to {:.2} s are allowed (the wait takes {:.2} s in half of \
             the cycles)",
            it.place, it.delay_s, it.median_s
        );
    }
    let range = outcome
        .interval_j
        .map_or_else(String::new, |it| format!(" ({:.0} to {:.0})", it[0], it[1]));
    let _ = writeln!(
        out,
        "{} of {} recorded cycles would have become longer; expected saving {:.0} J{range}, {:.1} % of all, in a \
         recorded cycle; {:.0} % of them take this way",
        outcome.longer,
        planned.cycles,
        outcome.saving_j,
        outcome.percent,
        100.0 * planned.share
    );
    out
}

//! The slack of recorded waits in the result of `optimize`.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::arm::robot::Model;
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
}

/// What the use of recorded slack brings in the emitted program.
#[must_use]
pub fn outcome(model: &Model, planned: &Planned, result: &Retrofit) -> Outcome {
    let length = |simulation: &Simulation, number: usize| {
        let waits = simulation.events.iter().filter(|it| matches!(it.what, What::Wait(_)));
        waits.map(|event| event.duration).nth(number).unwrap_or_default()
    };
    let (old, new) = (&result.before.0, &result.after.0);
    let numbers = planned.uses.iter().map(|it| it.number);
    let later = |number| (length(old, number) - length(new, number)).max(0.0);
    let later_s: Vec<f64> = numbers.map(later).collect();
    let (longer, longer_s) = planned.longer(&later_s);
    let (before, after) = (result.original.energy_j, result.optimized.energy_j);
    // Cycles of another way save nothing that is known; longer ones take the base power for longer.
    let of = |saved: f64| planned.share * (saved - model.drive.base_w * longer_s);
    let percent = result.uncertainty.as_ref().map(|it| it.saving_percent[0]);
    let interval_j = percent.map(|it| [it.low, it.high].map(|percent| of(0.01 * percent * before)));
    Outcome { later_s, longer, longer_s, saving_j: of(before - after), interval_j }
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
        "{} of {} recorded cycles would have become longer; expected saving {:.0} J{range} in a recorded cycle, \
         {:.0} % of which take this way",
        outcome.longer,
        planned.cycles,
        outcome.saving_j,
        100.0 * planned.share
    );
    out
}

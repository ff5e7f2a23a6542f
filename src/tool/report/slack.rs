//! The slack of recorded waits in the result of `optimize`.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::arm::robot::Model;
use crate::tool::cell::slack::Planned;
use crate::tool::retrofit::Retrofit;

/// Expected saving in a recorded cycle, J: the value, and its interval over plausible robots.
fn expected(model: &Model, planned: &Planned, result: &Retrofit) -> (f64, Option<[f64; 2]>) {
    let (before, after) = (result.original.energy_j, result.optimized.energy_j);
    // Cycles of another way save nothing that is known; longer ones take the base power for longer.
    let lost = model.drive.base_w * planned.longer_s;
    let of = |saved: f64| planned.share * (saved - lost);
    let percent = result.uncertainty.as_ref().map(|it| it.saving_percent[0]);
    let interval = percent.map(|it| [it.low, it.high].map(|percent| of(0.01 * percent * before)));
    (of(before - after), interval)
}

/// The entry `waits` of the JSON.
pub fn json(model: &Model, planned: &Planned, result: &Retrofit) -> Value {
    let uses = planned
        .uses
        .iter()
        .map(|it| json!({ "place": it.place, "later_s": it.delay_s, "median_s": it.median_s }));
    let (value, interval) = expected(model, planned, result);
    json!({
        "cycles": planned.cycles,
        "share": planned.share,
        "longer": planned.longer,
        "longer_mean_s": planned.longer_s,
        "used": uses.collect::<Vec<_>>(),
        "expected_saving_j": {
            "value": value,
            "low": interval.map(|it| it[0]),
            "high": interval.map(|it| it[1]),
        },
    })
}

/// The same as text.
pub fn text(model: &Model, planned: &Planned, result: &Retrofit) -> String {
    let mut out = String::new();
    for it in &planned.uses {
        let _ = writeln!(
            out,
            "{}: the robot may come {:.2} s later (the wait takes {:.2} s in half of the cycles)",
            it.place, it.delay_s, it.median_s
        );
    }
    let (value, interval) = expected(model, planned, result);
    let range = interval.map_or_else(String::new, |it| format!(" ({:.0} to {:.0})", it[0], it[1]));
    let _ = writeln!(
        out,
        "{} of {} recorded cycles would have become longer; expected saving {value:.0} J{range} in a recorded cycle, \
         {:.0} % of which take this way",
        planned.longer,
        planned.cycles,
        100.0 * planned.share
    );
    out
}

//! The result of `instrument`. The JSON field names are a stable interface.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::tool::cell::instrument::Instrumented;

/// What is asked of a recorder, ms for each movement.
const BUDGET_MS: f64 = 5.0;
/// Maximum number of places in the text.
const MAX_PLACES: usize = 10;

/// The result as JSON; `outputs` are the written files.
pub fn json(made: &Instrumented, entry: &str, outputs: &[String]) -> Value {
    let [movements, waits, set] = made.recorded;
    let left_out = made.left_out.iter();
    let left_out: Vec<Value> =
        left_out.map(|(place, why)| json!({ "place": place, "reason": why })).collect();
    json!({
        "entry": entry,
        "program": made.program,
        "log": made.log,
        "recorded": { "movements": movements, "waits": waits, "outputs": set },
        "signals": made.signals,
        "left_out": left_out,
        "extra_time": {
            "cycle_ms": made.cost.cycle_ms(),
            "notes_ms": made.cost.notes_ms,
            "writing_ms": made.cost.writing_ms,
            "movement_ms": made.cost.movement_ms(),
            "movements": made.cost.movements,
            "notes": made.cost.notes,
            "sampling_share": made.cost.sampling_share,
        },
        "sample_rows_per_cycle": made.sample_rows,
        "assumed": ASSUMED,
        "outputs": outputs,
    })
}

/// The assumptions of the extra time.
const ASSUMED: [&str; 3] = [
    "a RAPID instruction takes 0.05 ms",
    "writing 1 kB takes 2 ms",
    "opening and closing a file takes 15 ms",
];

/// The result as text.
pub fn text(made: &Instrumented) -> String {
    let mut out = String::new();
    let [movements, waits, set] = made.recorded;
    let cost = &made.cost;
    let _ = writeln!(
        out,
        "recorded: {movements} movements, {waits} waits and {set} outputs of the text, {} signals",
        made.signals.len()
    );
    let _ = writeln!(
        out,
        "extra time: {:.1} ms in a cycle of {} movements, {:.2} ms for each: {:.1} ms for {} notes, {:.1} ms \
         for writing them at the first stop point of the next cycle",
        cost.cycle_ms(),
        cost.movements,
        cost.movement_ms(),
        cost.notes_ms,
        cost.notes,
        cost.writing_ms
    );
    if cost.movement_ms() > BUDGET_MS {
        let _ = writeln!(
            out,
            "that is more than {BUDGET_MS} ms for each movement: the cycle has few movements for its notes; name \
             fewer signals with --signals"
        );
    }
    if cost.notes > made.memory {
        let _ = writeln!(
            out,
            "a cycle has {} notes and the memory holds {}: the end of each cycle will be lost. Let a routine \
             of the program be main of its own, or record it with --entry",
            cost.notes, made.memory
        );
    }
    if let Some(rows) = made.sample_rows {
        let _ = writeln!(
            out,
            "samples: one cycle is sampled, then written with {rows} rows in a cycle; meanwhile none is \
             sampled; while samples are taken they need {:.1} % of the interpreter",
            100.0 * cost.sampling_share
        );
    }
    let _ = writeln!(out, "assumed: {}", ASSUMED.join("; "));
    for (place, why) in made.left_out.iter().take(MAX_PLACES) {
        let _ = writeln!(out, "not recorded: {place}: {why}");
    }
    if made.left_out.len() > MAX_PLACES {
        let _ = writeln!(out, "not recorded: {} more", made.left_out.len() - MAX_PLACES);
    }
    let _ = writeln!(out, "the controller writes HOME:/{}; give it to joulepath waits", made.log);
    out
}

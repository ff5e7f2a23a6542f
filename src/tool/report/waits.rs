//! What is found about waits. The JSON field names are a stable interface.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::{Value, json};

use super::diagnose::quoted;
use super::table::{Align, table};
use crate::tool::cell::events::Place;
use crate::tool::cell::waits::{
    Candidate, Found, Kind, Population, Reason, SignalTime, Trend, Wait, WaitKind,
};

/// What is found, with what the command line knows.
#[derive(Clone, Copy)]
pub struct Waits<'a> {
    /// What the logs say.
    pub found: &'a Found,
    /// Lines of the program, where it is given.
    pub lines: &'a BTreeMap<Place, String>,
    /// The program as the user named it, for commands.
    pub program: &'a str,
    /// Where `waits.toml` was written.
    pub path: &'a str,
}

/// The result as JSON.
pub fn json(of: Waits<'_>, notes: &[String]) -> Value {
    let Found { shift, waits, signals } = of.found;
    let waits: Vec<Value> = waits.iter().map(|wait| wait_json(of, wait)).collect();
    let ways: Vec<Value> = shift
        .frequencies()
        .into_iter()
        .map(|count| json!({ "cycles": count, "share": count as f64 / shift.cycles.len() as f64 }))
        .collect();
    let signals: Vec<Value> = signals.iter().map(signal_json).collect();
    json!({
        "waits": waits,
        "signals": signals,
        "program": shift.program,
        "cycles": shift.cycles.len(),
        "incomplete": shift.incomplete,
        "ways": ways,
        "file": of.path,
        "notes": notes,
    })
}

fn wait_json(of: Waits<'_>, wait: &Wait) -> Value {
    let place = &wait.samples.key.place;
    let finite = wait.quantiles_s.iter().all(|x| x.is_finite());
    let trend = wait.trend.filter(|_| finite);
    let experiment = wait.experiment.as_ref().map(|experiment| {
        json!({
            "late_s": experiment.late_s,
            "cycles": experiment.cycles,
            "command": experiment.command(&quoted(of.program)),
        })
    });
    let populations = wait
        .populations
        .iter()
        .map(|Population { share, median_s, .. }| json!({ "share": share, "median_s": median_s }));
    json!({
        "file": place.file,
        "line": place.line,
        "signal": wait.samples.key.signal,
        "kind": wait.verdict.kind.word(),
        "reason": wait.verdict.reason.word(),
        "n": wait.samples.samples.len(),
        "quantiles_s": if finite { json!(wait.quantiles_s) } else { Value::Null },
        "experiment": experiment,
        "compared": wait.verdict.cycles,
        "log_odds": wait.verdict.log_odds.clamp(-1e4, 1e4),
        "slope": wait.verdict.slope.map(|s| json!({ "value": s.value, "low": s.low, "high": s.high })),
        "after": wait.after().map(after_json),
        "at_once": wait.at_once,
        "trend_s_per_h": trend.map(|t| json!({ "value": t.per_hour_s, "low": t.low, "high": t.high })),
        "populations": populations.collect::<Vec<_>>(),
        "by_limit": wait.samples.by_limit,
        "left": wait.samples.left,
    })
}

fn after_json(candidate: &Candidate) -> Value {
    let place = place_of(candidate);
    json!({
        "event": candidate.reference.to_string(),
        "file": place.map(|place| &place.file),
        "line": place.map(|place| place.line),
        "before": candidate.reference.before,
    })
}

fn place_of(candidate: &Candidate) -> Option<&Place> {
    match &candidate.reference.kind {
        Kind::Start(place) | Kind::Arrive(place) | Kind::End(place) => Some(place),
        Kind::Output(..) | Kind::Signal(..) | Kind::Cycle => candidate.place.as_ref(),
    }
}

fn signal_json(of: &SignalTime) -> Value {
    json!({
        "signal": of.signal, "level": of.level, "n": of.n, "after": of.after.to_string(),
        "file": of.place.as_ref().map(|place| &place.file),
        "line": of.place.as_ref().map(|place| place.line),
        "median_s": of.median_s, "deviation_s": of.deviation_s,
    })
}

/// Why a wait is of its kind, in words.
pub fn why(wait: &Wait) -> String {
    match wait.verdict.reason {
        Reason::CountsFrom => wait.after().map_or(String::new(), |after| {
            let at = match (&after.reference.kind, &after.place) {
                (Kind::Output(..), Some(place)) => format!(" at {place}"),
                _ => String::new(),
            };
            let time = wait.samples.median_after(after);
            format!("comes {time:.1} s after {}{at}", after.reference)
        }),
        Reason::Answers => "comes after the robot, whenever that is".to_owned(),
        Reason::Stated => "the program states its length".to_owned(),
        Reason::AlwaysThere => "there already in nearly all cycles".to_owned(),
        Reason::TooFew => format!("{} cycles are too few", wait.verdict.cycles),
        Reason::CannotTell => "the log does not tell: see the experiments".to_owned(),
        Reason::Coupled => {
            let later = wait.verdict.slope.map_or(String::new(), |slope| {
                format!(": {:.2} s later for each second", slope.value)
            });
            format!("coupled{later}, never used")
        }
        Reason::Differs => "its executions in a cycle are of different kinds".to_owned(),
    }
}

/// The result as text.
pub fn text(of: Waits<'_>) -> String {
    let Found { shift, waits, signals } = of.found;
    let mut out = String::new();
    let ways = shift.frequencies().len();
    let _ = writeln!(
        out,
        "{} complete cycles in {} session{}, {ways} way{} through the program",
        shift.cycles.len(),
        shift.offsets.len(),
        if shift.offsets.len() == 1 { "" } else { "s" },
        if ways == 1 { "" } else { "s" },
    );
    let header = [
        ("wait", Align::Left),
        ("signal", Align::Left),
        ("kind", Align::Left),
        ("n", Align::Right),
        ("median s", Align::Right),
        ("5-95 % s", Align::Right),
        ("at once", Align::Right),
        ("why", Align::Left),
    ];
    let rows: Vec<Vec<String>> = waits
        .iter()
        .map(|wait| {
            let [low, _, middle, _, high] = wait.quantiles_s;
            let seconds = |x: f64| if x.is_finite() { format!("{x:.2}") } else { "-".to_owned() };
            vec![
                wait.samples.key.place.to_string(),
                wait.samples.key.signal.clone().unwrap_or_default(),
                wait.verdict.kind.word().to_owned(),
                wait.samples.samples.len().to_string(),
                seconds(middle),
                format!("{} .. {}", seconds(low), seconds(high)),
                format!("{:.0} %", 100.0 * wait.at_once),
                why(wait),
            ]
        })
        .collect();
    out.push_str(&table(&header, &rows));
    for wait in waits {
        for line in remarks(wait) {
            let _ = writeln!(out, "{}: {line}", wait.samples.key.place);
        }
        if let Some(line) = of.lines.get(&wait.samples.key.place) {
            let _ = writeln!(out, "{}: {line}", wait.samples.key.place);
        }
    }
    for signal in signals {
        let _ = writeln!(out, "{}", signal_text(signal));
    }
    for wait in waits {
        let Some(experiment) = &wait.experiment else { continue };
        let _ = writeln!(
            out,
            "to tell what {} is, record {} cycles in which the robot comes {} s later every second time:\n    {}",
            wait.samples.key.place,
            experiment.cycles,
            experiment.late_s,
            experiment.command(&quoted(of.program))
        );
    }
    let slack = waits.iter().filter(|wait| wait.verdict.kind == WaitKind::Slack).count();
    let _ = writeln!(
        out,
        "{slack} of {} waits {} slack; {} is for joulepath optimize --waits {}",
        waits.len(),
        if slack == 1 { "is" } else { "are" },
        of.path,
        of.path
    );
    out
}

/// What else is known of a wait, sentence by sentence.
pub fn remarks(wait: &Wait) -> Vec<String> {
    let mut remarks = Vec::new();
    if wait.populations.len() > 1 {
        let all = wait.populations.iter().map(|Population { share, median_s, .. }| {
            let share = 100.0 * share;
            if *median_s == 0.0 {
                format!("already there in {share:.0} % of the cycles")
            } else {
                format!("about {median_s:.1} s in {share:.0} %")
            }
        });
        remarks.push(all.collect::<Vec<_>>().join(", "));
    }
    if let Some(Trend { per_hour_s, low, high }) = wait.trend
        && (low > 0.0 || high < 0.0)
        && per_hour_s.abs() >= LEAST_TREND
    {
        let word = if per_hour_s > 0.0 { "longer" } else { "shorter" };
        remarks.push(format!(
            "{:.2} s {word} with each hour ({low:.2} to {high:.2} s in 95 %)",
            per_hour_s.abs()
        ));
    }
    if wait.samples.by_limit > 0 {
        remarks.push(format!("{} times its time limit ended it", wait.samples.by_limit));
    }
    if wait.samples.left > 0 {
        remarks.push(format!("{} times an error handler left it", wait.samples.left));
    }
    remarks
}

/// Least trend that is told, s/h.
const LEAST_TREND: f64 = 0.02;

/// When a signal comes, in words.
pub fn signal_text(of: &SignalTime) -> String {
    let level = of.level.map_or(String::new(), |level| format!(" = {level}"));
    let at = match (&of.after.kind, &of.place) {
        (Kind::Output(..), Some(place)) => format!(" at {place}"),
        _ => String::new(),
    };
    format!(
        "{}{level} comes {:.2} s ({:.2}) after {}{at}",
        of.signal, of.median_s, of.deviation_s, of.after
    )
}

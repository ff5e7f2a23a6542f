//! The result of a diagnosis as JSON and text.

use std::fmt::Write;

use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::gap::{Budget, Calibration, Diagnosis, Finding, Interval, Place, Verdict};

/// The basis of a result: robot, logs, notes.
#[derive(Clone, Debug, Default)]
pub struct Basis {
    /// The kind of held-out data: `file`, `trajectory` or `cycles`.
    pub heldout: String,
    /// The held-out logs.
    pub graded: Vec<String>,
    /// Path of the written model.
    pub model: String,
    /// Notes for the reader.
    pub notes: Vec<String>,
    /// The next experiment, if one would tell more.
    pub next: Option<Experiment>,
}

/// The JSON of the stable interface.
#[must_use]
pub fn json(found: &Diagnosis, basis: &Basis) -> Value {
    let all = |of: &[Finding], is_asserted: bool| -> Vec<Value> {
        of.iter().map(|of| effect(of, is_asserted, found)).collect()
    };
    let generic = found.remainder.iter().map(|of| {
        json!({
            "id": of.id,
            "joint": of.joint + 1,
            "share_percent": 100.0 * of.share,
        })
    });
    json!({
        "verdict": found.verdict.name(),
        "effects": all(&found.effects, true),
        "candidates": all(&found.candidates, false),
        "generic": generic.collect::<Vec<_>>(),
        "where": found.places.iter().map(place).collect::<Vec<_>>(),
        "gap": gap(found, basis),
        "next_experiment": basis.next,
        "budget": found.budget.iter().map(budget).collect::<Vec<_>>(),
        "everyday_error_percent": found.everyday.iter().map(|x| 100.0 * x).collect::<Vec<_>>(),
        "trail": found.trail,
        "reasons": found.reasons,
        "notes": basis.notes,
        "model": basis.model,
    })
}

fn place(of: &Place) -> Value {
    json!({
        "joint": of.joint.map(|joint| joint + 1),
        "regime": of.regime,
        "file": of.line.as_ref().map(|(file, _)| file),
        "line": of.line.as_ref().map(|(_, line)| line),
        "movement": of.movement,
        "t_start_s": of.span.map(|[start, _]| start),
        "t_end_s": of.span.map(|[_, end]| end),
        "share_percent": 100.0 * of.share,
        "by_effect_percent": by_effect(of),
    })
}

/// Residuals of the held-out logs, by channel.
fn gap(found: &Diagnosis, basis: &Basis) -> Vec<Value> {
    let joints = found.shrink.joints.iter().enumerate().map(|(joint, of)| {
        json!({
            "joint": joint + 1,
            "noise": of.noise,
            "torque": of.torque,
            "model": of.model,
            "refit": of.refit,
            "refit_plus_effect": of.refit_plus_effect,
        })
    });
    let torque = (!found.shrink.joints.is_empty()).then(|| {
        json!({
            "channel": "torque",
            "unit": "Nm",
            "per_joint": joints.collect::<Vec<_>>(),
            "heldout": basis.heldout,
            "shrink_percent": interval(&found.shrink.total),
            "shrink_by_effect_percent": interval(&found.shrink.by_effect),
        })
    });
    let mut gap: Vec<Value> = torque.into_iter().collect();
    for (name, unit, [noise, before, after]) in &found.channels {
        let shrinks = if *before > 0.0 { 100.0 * (1.0 - after / before) } else { 0.0 };
        gap.push(json!({
            "channel": name,
            "unit": unit,
            "per_joint": [{
                "joint": null,
                "noise": noise,
                "model": before,
                "refit": before,
                "refit_plus_effect": after,
            }],
            "heldout": basis.heldout,
            "shrink_percent": {"value": shrinks, "low": null, "high": null},
            "shrink_by_effect_percent": {"value": shrinks, "low": null, "high": null},
        }));
    }
    gap
}

/// Shares of effects; `None` if they are not determined.
fn by_effect(of: &Place) -> Option<Map<String, Value>> {
    let share = |(id, share): &(&'static str, f64)| ((*id).to_owned(), json!(100.0 * share));
    (!of.by_effect.is_empty()).then(|| of.by_effect.iter().map(share).collect())
}

fn interval(of: &Interval) -> Value {
    json!({"value": 100.0 * of.value, "low": 100.0 * of.low, "high": 100.0 * of.high})
}

/// What the gap is made of.
fn budget(of: &Budget) -> Value {
    let effects = of.effects.iter().map(|(id, rms)| ((*id).to_owned(), json!(rms)));
    json!({
        "joint": of.joint.map(|joint| joint + 1),
        "model": of.model,
        "parameters": of.parameters,
        "effects": effects.collect::<Map<_, _>>(),
        "unexplained": of.unexplained,
        "noise": of.noise,
    })
}

/// Share of the squared gap of all joints that an effect takes off.
fn share(of: &Finding, found: &Diagnosis) -> f64 {
    let Some(all) = found.budget.iter().find(|of| of.joint.is_none()) else { return 0.0 };
    let own = all.effects.iter().find(|(id, _)| *id == of.effect.id);
    own.map_or(0.0, |(_, rms)| (rms / all.model.max(f64::MIN_POSITIVE)).powi(2))
}

fn effect(of: &Finding, is_asserted: bool, found: &Diagnosis) -> Value {
    let counted = Calibration::used().count(of.inclusion, is_asserted);
    let parameters = of
        .parameters
        .iter()
        .map(|of| (of.name.clone(), json!({"value": of.value, "sd": of.sd, "unit": of.unit})));
    json!({
        "id": of.effect.id,
        "joints": of.joints.iter().map(|joint| joint + 1).collect::<Vec<_>>(),
        "class": of.class,
        "probability": of.probability(is_asserted),
        "evidence_probability": of.inclusion,
        "counted": counted,
        "parameters": parameters.collect::<Map<_, _>>(),
        "share_percent": 100.0 * share(of, found),
        "nats": of.nats,
        "inspect": of.effect.inspect,
        "size_percent": 100.0 * of.size,
    })
}

/// The next experiment.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Experiment {
    /// What it tells.
    pub why: String,
    /// The command to give afterwards, or the one that writes it.
    pub command: String,
    /// Repetitions of the motion; 0 where it is not written.
    pub cycles: usize,
    /// What the new log would show.
    pub outcomes: Vec<Outcome>,
    /// The written files.
    pub outputs: Vec<String>,
}

/// What a further log would show.
#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    /// What is true.
    pub truth: String,
    /// How much more probable than no effect the logs so far make it \[nats\].
    pub so_far_nats: f64,
    /// By how much it is told from all others \[nats\].
    pub nats: f64,
    /// In words.
    pub text: String,
}

/// Quotes a word of a command line.
#[must_use]
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+:,=".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

/// The text of a verdict.
pub(super) fn sentence(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NoGap => "no gap: model and robot are the same as far as the logs show",
        Verdict::ParametersOnly => "parameters only: no effect, the model's numbers are others",
        Verdict::Effect => "an effect that the model does not have",
        Verdict::Partial => "an effect, and something that no known law explains",
        Verdict::Unknown => "a gap that no known law explains",
        Verdict::NotSeparable => "a gap that more laws explain than these logs can tell apart",
        Verdict::NotExcited => "the motion shows too little",
    }
}

/// The name of an effect and its joints.
#[must_use]
pub fn called(of: &Finding) -> String {
    let joints: Vec<String> = of.joints.iter().map(|joint| (joint + 1).to_string()).collect();
    let place = match joints.len() {
        0 => "the robot".to_owned(),
        _ => format!("joint {}", joints.join(", ")),
    };
    format!("{} of {place}", of.effect.title)
}

/// The same with its probability.
fn with_probability(of: &Finding, is_asserted: bool) -> String {
    let mut text = format!(
        "{}, probability {:.2}, {:.0} nats",
        called(of),
        of.probability(is_asserted),
        of.nats
    );
    let counted = Calibration::used().count(of.inclusion, is_asserted);
    if let Some(counted) = counted.filter(|counted| counted.of > 0) {
        let _ = write!(text, " (was there in {} of {} sealed cases)", counted.there, counted.of);
    }
    text
}

/// What the gap depends on beside the effects.
pub(super) fn unknown(found: &Diagnosis) -> impl Iterator<Item = String> {
    found.remainder.iter().map(|of| {
        let what = match of.id {
            "other" => "no smooth function".to_owned(),
            id => format!(
                "a function of the {}",
                id.replace("_and_sense", " and the sense of motion").replace('_', " ")
            ),
        };
        format!("{:.1} % of the torque of joint {}, {what}", 100.0 * of.share, of.joint + 1)
    })
}

/// The result as text: what the gap is made of, where it is, how far it shrinks, what to do next.
#[must_use]
pub fn text(found: &Diagnosis, basis: &Basis) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "{}", sentence(found.verdict));
    budget_text(&mut out, found, basis);
    if let Some(text) = everyday(found) {
        let _ = writeln!(out, "{text}");
    }
    if let Some(text) = place_text(found) {
        let _ = writeln!(out, "where: {text}");
    }
    for of in &found.places {
        if let Some((file, line)) = &of.line {
            let _ = writeln!(out, "  {file}:{line}, {:.0} % of it", 100.0 * of.share);
        }
    }
    // Without torques there is a gap of the channels alone.
    if !found.budget.is_empty() {
        let _ = writeln!(out, "{}", shrink_text(found, basis));
    }
    for (name, unit, [noise, before, after]) in &found.channels {
        let _ = writeln!(
            out,
            "{name}: rms {before:.4} {unit} before, {after:.4} after, noise {noise:.4}"
        );
    }
    for of in &found.effects {
        let _ = writeln!(out, "\nfound: {}", with_probability(of, true));
        if of.class.len() > 1 {
            let _ = writeln!(out, "  cannot be told apart: {}", of.class.join(", "));
        }
        for parameter in &of.parameters {
            let (name, value, sd) = (&parameter.name, parameter.value, parameter.sd);
            let _ = writeln!(out, "  {name:<20} {value:>12.5} ± {sd:.5} {}", parameter.unit);
        }
        let _ = writeln!(out, "  inspect {}", of.effect.inspect);
    }
    if !found.candidates.is_empty() {
        out.push('\n');
    }
    for of in &found.candidates {
        let _ = writeln!(out, "considered: {}", with_probability(of, false));
    }
    for text in unknown(found) {
        let _ = writeln!(out, "unknown: {text}");
    }
    for reason in &found.reasons {
        let _ = writeln!(out, "not asserted: {reason}");
    }
    if let Some(Experiment { why, command, outcomes, .. }) = &basis.next {
        let _ = writeln!(out, "next: {why}");
        if !command.is_empty() {
            let _ = writeln!(out, "  {command}");
        }
        for Outcome { truth, text, .. } in outcomes {
            let _ = writeln!(out, "  if {truth} is true, {text}");
        }
    }
    if !basis.model.is_empty() {
        let _ = writeln!(out, "model: {}", basis.model);
    }
    out
}

/// The answers of the gates, one a line: the explanation of the verdict.
#[must_use]
pub fn trail(found: &Diagnosis) -> String {
    let mut out = String::from("gates:\n");
    for of in &found.trail {
        let sign = match (of.gate.is_upper(), of.passed) {
            (true, true) => "<=",
            (true, false) => "> ",
            (false, true) => ">=",
            (false, false) => "< ",
        };
        let answer = if of.passed { "passed" } else { "failed" };
        let (name, gate) = (&of.hypothesis, of.gate.what());
        let _ = writeln!(
            out,
            "  {answer}  {name:<36} {:>10.4} {sign} {:<8.4} {gate}",
            of.value, of.limit
        );
    }
    out
}

/// Roots of mean squares in the held-out data; their squares add up.
fn budget_text(out: &mut String, found: &Diagnosis, basis: &Basis) {
    let Some(first) = found.budget.first() else { return };
    let effects = first.effects.iter().map(|(id, _)| *id);
    let columns: Vec<&str> = ["model", "parameters"]
        .into_iter()
        .chain(effects)
        .chain(["unexplained", "noise"])
        .collect();
    let width = columns.iter().map(|name| name.len()).max().unwrap_or(0).max(10);
    let _ = write!(out, "\nrms gap in the held-out {}, squares add up\njoint", basis.heldout);
    for name in &columns {
        let _ = write!(out, " {name:>width$}");
    }
    out.push('\n');
    for of in &found.budget {
        let (name, factor, unit) = match of.joint {
            Some(joint) => (format!("{:>5}", joint + 1), 1.0, "Nm"),
            None => ("  all".to_owned(), 100.0, "% of the torque"),
        };
        let _ = write!(out, "{name}");
        let values = [of.model, of.parameters]
            .into_iter()
            .chain(of.effects.iter().map(|(_, rms)| *rms))
            .chain([of.unexplained, of.noise]);
        for value in values {
            let _ = write!(out, " {:>width$.4}", factor * value);
        }
        let _ = writeln!(out, " {unit}");
    }
}

/// The everyday error of the joints.
fn everyday(found: &Diagnosis) -> Option<String> {
    let percent = found.everyday.iter().map(|x| 100.0 * x);
    let low = percent.clone().fold(f64::INFINITY, f64::min);
    let high = percent.fold(0.0, f64::max);
    low.is_finite().then(|| {
        format!(
            "everyday error: {low:.1} to {high:.1} % of the joints' torques; usual is up to 3 %"
        )
    })
}

/// The joint with most of the gap, and at which speeds, positions and loads most of that is.
fn place_text(found: &Diagnosis) -> Option<String> {
    let by_share = |a: &&Place, b: &&Place| a.share.total_cmp(&b.share);
    let whole = found.places.iter().filter(|of| of.regime == "all" && of.joint.is_some());
    let most = whole.max_by(by_share)?;
    let joint = most.joint?;
    let pieces = || found.places.iter().filter(|of| of.joint == Some(joint) && of.regime != "all");
    let mut mostly = Vec::new();
    for quantity in ["speed", "position", "load"] {
        let of_quantity = || pieces().filter(|of| of.regime.starts_with(quantity));
        let largest = of_quantity().max_by(by_share);
        // A third of the time holds more than half of it.
        if let Some(largest) = largest.filter(|of| of.share > CONCENTRATED * most.share) {
            mostly.push(largest.regime.as_str());
        }
    }
    let mut text = format!("joint {}, {:.0} % of the gap", joint + 1, 100.0 * most.share);
    if !mostly.is_empty() {
        let _ = write!(text, ", mostly at {}", mostly.join(", "));
    }
    Some(text)
}

/// Share of a joint's gap in a third of its motion from which on the third is told.
const CONCENTRATED: f64 = 0.5;

/// How far the gap shrinks.
fn shrink_text(found: &Diagnosis, basis: &Basis) -> String {
    let of = &found.shrink.total;
    let [value, low, high] = [of.value, of.low, of.high].map(|x| 100.0 * x);
    let data = &basis.heldout;
    if value < 0.0 {
        let [value, low, high] = [-value, -high, -low];
        return format!(
            "the gap grows by {value:.1} % ({low:.1} to {high:.1}) in the held-out {data}"
        );
    }
    format!("the gap shrinks by {value:.1} % ({low:.1} to {high:.1}) in the held-out {data}")
}

//! The result of a diagnosis as JSON and text.

use std::fmt::Write;

use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::gap::{Diagnosis, Interval, Place, Said, Verdict};

/// The basis of a result: robot, logs, notes.
#[derive(Clone, Debug, Default)]
pub struct Basis {
    /// The robot as given by the user.
    pub robot: String,
    /// The kind of held-out data: `file`, `trajectory` or `cycles`.
    pub heldout: String,
    /// The held-out logs.
    pub graded: Vec<String>,
    /// Path of the written model.
    pub model: String,
    /// Notes for the reader.
    pub notes: Vec<String>,
}

/// The JSON of the stable interface.
#[must_use]
pub fn json(found: &Diagnosis, basis: &Basis) -> Value {
    let all = |of: &[Said]| -> Vec<Value> { of.iter().map(effect).collect() };
    let generic = found.anything.iter().map(|of| {
        json!({
            "id": of.id,
            "joint": of.joint.map(|joint| joint + 1),
            "share_percent": 100.0 * of.share,
        })
    });
    json!({
        "verdict": found.verdict.name(),
        "effects": all(&found.effects),
        "candidates": all(&found.candidates),
        "generic": generic.collect::<Vec<_>>(),
        "where": found.places.iter().map(place).collect::<Vec<_>>(),
        "gap": gap(found, basis),
        "next_experiment": next(found, basis),
        "model_error_percent": 100.0 * found.error,
        "null_nats": found.chance,
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

fn effect(of: &Said) -> Value {
    let parameters = of
        .parameters
        .iter()
        .map(|of| (of.name.clone(), json!({"value": of.value, "sd": of.sd, "unit": of.unit})));
    json!({
        "id": of.effect.id,
        "joints": of.joints.iter().map(|joint| joint + 1).collect::<Vec<_>>(),
        "class": of.class,
        "probability": of.probability,
        "parameters": parameters.collect::<Map<_, _>>(),
        "share_percent": 100.0 * of.share,
        "nats": of.nats,
        "size_percent": 100.0 * of.size,
    })
}

/// The next experiment: reason and command.
#[derive(Serialize)]
pub(super) struct Experiment {
    why: String,
    command: String,
}

/// The next experiment, if one would tell more.
pub(super) fn next(found: &Diagnosis, basis: &Basis) -> Option<Experiment> {
    let unclear = found.candidates.iter().chain(&found.effects).find(|of| {
        of.class.len() > 1
            || found.verdict != Verdict::Effect && !of.effect.experiment[1].is_empty()
    });
    unclear.map(|of| {
        let [options, why] = of.effect.experiment;
        let robot = quoted(&basis.robot);
        let command = format!("joulepath excite --robot {robot} --out excitation {options}");
        let command = command.trim_end().to_owned();
        Experiment { why: format!("{}: {why}", of.effect.id), command }
    })
}

/// Quotes a word of a command line.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+:".contains(c);
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
        Verdict::Effect => "an effect that the model has not",
        Verdict::Partial => "an effect, and something that no known law explains",
        Verdict::Unknown => "a gap that no known law explains",
        Verdict::NotSeparable => "a gap that more laws explain than these logs can tell apart",
        Verdict::NotExcited => "the motion shows too little",
    }
}

/// The name of an effect and its joints.
#[must_use]
pub fn called(of: &Said) -> String {
    let joints: Vec<String> = of.joints.iter().map(|joint| (joint + 1).to_string()).collect();
    let place = match joints.len() {
        0 => "the robot".to_owned(),
        _ => format!("joint {}", joints.join(", ")),
    };
    format!("{} of {place}", of.effect.title)
}

/// The same with its probability.
fn with_probability(of: &Said) -> String {
    format!("{}, probability {:.2}, {:.0} nats", called(of), of.probability, of.nats)
}

/// What the gap depends on beside the effects.
pub(super) fn unknown(found: &Diagnosis) -> impl Iterator<Item = String> {
    found.anything.iter().map(|of| {
        let joint = of.joint.map_or_else(String::new, |joint| format!(" of joint {}", joint + 1));
        format!("a function of the {}{joint}", of.id.replace('_', " "))
    })
}

/// The result as text.
#[must_use]
pub fn text(found: &Diagnosis, basis: &Basis) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "{}", sentence(found.verdict));
    for of in &found.effects {
        let _ = writeln!(out, "\nfound: {}", with_probability(of));
        if of.class.len() > 1 {
            let _ = writeln!(out, "  cannot be told apart: {}", of.class.join(", "));
        }
        for parameter in &of.parameters {
            let (name, value, sd) = (&parameter.name, parameter.value, parameter.sd);
            let _ = writeln!(out, "  {name:<20} {value:>12.5} ± {sd:.5} {}", parameter.unit);
        }
    }
    for of in &found.places {
        if let Some((file, line)) = &of.line {
            let _ = writeln!(out, "  {file}:{line}, {:.0} % of it", 100.0 * of.share);
        }
    }
    if !found.candidates.is_empty() {
        out.push('\n');
    }
    for of in &found.candidates {
        let _ = writeln!(out, "considered: {}", with_probability(of));
    }
    for text in unknown(found) {
        let _ = writeln!(out, "unknown: {text}");
    }
    for reason in &found.reasons {
        let _ = writeln!(out, "not asserted: {reason}");
    }
    shrinks(&mut out, found, basis);
    if let Some(Experiment { why, command }) = next(found, basis) {
        let _ = writeln!(out, "next: {why}\n  {command}");
    }
    if !basis.model.is_empty() {
        let _ = writeln!(out, "model: {}", basis.model);
    }
    out
}

/// How far the gap shrinks on the held-out logs, as text.
fn shrinks(out: &mut String, found: &Diagnosis, basis: &Basis) {
    if !found.shrink.joints.is_empty() {
        let _ = writeln!(
            out,
            "\nheld-out {}, rms Nm\njoint     noise     model     refit   +effect",
            basis.heldout
        );
        for (joint, of) in found.shrink.joints.iter().enumerate() {
            let _ = writeln!(
                out,
                "{:>5} {:>9.4} {:>9.4} {:>9.4} {:>9.4}",
                joint + 1,
                of.noise,
                of.model,
                of.refit,
                of.refit_plus_effect
            );
        }
        for (name, of) in [("all", &found.shrink.total), ("by effect", &found.shrink.by_effect)] {
            let [value, low, high] = [of.value, of.low, of.high].map(|x| 100.0 * x);
            let _ = if value < 0.0 {
                let [value, low, high] = [-value, -high, -low];
                writeln!(out, "the gap grows, {name}: {value:.1} % ({low:.1} to {high:.1})")
            } else {
                writeln!(out, "the gap shrinks, {name}: {value:.1} % ({low:.1} to {high:.1})")
            };
        }
    }
    for (name, unit, [noise, before, after]) in &found.channels {
        let _ = writeln!(
            out,
            "\nheld-out {}, {name}, rms {unit}: noise {noise:.4}, before {before:.4}, after {after:.4}",
            basis.heldout
        );
    }
}

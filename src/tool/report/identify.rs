//! The result of an identification as JSON, text and as record in its Robot TOML.

use std::fmt::Write;

use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::arm::dynamics::{JOINT, RIGID, parameter_name};
use crate::arm::robot::to_toml;
use crate::learn::identify::{
    Descent, Grade, Identified, Misses, Source, Whiteness, collinear, essential,
};

/// The basis of a result: logs, origin of the torques, notes.
#[derive(Clone, Debug, Default)]
pub struct Basis {
    /// The logs of the fit.
    pub logs: Vec<LogRecord>,
    /// The logs that were only predicted.
    pub validation: Vec<LogRecord>,
    /// The date of recording, if known.
    pub date: Option<String>,
    /// Origin of the torques in words.
    pub torque: String,
    /// Notes for the reader.
    pub notes: Vec<String>,
    /// The paper's fit, for comparison.
    pub descent: Option<Descent>,
}

/// A log that was read.
#[derive(Clone, Debug)]
pub struct LogRecord {
    /// Path as given.
    pub path: String,
    /// SHA-256 of the file.
    pub hash: String,
    /// Number of valid rows.
    pub rows: usize,
    /// Number of rejected rows.
    pub left_out: usize,
}

/// Names and units of the parameters of a joint, as in the model.
const JOINT_KEYS: [&str; JOINT] = ["rotor_inertia", "viscous", "coulomb", "offset"];
const JOINT_UNITS: [&str; JOINT] = ["kg m2", "Nm s/rad", "Nm", "Nm"];

/// The JSON of the stable interface.
pub fn json(found: &Identified, basis: &Basis, path: &str) -> Value {
    let fit = &found.fit;
    let held_out = found.validation.as_ref();
    let names = |rows: &[usize]| rows.iter().map(|row| found.name(*row)).collect::<Vec<_>>();
    json!({
        "robot": found.model.name,
        "base_parameters": base_parameters(found),
        "rank": fit.solution.determined.len(),
        "not_determined": undetermined(found),
        "rms": {
            "train": found.training.rms,
            "validation": held_out.map_or(&found.cross_rms, |misses| &misses.rms),
        },
        "relative_rms": {
            "train": found.training.relative,
            "validation": held_out.map(|misses| &misses.relative),
        },
        "validation_basis": if held_out.is_some() {
            "logs"
        } else if fit.over_repetitions {
            "repetitions"
        } else {
            "cross-validation"
        },
        "unconstrained_rms": {
            "train": fit.rms,
            "validation":
                found.unconstrained_validation.as_ref().map_or(&fit.cross_rms, |misses| &misses.rms),
        },
        "residual_memory": fit.memory,
        "whiteness": whiteness(found),
        "quality": {
            "grade": grade(found.quality.grade), "statement": found.quality.sentence(),
            "explained": found.quality.explained, "predicted": found.quality.predicted,
            "friction_gives_power": found.quality.giving_power.iter().map(|j| j + 1)
                .collect::<Vec<_>>(),
            "torques_late_s": found.quality.late,
        },
        "apparent_torque": {
            "inertia": found.model.sensors.apparent_inertia,
            "viscous": found.model.sensors.apparent_viscous,
        },
        "physically_consistent": found.physically_consistent,
        "condition": {"scaled": fit.condition.scaled, "raw": fit.condition.raw},
        "joints": joints(found),
        "wrist_coupling": {
            "coupling": found.model.wrist.coupling,
            "found_in_data": found.coupling.is_some(),
        },
        "payload": found.payload.as_ref().map(|load| json!({
            "mass": load.mass, "com": load.com.as_slice(),
        })),
        "essential": names(&essential(fit)),
        "collinear": collinear(fit).iter().map(|group| json!({
            "condition_index": group.index, "parameters": names(&group.parameters),
        })).collect::<Vec<_>>(),
        "samples": source(&found.source),
        "torque": basis.torque,
        "logs": logs(&basis.logs),
        "validation_logs": logs(&basis.validation),
        "notes": basis.notes,
        "descent": basis.descent.as_ref().map(descent),
        "model": path,
    })
}

/// A parameter that the data determine.
#[derive(Serialize)]
pub(super) struct Parameter {
    #[serde(skip)]
    pub(super) row: usize,
    pub(super) name: String,
    pub(super) value: f64,
    /// Standard deviation.
    pub(super) sd: f64,
}

/// The parameters that the data determine.
pub(super) fn base_parameters(found: &Identified) -> Vec<Parameter> {
    let fit = &found.fit;
    let determined = fit.solution.determined.iter().enumerate();
    determined
        .map(|(k, row)| Parameter {
            row: *row,
            name: found.name(*row),
            value: fit.solution.beta[*row],
            sd: fit.covariance[(k, k)].max(0.0).sqrt(),
        })
        .collect()
}

fn logs(logs: &[LogRecord]) -> Vec<Value> {
    let log = |log: &LogRecord| {
        json!({
            "path": log.path, "sha256": log.hash, "rows": log.rows, "left_out": log.left_out,
        })
    };
    logs.iter().map(log).collect()
}

fn descent(of: &Descent) -> Value {
    json!({
        "first_rms": of.misses[0], "rms": of.misses[1], "steps": of.steps,
        "rms_by_joint": of.rms,
        "mass": of.links.iter().map(|link| link.mass).collect::<Vec<_>>(),
        "com": of.links.iter().map(|link| link.com.as_slice().to_vec()).collect::<Vec<_>>(),
        "moments": of.links.iter()
            .map(|link| link.inertia.diagonal().as_slice().to_vec()).collect::<Vec<_>>(),
    })
}

fn grade(grade: Grade) -> &'static str {
    match grade {
        Grade::Good => "good",
        Grade::Fair => "fair",
        Grade::Poor => "poor",
        Grade::None => "none",
    }
}

/// Autocorrelation of each joint's residuals.
fn whiteness(found: &Identified) -> Vec<Value> {
    let joint = |(joint, of): (usize, &Option<Whiteness>)| match of {
        Some(of) => json!({
            "joint": joint + 1, "autocorrelation": of.autocorrelation, "band": of.band,
            "outside": of.outside, "ljung_box": of.ljung_box, "p_value": of.p_value,
        }),
        None => json!({"joint": joint + 1, "autocorrelation": null}),
    };
    found.fit.whiteness.iter().enumerate().map(joint).collect()
}

/// An undetermined parameter, with the reason in words.
#[derive(Serialize)]
pub(super) struct Missing {
    name: String,
    joint: usize,
    why: String,
}

/// The undetermined parameters.
pub(super) fn undetermined(found: &Identified) -> Vec<Missing> {
    let name = |row: &usize| parameter_name(found.base.dof, found.base.independent[*row]);
    let missing = found.fit.solution.dependent.iter().map(|(row, parts)| {
        let index = found.base.independent[*row];
        let rigid = RIGID * found.base.dof;
        let joint = if index < rigid { index / RIGID } else { (index - rigid) / JOINT };
        let why = if found.resting.contains(&joint) {
            format!("joint {} was not excited", joint + 1)
        } else if parts.is_empty() {
            "the motion has no torque of it".to_owned()
        } else {
            let with: Vec<String> = parts.iter().map(|(of, _)| name(of)).collect();
            format!("the motion does not tell it from {}", with.join(", "))
        };
        Missing { name: found.base.name(*row), joint: joint + 1, why }
    });
    missing.collect()
}

/// Rotor inertia, friction and offset of each joint with their intervals.
fn joints(found: &Identified) -> Vec<Value> {
    let base = &found.base;
    let determined = base_parameters(found);
    let joint = |joint: usize| {
        let mut entry = Map::new();
        entry.insert("joint".into(), json!(joint + 1));
        entry.insert("excited".into(), json!(!found.resting.contains(&joint)));
        for (kind, (key, unit)) in JOINT_KEYS.iter().zip(JOINT_UNITS).enumerate() {
            let index = RIGID * base.dof + JOINT * joint + kind;
            let row = base.independent.iter().position(|known| *known == index);
            let row = row.filter(|row| found.name(*row) == base.name(*row));
            let parameter = determined.iter().find(|it| Some(it.row) == row);
            let value = parameter.map(|it| json!({ "value": it.value, "sd": it.sd, "unit": unit }));
            entry.insert((*key).into(), json!(value));
        }
        Value::Object(entry)
    };
    (0..base.dof).map(joint).collect()
}

fn source(source: &Source) -> Value {
    match source {
        Source::Logged => json!({"derivatives": "logged"}),
        Source::Filtered { cutoff } => json!({"derivatives": "filtered", "cutoff_hz": cutoff}),
        Source::Periodic { period, periods, harmonics } => json!({
            "derivatives": "fourier", "period_s": period, "periods": periods,
            "harmonics": harmonics,
        }),
    }
}

/// The model as Robot TOML, with a record of its identification.
pub fn toml(found: &Identified, basis: &Basis) -> String {
    let mut text = to_toml(&found.model);
    let quoted = |text: &str| Value::from(text).to_string();
    text.push_str("\n[identification]\n");
    if let Some(date) = &basis.date {
        let _ = writeln!(text, "date = {}", quoted(date));
    }
    let _ = writeln!(text, "torque = {}", quoted(&basis.torque));
    let _ = writeln!(text, "quality = {}", quoted(&found.quality.sentence()));
    let _ = writeln!(text, "rank = {}", found.fit.solution.determined.len());
    let list = |values: &[f64]| -> String {
        // TOML writes `nan` in lower case.
        values.iter().map(|x| format!("{x:?}").to_lowercase()).collect::<Vec<_>>().join(", ")
    };
    let _ = writeln!(text, "rms = [{}]", list(&found.training.rms));
    if let Some(Misses { rms, .. }) = &found.validation {
        let _ = writeln!(text, "validation_rms = [{}]", list(rms));
    }
    for entry in undetermined(found) {
        let _ = write!(
            text,
            "\n[[identification.not_determined]]\nname = {}\nwhy = {}\n",
            quoted(&entry.name),
            quoted(&entry.why)
        );
    }
    for LogRecord { path, hash, rows, left_out } in &basis.logs {
        let _ = write!(
            text,
            "\n[[identification.log]]\npath = {}\nsha256 = \"{hash}\"\nrows = {rows}\n\
             left_out = {left_out}\n",
            quoted(path)
        );
    }
    for Parameter { name, value, sd, .. } in base_parameters(found) {
        let _ = write!(
            text,
            "\n[[identification.base_parameter]]\nname = {}\nvalue = {value:?}\nsd = {sd:?}\n",
            quoted(&name)
        );
    }
    text
}

/// A number, or a dash if not finite.
fn shown(value: f64, decimals: usize) -> String {
    if value.is_finite() { format!("{value:.decimals$}") } else { "-".into() }
}

/// The number of lags of a joint's residuals that are white.
pub(super) fn white(whiteness: Option<&Whiteness>) -> String {
    whiteness.map_or_else(
        || "-".into(),
        |of| format!("{} (p = {:.2})", of.autocorrelation.len() - of.outside, of.p_value),
    )
}

/// The result as text.
pub fn text(found: &Identified, basis: &Basis) -> String {
    let fit = &found.fit;
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{}: {} base parameters determined, condition {:.1} scaled, {:.0} raw",
        found.model.name,
        fit.solution.determined.len(),
        fit.condition.scaled,
        fit.condition.raw
    );
    let _ = writeln!(text, "torque: {}", basis.torque);
    let consistent = if found.physically_consistent { "yes" } else { "no" };
    let _ = writeln!(text, "physically consistent: {consistent}");
    let _ = writeln!(text, "quality: {}", found.quality.sentence());
    let held_out = match &found.validation {
        Some(misses) => ("held-out logs", &misses.rms),
        None if fit.over_repetitions => ("held-out cycles", &found.cross_rms),
        None => ("cross-validated", &found.cross_rms),
    };
    let _ = writeln!(
        text,
        "\njoint  RMS [Nm]  {:>15}  relative [%]  white [lags out of 20]",
        held_out.0
    );
    for joint in 0..found.base.dof {
        let _ = writeln!(
            text,
            "{:>5}  {:>8}  {:>15}  {:>12}  {}",
            joint + 1,
            shown(found.training.rms[joint], 3),
            shown(held_out.1[joint], 3),
            shown(100.0 * found.training.relative[joint], 1),
            white(fit.whiteness[joint].as_ref())
        );
    }
    text.push_str("RMS over the instants at which the joint moves; standing still tells nothing of friction\n");
    if let Some(of) = &basis.descent {
        let each: Vec<String> = of.rms.iter().map(|rms| shown(*rms, 3)).collect();
        let _ = writeln!(
            text,
            "\nby descent: RMS of all {:.3} Nm after {} steps from {:.3} Nm; by joint {}",
            of.misses[1],
            of.steps,
            of.misses[0],
            each.join(" ")
        );
    }
    let _ = writeln!(text, "\n{:>12} {:>12}  parameter", "value", "sd");
    for Parameter { name, value, sd, .. } in base_parameters(found) {
        let _ = writeln!(text, "{value:>12.5} {sd:>12.5}  {name}");
    }
    let missing = undetermined(found);
    if !missing.is_empty() {
        text.push_str("\nnot determined:\n");
        for Missing { name, why, .. } in missing {
            let _ = writeln!(text, "  {name}: {why}");
        }
    }
    text
}

//! The HTML page of an identification, with its limits of validity.

use serde_json::{Value, json};
use tera::Context;

use super::format::{INTERVAL, fixed, percent};
use super::page::{ReportError, render};
use crate::learn::identify::{Identified, collinear, essential};
use crate::tool::report::identify::{
    Basis, LogRecord, Parameter, base_parameters, undetermined, white,
};
use crate::tool::report::svg::{Curve, Plot, Size};

/// Size of the plots, px.
const SIZE: Size = Size { width: 720.0, height: 200.0 };

/// Measured and predicted torques of a log, by sample.
#[derive(Clone, Debug, Default)]
pub struct Traces {
    /// The predicted data in words.
    pub title: String,
    /// Times \[s\].
    pub t: Vec<f64>,
    /// By joint \[Nm\].
    pub measured: Vec<Vec<f64>>,
    /// By joint \[Nm\].
    pub predicted: Vec<Vec<f64>>,
    /// Σ τ q̇ of both \[W\].
    pub power: [Vec<f64>; 2],
}

/// Number of shown digits of a log's hash.
const HASH_DIGITS: usize = 12;

/// The page.
///
/// # Errors
/// A template does not fit its data.
pub fn identify_report(
    found: &Identified,
    basis: &Basis,
    traces: &Traces,
) -> Result<String, ReportError> {
    let fit = &found.fit;
    let alike: Vec<String> = collinear(fit)
        .iter()
        .map(|group| {
            let names: Vec<String> = group.parameters.iter().map(|row| found.name(*row)).collect();
            format!("{} (condition index {:.0})", names.join(" · "), group.index)
        })
        .collect();
    let mut context = Context::new();
    context.insert("robot", &found.model.name);
    context.insert(
        "basis",
        if found.validation.is_some() { "held-out logs" } else { "cross-validated" },
    );
    context.insert("rank", &fit.solution.determined.len());
    context.insert("scaled", &fixed(fit.condition.scaled, 1));
    context.insert("raw", &fixed(fit.condition.raw, 0));
    context.insert("consistent", &found.physically_consistent);
    context.insert("torque", &basis.torque);
    context.insert("joints", &joint_rows(found));
    context.insert("parameters", &parameter_rows(found));
    context.insert("missing", &undetermined(found));
    context.insert("alike", &alike);
    context.insert("notes", &basis.notes);
    context.insert("quality", &found.quality.sentence());
    let log = |log: &LogRecord| {
        json!({
            "path": log.path,
            "hash": log.hash.chars().take(HASH_DIGITS).collect::<String>(),
            "rows": log.rows,
            "left_out": log.left_out,
        })
    };
    context.insert("logs", &basis.logs.iter().map(log).collect::<Vec<_>>());
    context.insert("date", &basis.date);
    context.insert("coupling", &found.coupling.map(|coupling| fixed(coupling, 3)));
    context.insert("title", &traces.title);
    context.insert("plots", &plots(traces));
    render(include_str!("../../../../templates/identify.html.tera"), context)
}

fn joint_rows(found: &Identified) -> Vec<Value> {
    let fit = &found.fit;
    let held_out = found.validation.as_ref().map_or(&found.cross_rms, |misses| &misses.rms);
    let free = found.unconstrained_validation.as_ref().map_or(&fit.cross_rms, |misses| &misses.rms);
    let row = |joint: usize| {
        json!({
            "joint": joint + 1,
            "train": fixed(found.training.rms[joint], 3),
            "held_out": fixed(held_out[joint], 3),
            "free": fixed(free[joint], 3),
            "relative": percent(found.training.relative[joint]),
            "memory": fixed(fit.memory[joint], 2),
            "white": white(fit.whiteness[joint].as_ref()),
        })
    };
    (0..found.base.dof).map(row).collect()
}

fn parameter_rows(found: &Identified) -> Vec<Value> {
    let kept = essential(&found.fit);
    let row = |it: Parameter| {
        json!({
            "name": it.name,
            "value": fixed(it.value, 5),
            "low": fixed(it.value - INTERVAL * it.sd, 5),
            "high": fixed(it.value + INTERVAL * it.sd, 5),
            "essential": kept.contains(&it.row),
        })
    };
    base_parameters(found).into_iter().map(row).collect()
}

fn plots(traces: &Traces) -> Vec<String> {
    let first = traces.t.first().copied().unwrap_or(0.0);
    let curve = |class: &str, values: &[f64]| {
        Curve::new(class, traces.t.iter().zip(values).map(|(t, y)| [t - first, *y]))
    };
    let plot = |name: &str, y_title: &str, curves: Vec<Curve>| {
        Plot { name, x_title: "time (s)", y_title, curves, rules: Vec::new() }.svg(SIZE)
    };
    let joints = traces.measured.iter().zip(&traces.predicted).enumerate();
    let mut plots: Vec<String> = joints
        .map(|(joint, (measured, predicted))| {
            let residual: Vec<f64> = measured.iter().zip(predicted).map(|(a, b)| a - b).collect();
            plot(
                &format!("torque of joint {}", joint + 1),
                &format!("joint {} (Nm)", joint + 1),
                vec![curve("j1", measured), curve("j2", predicted), curve("j3", &residual)],
            )
        })
        .collect();
    let [measured, predicted] = &traces.power;
    let curves = vec![curve("j1", measured), curve("j2", predicted)];
    plots.push(plot("mechanical power of all joints", "power (W)", curves));
    plots
}

//! The HTML page of an identification, with its limits of validity.

use serde::Serialize;
use tera::Context;

use super::format::{INTERVAL, fixed};
use super::page::{ReportError, render};
use crate::learn::identify::{Identified, collinear, essential};
use crate::tool::report::identify::{Basis, LogRecord, undetermined, white};
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

#[derive(Serialize)]
struct JointRow {
    joint: usize,
    train: String,
    held_out: String,
    free: String,
    relative: String,
    memory: String,
    white: String,
}

#[derive(Serialize)]
struct ParameterRow {
    name: String,
    value: String,
    low: String,
    high: String,
    essential: bool,
}

#[derive(Serialize)]
struct LogRow {
    path: String,
    hash: String,
    rows: usize,
    left_out: usize,
}

/// Number of shown digits of a log's hash.
const SHOWN: usize = 12;

#[derive(Serialize)]
struct Missing {
    name: String,
    why: String,
}

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
    let missing: Vec<Missing> = undetermined(found)
        .iter()
        .map(|entry| {
            let part = |key: &str| entry[key].as_str().unwrap_or_default().to_owned();
            Missing { name: part("name"), why: part("why") }
        })
        .collect();
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
    context.insert("missing", &missing);
    context.insert("alike", &alike);
    context.insert("notes", &basis.notes);
    context.insert("quality", &found.quality.sentence());
    let log = |log: &LogRecord| LogRow {
        path: log.path.clone(),
        hash: log.hash.chars().take(SHOWN).collect(),
        rows: log.rows,
        left_out: log.left_out,
    };
    context.insert("logs", &basis.logs.iter().map(log).collect::<Vec<_>>());
    context.insert("date", &basis.date);
    context.insert("coupling", &found.coupling.map(|coupling| fixed(coupling, 3)));
    context.insert("title", &traces.title);
    context.insert("plots", &plots(traces));
    render(include_str!("../../../../templates/identify.html.tera"), context)
}

fn joint_rows(found: &Identified) -> Vec<JointRow> {
    let fit = &found.fit;
    let held_out = found.validation.as_ref().map_or(&found.cross_rms, |misses| &misses.rms);
    let free = found.unconstrained_validation.as_ref().map_or(&fit.cross_rms, |misses| &misses.rms);
    (0..found.base.dof)
        .map(|joint| JointRow {
            joint: joint + 1,
            train: fixed(found.training.rms[joint], 3),
            held_out: fixed(held_out[joint], 3),
            free: fixed(free[joint], 3),
            relative: fixed(100.0 * found.training.relative[joint], 1),
            memory: fixed(fit.memory[joint], 2),
            white: white(fit.whiteness[joint].as_ref()),
        })
        .collect()
}

fn parameter_rows(found: &Identified) -> Vec<ParameterRow> {
    let fit = &found.fit;
    let kept = essential(fit);
    let row = |(k, row): (usize, &usize)| {
        let (value, sd) = (fit.solution.beta[*row], fit.covariance[(k, k)].max(0.0).sqrt());
        ParameterRow {
            name: found.name(*row),
            value: fixed(value, 5),
            low: fixed(value - INTERVAL * sd, 5),
            high: fixed(value + INTERVAL * sd, 5),
            essential: kept.contains(row),
        }
    };
    fit.solution.determined.iter().enumerate().map(row).collect()
}

fn plots(traces: &Traces) -> Vec<String> {
    let first = traces.t.first().copied().unwrap_or(0.0);
    let curve = |class: &str, values: &[f64]| Curve {
        class: class.to_owned(),
        points: traces.t.iter().zip(values).map(|(t, y)| [t - first, *y]).collect(),
    };
    let joints = traces.measured.iter().zip(&traces.predicted).enumerate();
    let mut plots: Vec<String> = joints
        .map(|(joint, (measured, predicted))| {
            let residual: Vec<f64> = measured.iter().zip(predicted).map(|(a, b)| a - b).collect();
            let plot = Plot {
                name: &format!("torque of joint {}", joint + 1),
                x_title: "time (s)",
                y_title: &format!("joint {} (Nm)", joint + 1),
                curves: vec![curve("j1", measured), curve("j2", predicted), curve("j3", &residual)],
                rules: Vec::new(),
            };
            plot.svg(SIZE)
        })
        .collect();
    let [measured, predicted] = &traces.power;
    let plot = Plot {
        name: "mechanical power of all joints",
        x_title: "time (s)",
        y_title: "power (W)",
        curves: vec![curve("j1", measured), curve("j2", predicted)],
        rules: Vec::new(),
    };
    plots.push(plot.svg(SIZE));
    plots
}

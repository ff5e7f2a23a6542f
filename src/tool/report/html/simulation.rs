//! The report of a simulation: cycle as bars over time, power, joints with limits, source with
//! times and energies.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::{Value, json};
use tera::Context;

use super::figure::{Figure, LIMITS, figure};
use super::format::{joules, seconds};
use super::page::{ReportError, render};
use super::proof::unresolved;
use super::source::{at_span, shown_lines, text};
use crate::arm::robot::Model;
use crate::rapid::text::SourceFile;
use crate::retime::energy::trajectory::Sample;
use crate::retime::motion::timeline::WaitBasis;
use crate::retime::path::joint_path::DOF;
use crate::tool::report::place::Places;
use crate::tool::report::plausible::energies;
use crate::tool::report::simulated::{Simulated, Step, StepKind};
use crate::tool::report::svg::{Curve, Scale, Size, escape};

const SIZE: Size = Size { width: 1260.0, height: 280.0 };
/// Maximum number of points of a curve.
const MAX_POINTS: usize = 6000;
/// Maximum number of bar rows for statements; with more, each row is a routine.
const MAX_ROWS: usize = 60;
/// Height of a row, width of its name, and height of the axis, px.
const ROW: f64 = 20.0;
const NAMES: f64 = 300.0;
const AXIS: f64 = 34.0;
/// Width of a wait of unknown length, which counts as 0 s, px.
const UNKNOWN_WIDTH: f64 = 3.0;
/// Number of ticks on the time axis.
const TICKS: usize = 10;
/// Number of lines shown around lines with costs.
const CONTEXT: u32 = 2;

/// The HTML report of a simulation. `samples`: its planned motion; `files` are indexed by file id.
///
/// # Errors
/// A template does not fit its data.
pub fn simulate_report(
    of: Simulated<'_>,
    samples: &[Sample],
    files: &[SourceFile],
) -> Result<String, ReportError> {
    let Simulated { model, entry, simulation, account, plausible } = of;
    let places = Places::new(files);
    let steps = of.steps();
    let known = model.has_dynamics();
    let mut context = Context::new();
    context.insert("robot", &model.name);
    context.insert("entry", entry);
    context.insert("cycle", &seconds(simulation.cycle_s));
    context.insert("energy", &known.then(|| joules(account.total.energy_j())));
    context.insert("motion_energy", &known.then(|| joules(account.total.motion_energy_j())));
    context.insert("plausible", &plausible.map(energies).unwrap_or_default());
    let count = |is: fn(StepKind<'_>) -> bool| steps.iter().filter(|step| is(step.kind)).count();
    context.insert("movements", &count(|kind| matches!(kind, StepKind::Move(_))));
    context.insert("waits", &count(|kind| matches!(kind, StepKind::Wait(_))));
    context.insert("unknown", &count(|kind| matches!(kind, StepKind::Wait(WaitBasis::Unknown))));
    context.insert("bars", &bars(&steps, simulation.cycle_s, places));
    context.insert("figures", &figures(model, samples));
    context.insert("joints", &(1..=DOF).collect::<Vec<usize>>());
    context.insert("sources", &sources(&steps, files, known));
    context.insert("unresolved", &unresolved(simulation, places));
    let mut assumed = simulation.assumed.clone();
    assumed.extend(model.assumed());
    context.insert("assumed", &assumed);
    render(include_str!("../../../../templates/simulation.html.tera"), context)
}

/// The cycle as bars over time: a row per statement in order of the first execution, or per routine
/// if there are too many.
fn bars(steps: &[Step<'_>], cycle: f64, places: Places<'_>) -> String {
    let shared = shared_folder(steps.iter().map(|step| places.of(step.span).file));
    let statement = |step: &Step<'_>| {
        let place = places.of(step.span).to_string();
        format!("{} {}", place.get(shared..).unwrap_or(&place), step.instruction)
    };
    let routine = |step: &Step<'_>| step.routine.to_owned();
    let mut rows = rows(steps, statement);
    if rows.len() > MAX_ROWS {
        rows = self::rows(steps, routine);
        rows.truncate(MAX_ROWS);
    }
    let scale = Scale::exact(0.0, cycle, TICKS);
    let height = ROW * rows.len() as f64 + AXIS;
    let (left, right) = (NAMES, SIZE.width - 14.0);
    let at = |t: f64| left + scale.share(t) * (right - left);
    let mut out = format!(
        "<svg viewBox=\"0 0 {:.0} {height:.0}\" role=\"img\" aria-label=\"the cycle by \
         instruction\">",
        SIZE.width
    );
    let bottom = height - AXIS;
    for (value, label) in scale.ticks() {
        let x = at(value);
        let _ = write!(
            out,
            "<line class=\"grid\" x1=\"{x:.1}\" y1=\"0\" x2=\"{x:.1}\" y2=\"{bottom:.1}\"/>\
             <text class=\"tick middle\" x=\"{x:.1}\" y=\"{:.1}\">{label}</text>",
            bottom + 15.0
        );
    }
    for (i, (name, members)) in rows.iter().enumerate() {
        let y = ROW * i as f64;
        let _ = write!(
            out,
            "<text class=\"tick end\" x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            left - 8.0,
            y + 0.7 * ROW,
            escape(&shortened(name))
        );
        for step in members {
            let (a, b) = (at(step.t_start), at(step.t_start + step.duration));
            let (class, least) = match step.kind {
                StepKind::Wait(WaitBasis::Unknown) => ("friction", UNKNOWN_WIDTH),
                StepKind::Wait(_) => ("idle", 0.5),
                StepKind::Move(_) => ("mechanical", 0.5),
            };
            let _ = write!(
                out,
                "<rect class=\"part {class}\" x=\"{a:.1}\" y=\"{:.1}\" width=\"{:.1}\" \
                 height=\"{:.1}\"><title>{} {}: {} s from {} s, {} J</title></rect>",
                y + 3.0,
                (b - a).max(least),
                ROW - 6.0,
                escape(&places.of(step.span).to_string()),
                escape(step.instruction),
                seconds(step.duration),
                seconds(step.t_start),
                joules(step.energy_j),
            );
        }
    }
    let _ = write!(
        out,
        "<text class=\"title end\" x=\"{right:.1}\" y=\"{:.1}\">time (s)</text></svg>",
        height - 5.0
    );
    out
}

/// Length of the longest common folder prefix of all paths, separator included.
fn shared_folder(paths: impl Iterator<Item = String>) -> usize {
    let folder = |path: &str| path.rfind('/').map_or(0, |at| at + 1);
    let mut shared: Option<String> = None;
    for path in paths {
        let mut prefix = shared.unwrap_or_else(|| path[..folder(&path)].to_owned());
        while !path.starts_with(&prefix) {
            prefix.truncate(folder(prefix.trim_end_matches('/')));
        }
        shared = Some(prefix);
    }
    shared.map_or(0, |prefix| prefix.len())
}

/// Groups the steps by name, in order of the first step of each name.
fn rows<'s, 'a>(
    steps: &'s [Step<'a>],
    name: impl Fn(&Step<'a>) -> String,
) -> Vec<(String, Vec<&'s Step<'a>>)> {
    let mut place: BTreeMap<String, usize> = BTreeMap::new();
    let mut rows: Vec<(String, Vec<&Step<'a>>)> = Vec::new();
    for step in steps {
        let name = name(step);
        let index = *place.entry(name.clone()).or_insert(rows.len());
        if index == rows.len() {
            rows.push((name, Vec::new()));
        }
        rows[index].1.push(step);
    }
    rows
}

/// The last characters of a long name.
fn shortened(name: &str) -> String {
    const CHARACTERS: usize = 46;
    let count = name.chars().count();
    if count <= CHARACTERS {
        return name.to_owned();
    }
    let rest: String = name.chars().skip(count - CHARACTERS).collect();
    format!("\u{2026}{rest}")
}

fn figures(model: &Model, samples: &[Sample]) -> Vec<Figure> {
    let stride = samples.len().div_ceil(MAX_POINTS).max(1);
    let chosen: Vec<&Sample> = samples.iter().step_by(stride).collect();
    let one = |value: &dyn Fn(&Sample) -> f64| {
        vec![Curve::new("one", chosen.iter().map(|s| [s.t, value(s)]))]
    };
    let joints = |value: &dyn Fn(&Sample, usize) -> f64| -> Vec<Curve> {
        let points = |j| chosen.iter().map(move |s| [s.t, value(s, j)]);
        (0..DOF).map(|j| Curve::new(format!("j{}", j + 1), points(j))).collect()
    };
    let limits = &model.limits;
    let share = "share of the limit (%)";
    let mut figures = Vec::new();
    if model.has_dynamics() {
        let curves = one(&|s| s.electrical_w.unwrap_or(f64::NAN));
        figures.push(figure("Electrical power", "power (W)", curves, &[], SIZE));
    }
    figures.push(figure("TCP speed", "speed (m/s)", one(&|s| s.tcp_speed), &[], SIZE));
    // −100 % at the lower end of the range, 100 % at the upper one.
    let place = joints(&|s, j| {
        let [low, high] = limits.position_at(&s.state.q, j);
        100.0 * (2.0 * s.state.q[j] - low - high) / (high - low)
    });
    figures.push(figure("Joint positions in their ranges", share, place, &LIMITS, SIZE));
    if let Some(limit) = &limits.velocity {
        let curves = joints(&|s, j| 100.0 * s.state.qd[j] / limit[j]);
        figures.push(figure("Joint speeds", share, curves, &LIMITS, SIZE));
    }
    if let Some(limit) = &limits.acceleration {
        let curves = joints(&|s, j| 100.0 * s.state.qdd[j] / limit[j]);
        figures.push(figure("Joint accelerations", share, curves, &LIMITS, SIZE));
    }
    if let Some(limit) = &limits.torque {
        let tau = |s: &Sample, j: usize| s.power.as_ref().map_or(f64::NAN, |p| p.tau[j]);
        let curves = joints(&|s, j| 100.0 * tau(s, j) / limit[j]);
        figures.push(figure("Joint torques", share, curves, &LIMITS, SIZE));
    }
    figures
}

/// The files with steps, with time and energy by line.
fn sources(steps: &[Step<'_>], files: &[SourceFile], known: bool) -> Vec<Value> {
    let mut costs: Vec<BTreeMap<u32, [f64; 2]>> = vec![BTreeMap::new(); files.len()];
    for step in steps {
        if let Some((costs, [line, _])) = at_span(files, &mut costs, step.span) {
            let line = costs.entry(line).or_default();
            line[0] += step.duration;
            line[1] += step.energy_j;
        }
    }
    let hottest = costs.iter().flat_map(BTreeMap::values).map(|cost| cost[1]).fold(0.0, f64::max);
    let used = files.iter().zip(&costs).filter(|(_, costs)| !costs.is_empty());
    used.map(|(file, costs)| annotated(file, costs, hottest, known)).collect()
}

/// `hottest`: energy of the most expensive line of all files, J.
fn annotated(
    file: &SourceFile,
    costs: &BTreeMap<u32, [f64; 2]>,
    hottest: f64,
    known: bool,
) -> Value {
    let ranges = costs.keys().map(|line| (*line, *line));
    let line = |(number, gap): (u32, u32)| {
        let cost = costs.get(&number);
        let hot = cost.filter(|cost| cost[1] > 0.0 && known);
        json!({
            "number": number,
            "gap": gap,
            "text": text(file, number),
            "time": cost.map(|cost| seconds(cost[0])),
            "energy": cost.filter(|_| known).map(|cost| joules(cost[1])),
            "heat": hot.map(|cost| format!("{:.0}", 100.0 * cost[1] / hottest)),
        })
    };
    let energy = joules(costs.values().map(|cost| cost[1]).sum());
    let lines: Vec<Value> = shown_lines(file, ranges, CONTEXT).into_iter().map(line).collect();
    json!({ "path": file.path, "energy": energy, "lines": lines })
}

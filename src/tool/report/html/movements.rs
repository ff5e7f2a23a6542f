//! Plots of each rewritten segment: before and after over time.

use serde::Serialize;

use super::format::{joules, seconds};
use super::samples::{Sample, samples};
use super::segments::numbered;
use super::ways::{Way, ways};
use crate::arm::robot::Model;
use crate::retime::energy::{Account, EnergyParts};
use crate::retime::optimize::corridor::Corridor;
use crate::retime::optimize::freedom::Freedom;
use crate::retime::path::joint_path::{DOF, Joints};
use crate::tool::report::place::Places;
use crate::tool::report::svg::{Curve, NEAR, Plot, Rule, Size};
use crate::tool::retrofit::Retrofit;

/// Maximum number of plotted variants, those with the largest savings; more make the page slow.
const MAX_PLOTTED: usize = 60;
/// Size of each plot, px.
const SIZE: Size = Size { width: 620.0, height: 250.0 };
/// Label of the abscissa.
const TIME: &str = "time (s)";

#[derive(Serialize)]
pub(super) struct Movement {
    number: usize,
    place: String,
    ways: Vec<WayPlots>,
    /// Number of variants without plots.
    left_out: usize,
}

/// The plots of one variant.
#[derive(Serialize)]
struct WayPlots {
    name: String,
    executions: usize,
    time_before: String,
    time_after: String,
    energy_before: String,
    energy_after: String,
    plots: Vec<Figure>,
}

/// A plot with its caption.
#[derive(Serialize)]
struct Figure {
    caption: &'static str,
    svg: String,
}

pub(super) fn movements(retrofit: &Retrofit, model: &Model, places: Places<'_>) -> Vec<Movement> {
    let rewritten: Vec<_> = numbered(retrofit)
        .filter(|(_, segment)| segment.rewritten)
        .map(|(number, segment)| (number, segment.span, ways(retrofit, segment)))
        .collect();
    let least = least_plotted(retrofit, rewritten.iter().flat_map(|(.., ways)| ways));
    rewritten
        .into_iter()
        .map(|(number, span, ways)| {
            let all = ways.len();
            let plotted: Vec<WayPlots> = ways
                .iter()
                .enumerate()
                .filter(|(_, way)| saved(retrofit, way) >= least)
                .map(|(i, way)| way_plots(retrofit, model, way, i, all))
                .collect();
            Movement {
                number,
                place: places.of(span).to_string(),
                left_out: all - plotted.len(),
                ways: plotted,
            }
        })
        .collect()
}

/// Minimum saving of a plotted variant, J.
fn least_plotted<'a>(retrofit: &Retrofit, ways: impl Iterator<Item = &'a Way<'a>>) -> f64 {
    let mut savings: Vec<f64> = ways.map(|way| saved(retrofit, way)).collect();
    savings.sort_by(|a, b| b.total_cmp(a));
    savings.get(MAX_PLOTTED - 1).copied().unwrap_or(f64::NEG_INFINITY)
}

/// Saving over all executions of a variant, J.
fn saved(retrofit: &Retrofit, way: &Way<'_>) -> f64 {
    let [before, after] = energies(retrofit, way);
    (before - after) * way.executions as f64
}

/// Energy of one execution before and after, J.
fn energies(retrofit: &Retrofit, way: &Way<'_>) -> [f64; 2] {
    let energy = |account: &Account| -> f64 {
        account.events.get(way.event).into_iter().flatten().map(EnergyParts::energy_j).sum()
    };
    [energy(&retrofit.before.1), energy(&retrofit.after.1)]
}

fn way_plots(
    retrofit: &Retrofit,
    model: &Model,
    way: &Way<'_>,
    index: usize,
    all: usize,
) -> WayPlots {
    let corridor = Corridor::new(model, way.before, &Freedom::default());
    let sides = [way.before, way.after].map(|run| samples(model, run, corridor.as_ref()));
    let [energy_before, energy_after] = energies(retrofit, way).map(joules);
    WayPlots {
        name: if all > 1 { format!("way {} of {all}", index + 1) } else { String::new() },
        executions: way.executions,
        time_before: seconds(way.before.duration()),
        time_after: seconds(way.after.duration()),
        energy_before,
        energy_after,
        plots: plots(model, &sides),
    }
}

fn plots(model: &Model, sides: &[Vec<Sample>; 2]) -> Vec<Figure> {
    let mut figures = Vec::new();
    if let Some(limit) = &model.limits.velocity {
        figures
            .push(shares("Joint speeds", "share of the speed limit (%)", sides, limit, |s| s.qd));
    }
    if let Some(limit) = &model.limits.torque {
        let title = "share of the torque limit (%)";
        figures.push(shares("Joint torques", title, sides, limit, |s| s.tau));
    }
    figures.push(figure("Electrical power", "power (W)", pair(sides, |s| s.electrical_w), vec![]));
    let mut curves = pair(sides, |s| s.tcp_speed);
    curves.insert(0, ceiling(sides));
    figures.push(figure("TCP speed", "speed (m/s)", curves, vec![]));
    figures
}

/// The maximum TCP speed over the time of the new motion, if the speeds come near it.
fn ceiling(sides: &[Vec<Sample>; 2]) -> Curve {
    let fastest = sides.iter().flatten().map(|s| s.tcp_speed).fold(0.0, f64::max);
    let near = |s: &Sample| if NEAR * s.ceiling <= fastest { s.ceiling } else { f64::NAN };
    Curve { class: "ceiling".into(), points: sides[1].iter().map(|s| [s.t, near(s)]).collect() }
}

/// Signed shares of the limits of six joints.
fn shares(
    caption: &'static str,
    title: &'static str,
    sides: &[Vec<Sample>; 2],
    limit: &[f64],
    value: impl Fn(&Sample) -> Joints,
) -> Figure {
    let mut curves = Vec::new();
    for (side, samples) in ["before", "after"].into_iter().zip(sides) {
        for j in 0..DOF.min(limit.len()) {
            curves.push(Curve {
                class: format!("{side} j{}", j + 1),
                points: samples.iter().map(|s| [s.t, 100.0 * value(s)[j] / limit[j]]).collect(),
            });
        }
    }
    let rules = vec![Rule { value: 100.0, label: "limit" }, Rule { value: -100.0, label: "limit" }];
    figure(caption, title, curves, rules)
}

/// One quantity before and after.
fn pair(sides: &[Vec<Sample>; 2], value: impl Fn(&Sample) -> f64) -> Vec<Curve> {
    ["before", "after"]
        .into_iter()
        .zip(sides)
        .map(|(side, samples)| Curve {
            class: format!("{side} one"),
            points: samples.iter().map(|s| [s.t, value(s)]).collect(),
        })
        .collect()
}

fn figure(
    caption: &'static str,
    title: &'static str,
    curves: Vec<Curve>,
    rules: Vec<Rule>,
) -> Figure {
    let plot = Plot { name: caption, x_title: TIME, y_title: title, curves, rules };
    Figure { caption, svg: plot.svg(SIZE) }
}

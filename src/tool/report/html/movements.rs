//! Plots of each rewritten segment: before and after over time.

use serde_json::{Value, json};

use super::figure::{Figure, LIMITS, figure};
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
use crate::tool::report::svg::{Curve, NEAR, Size};
use crate::tool::retrofit::Retrofit;

/// Maximum number of plotted variants, those with the largest savings; more make the page slow.
const MAX_PLOTTED: usize = 60;
/// Size of each plot, px.
const SIZE: Size = Size { width: 620.0, height: 250.0 };

/// The rewritten segments with the plots of their variants, for the template.
pub(super) fn movements(retrofit: &Retrofit, model: &Model, places: Places<'_>) -> Vec<Value> {
    let rewritten: Vec<_> = numbered(retrofit)
        .filter(|(_, segment)| segment.rewritten)
        .map(|(number, segment)| (number, segment, ways(retrofit, segment)))
        .collect();
    let least = least_plotted(retrofit, rewritten.iter().flat_map(|(.., ways)| ways));
    rewritten
        .into_iter()
        .map(|(number, segment, ways)| {
            let all = ways.len();
            let plotted: Vec<Value> = ways
                .iter()
                .enumerate()
                .filter(|(_, way)| saved(retrofit, way) >= least)
                .map(|(i, way)| way_plots(retrofit, model, way, i, all))
                .collect();
            json!({
                "number": number,
                "place": places.of_pieces(&segment.pieces),
                // Variants without plots.
                "left_out": all - plotted.len(),
                "ways": plotted,
            })
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

fn way_plots(retrofit: &Retrofit, model: &Model, way: &Way<'_>, index: usize, all: usize) -> Value {
    let corridor = Corridor::new(model, way.before, &Freedom::default());
    let sides = [way.before, way.after].map(|run| samples(model, run, corridor.as_ref()));
    let [energy_before, energy_after] = energies(retrofit, way).map(joules);
    json!({
        "name": if all > 1 { format!("way {} of {all}", index + 1) } else { String::new() },
        "executions": way.executions,
        "time_before": seconds(way.before.duration()),
        "time_after": seconds(way.after.duration()),
        "energy_before": energy_before,
        "energy_after": energy_after,
        "plots": plots(model, &sides),
    })
}

fn plots(model: &Model, sides: &[Vec<Sample>; 2]) -> Vec<Figure> {
    let mut figures = Vec::new();
    if let Some(limit) = &model.limits.velocity {
        let curves = shares(sides, limit, |s| s.qd);
        let title = "share of the speed limit (%)";
        figures.push(figure("Joint speeds", title, curves, &LIMITS, SIZE));
    }
    if let Some(limit) = &model.limits.torque {
        let curves = shares(sides, limit, |s| s.tau);
        let title = "share of the torque limit (%)";
        figures.push(figure("Joint torques", title, curves, &LIMITS, SIZE));
    }
    let power = pair(sides, |s| s.electrical_w);
    figures.push(figure("Electrical power", "power (W)", power, &[], SIZE));
    let mut curves = pair(sides, |s| s.tcp_speed);
    curves.insert(0, ceiling(sides));
    figures.push(figure("TCP speed", "speed (m/s)", curves, &[], SIZE));
    figures
}

/// The maximum TCP speed over the time of the new motion, if the speeds come near it.
fn ceiling(sides: &[Vec<Sample>; 2]) -> Curve {
    let fastest = sides.iter().flatten().map(|s| s.tcp_speed).fold(0.0, f64::max);
    let near = |s: &Sample| if NEAR * s.ceiling <= fastest { s.ceiling } else { f64::NAN };
    Curve::new("ceiling", sides[1].iter().map(|s| [s.t, near(s)]))
}

/// Signed shares of the limits of six joints.
fn shares(
    sides: &[Vec<Sample>; 2],
    limit: &[f64],
    value: impl Fn(&Sample) -> Joints,
) -> Vec<Curve> {
    let mut curves = Vec::new();
    for (side, samples) in ["before", "after"].into_iter().zip(sides) {
        for j in 0..DOF.min(limit.len()) {
            let points = samples.iter().map(|s| [s.t, 100.0 * value(s)[j] / limit[j]]);
            curves.push(Curve::new(format!("{side} j{}", j + 1), points));
        }
    }
    curves
}

/// One quantity before and after.
fn pair(sides: &[Vec<Sample>; 2], value: impl Fn(&Sample) -> f64) -> Vec<Curve> {
    let sides = ["before", "after"].into_iter().zip(sides);
    sides
        .map(|(side, samples)| {
            Curve::new(format!("{side} one"), samples.iter().map(|s| [s.t, value(s)]))
        })
        .collect()
}

//! The report of a proof: the verdict, the two distributions, the terms, what was adjusted and left out.

use std::fmt::Write as _;

use serde::Serialize;
use tera::Context;

use super::energy_time::scale;
use super::format::{fixed, joules, seconds};
use super::page::{ReportError, render};
use crate::tool::cell::prove::Proof;
use crate::tool::report::prove::stratum_row;
use crate::tool::report::prove_words::{remarks, sentence, terms};
use crate::tool::report::svg::{Frame, Scale, Size, points};

const SIZE: Size = Size { width: 1000.0, height: 340.0 };
/// Points of a density.
const POINTS: usize = 160;

#[derive(Serialize)]
struct Term {
    name: &'static str,
    here: String,
}

#[derive(Serialize)]
struct Need {
    effect: String,
    cycles: String,
}

/// The HTML report of `prove`; `command` is the next step where measurement and promise differ.
///
/// # Errors
/// A template does not fit its data.
pub fn prove_report(proof: &Proof, command: &str) -> Result<String, ReportError> {
    let mut context = Context::new();
    context.insert("sentence", &sentence(proof));
    let percent = |share: f64| fixed(100.0 * share, 1);
    context.insert("saving", &percent(proof.saving.value));
    let interval = proof.saving.interval;
    let interval = interval.map(|[low, high]| format!("{} to {}", percent(low), percent(high)));
    context.insert("interval", &interval);
    context.insert("energy_before", &joules(proof.energy_j[0]));
    context.insert("energy_after", &joules(proof.energy_j[1]));
    context.insert("cycle_before", &seconds(proof.cycle.means_s[0]));
    context.insert("cycle_after", &seconds(proof.cycle.means_s[1]));
    context.insert("cycles_before", &proof.cycles[0].to_string());
    context.insert("cycles_after", &proof.cycles[1].to_string());
    context.insert("needed", &proof.needed.to_string());
    context.insert("plot", &distributions(proof));
    let terms: Vec<Term> =
        terms(proof).into_iter().map(|(name, here)| Term { name, here }).collect();
    context.insert("terms", &terms);
    let strata: Vec<Vec<String>> = proof.strata.iter().map(stratum_row).collect();
    context.insert("strata", &strata);
    let remarks: Vec<String> =
        remarks(proof, command).into_iter().chain(proof.notes.iter().cloned()).collect();
    context.insert("remarks", &remarks);
    let plan: Vec<Need> = proof
        .plan
        .iter()
        .map(|(effect, cycles)| Need {
            effect: fixed(100.0 * effect, 0),
            cycles: cycles.to_string(),
        })
        .collect();
    context.insert("plan", &plan);
    render(include_str!("../../../../templates/prove.html.tera"), context)
}

/// The densities of the adjusted energies, with a tick for each cycle.
fn distributions(proof: &Proof) -> String {
    let all = || proof.energies.iter().flatten().copied();
    let x = scale(all(), 8);
    let (low, high) =
        all().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    let margin = 0.15 * (high - low).max(1e-9);
    let grid: Vec<f64> = (0..=POINTS)
        .map(|i| low - margin + (high - low + 2.0 * margin) * i as f64 / POINTS as f64)
        .collect();
    let curves = proof.energies.each_ref().map(|energies| density(energies, &grid));
    let most = curves.iter().flatten().copied().fold(0.0, f64::max);
    let frame = Frame::new(SIZE, x, Scale::with_zero([1.0], 4));
    let [left, _, right, bottom] = frame.area();
    let mut content = String::new();
    for (side, (curve, energies)) in curves.iter().zip(&proof.energies).enumerate() {
        let class = if side == 0 { "j1" } else { "j2" };
        let line: Vec<[f64; 2]> = grid
            .iter()
            .zip(curve)
            .map(|(x, y)| frame.at(*x, y / most.max(f64::MIN_POSITIVE)))
            .filter(|[x, _]| (left..=right).contains(x))
            .collect();
        let _ = write!(content, "<polyline class=\"{class}\" points=\"{}\"/>", points(&line));
        let row = bottom - 6.0 - 8.0 * side as f64;
        for energy in energies {
            let [x, _] = frame.at(*energy, 0.0);
            let _ = write!(
                content,
                "<line class=\"{class}\" x1=\"{x:.1}\" y1=\"{row:.1}\" x2=\"{x:.1}\" y2=\"{:.1}\"/>",
                row + 5.0
            );
        }
    }
    frame.svg(
        "adjusted energies of the cycles before and after",
        "energy of a cycle, adjusted (J)",
        "density (share of the largest)",
        &content,
    )
}

/// A kernel density with B. W. Silverman's width.
fn density(values: &[f64], grid: &[f64]) -> Vec<f64> {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let sd = (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt();
    let width = (0.9 * sd * n.powf(-0.2)).max(1e-6 * mean.abs()).max(f64::MIN_POSITIVE);
    let at = |x: &f64| {
        let kernel = |value: &f64| (-0.5 * ((x - value) / width).powi(2)).exp();
        values.iter().map(kernel).sum::<f64>() / (n * width)
    };
    grid.iter().map(at).collect()
}

//! A diagnosis as a page: which effect, where, and what the model misses before and after.

use serde::Serialize;
use tera::{Context, Tera};

use super::ReportError;
use super::format::fixed;
use crate::gap::{Diagnosis, Interval, Said, Shown};
use crate::report::diagnose::{Basis, next, sentence};
use crate::report::svg::{Curve, Plot, Size};

/// Sizes of the plots, px.
const SIZE: Size = Size { width: 720.0, height: 170.0 };
/// Deviations to each side that hold 95 %.
const INTERVAL: f64 = 1.96;
/// Bins of speed and position, and rows that one needs.
const BINS: usize = 24;
const ROWS: usize = 5;

#[derive(Serialize)]
struct EffectRow {
    title: String,
    joints: String,
    probability: String,
    parameters: Vec<String>,
    class: String,
}

#[derive(Serialize)]
struct JointRow {
    joint: usize,
    noise: String,
    model: String,
    refit: String,
    effect: String,
    share: String,
    width: String,
}

/// The page.
///
/// # Errors
/// A template that does not fit its data.
pub fn diagnose_report(found: &Diagnosis, basis: &Basis) -> Result<String, ReportError> {
    let joints: Vec<JointRow> = found
        .shrink
        .joints
        .iter()
        .enumerate()
        .map(|(joint, of)| {
            let own = found.places.iter().filter(|place| place.joint == Some(joint));
            let share = 100.0 * own.map(|place| place.share).sum::<f64>();
            JointRow {
                joint: joint + 1,
                noise: fixed(of.noise, 3),
                model: fixed(of.model, 3),
                refit: fixed(of.refit, 3),
                effect: fixed(of.refit_plus_effect, 3),
                share: format!("{} %", fixed(share, 0)),
                width: fixed(share.clamp(0.0, 100.0), 1),
            }
        })
        .collect();
    let unknown: Vec<String> = found
        .anything
        .iter()
        .map(|of| {
            let joint = of.joint.map_or_else(String::new, |joint| format!(", joint {}", joint + 1));
            format!("a function of the {}{joint}", of.id.replace('_', " "))
        })
        .collect();
    let next = next(found, basis);
    let mut context = Context::new();
    context.insert("version", env!("CARGO_PKG_VERSION"));
    context.insert("robot", &found.improved.written.name);
    context.insert("sentence", sentence(found.verdict));
    context.insert("notes", &basis.notes);
    context.insert("effects", &found.effects.iter().map(effect).collect::<Vec<_>>());
    context.insert("unknown", &unknown);
    context.insert("reasons", &found.reasons);
    context.insert("heldout", &basis.heldout);
    context.insert("total", &percent(&found.shrink.total));
    context.insert("by_effect", &percent(&found.shrink.by_effect));
    context.insert("joints", &joints);
    context.insert("plots", &found.shown.as_ref().map_or_else(Vec::new, plots));
    context.insert("why", next.as_ref().map_or("", |(why, _)| why));
    context.insert("command", next.as_ref().map_or("", |(_, command)| command));
    context.insert("model", &basis.model);
    let mut tera = Tera::default();
    tera.add_raw_templates(vec![
        ("report.css", include_str!("../../../templates/report.css")),
        ("diagnose.html", include_str!("../../../templates/diagnose.html.tera")),
    ])?;
    Ok(tera.render("diagnose.html", &context)?)
}

fn percent(of: &Interval) -> String {
    let [value, low, high] = [of.value, of.low, of.high].map(|x| fixed(100.0 * x, 1));
    format!("{value} % ({low} to {high})")
}

fn effect(of: &Said) -> EffectRow {
    let joints: Vec<String> = of.joints.iter().map(|joint| (joint + 1).to_string()).collect();
    let others = of.class.iter().copied().filter(|id| *id != of.effect.id);
    EffectRow {
        title: of.effect.title.to_owned(),
        joints: joints.join(", "),
        probability: fixed(of.probability, 2),
        parameters: of
            .parameters
            .iter()
            .map(|row| {
                let (value, sd) = (fixed(row.value, 4), fixed(INTERVAL * row.sd, 4));
                format!("{} = {value} ± {sd} {}", row.name, row.unit)
            })
            .collect(),
        class: others.collect::<Vec<_>>().join(", "),
    }
}

/// Of each joint what is missed over time, by speed and by position.
fn plots(shown: &Shown) -> Vec<String> {
    let mut plots = Vec::new();
    for joint in 0..shown.measured.len() {
        let left = |of: &[Vec<f64>]| -> Vec<f64> {
            shown.measured[joint].iter().zip(&of[joint]).map(|(a, b)| a - b).collect()
        };
        let missed = [left(&shown.before), left(&shown.after)];
        let name = format!("joint {}", joint + 1);
        let y_title = format!("{name} (Nm)");
        let over = |x: &[f64], title: &str, curves: [Vec<[f64; 2]>; 2]| {
            let [before, after] = curves;
            let curve = |class: &str, points| Curve { class: class.to_owned(), points };
            let plot = Plot {
                name: &format!("what is missed of {name} over {title}"),
                x_title: title,
                y_title: &y_title,
                curves: vec![curve("j2", before), curve("j3", after)],
                rules: Vec::new(),
            };
            if x.is_empty() { String::new() } else { plot.svg(SIZE) }
        };
        // Plots begin at 0.
        let first = shown.t.first().copied().unwrap_or(0.0);
        let of_time = |y: &Vec<f64>| shown.t.iter().zip(y).map(|(t, y)| [*t - first, *y]).collect();
        let least = shown.q[joint].iter().copied().fold(f64::INFINITY, f64::min);
        let speed: Vec<f64> = shown.qd[joint].iter().map(|x| x.abs()).collect();
        let position: Vec<f64> = shown.q[joint].iter().map(|x| x - least).collect();
        plots.push(over(&shown.t, "time (s)", [of_time(&missed[0]), of_time(&missed[1])]));
        let from = format!("position from {} rad on (rad)", fixed(least, 2));
        for (x, title) in [(&speed, "speed, both senses (rad/s)"), (&position, from.as_str())] {
            plots.push(over(x, title, [binned(x, &missed[0]), binned(x, &missed[1])]));
        }
    }
    plots
}

/// Root mean squares of y in bins of x.
fn binned(x: &[f64], y: &[f64]) -> Vec<[f64; 2]> {
    let low = x.iter().copied().fold(f64::INFINITY, f64::min);
    let high = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let width = (high - low) / BINS as f64;
    if width.is_nan() || width <= 0.0 {
        return Vec::new();
    }
    let mut sums = [(0.0, 0_usize); BINS];
    for (x, y) in x.iter().zip(y) {
        let bin = (((x - low) / width) as usize).min(BINS - 1);
        sums[bin].0 += y * y;
        sums[bin].1 += 1;
    }
    let of = |(bin, (sum, count)): (usize, &(f64, usize))| {
        (*count >= ROWS).then(|| [low + width * (bin as f64 + 0.5), (sum / *count as f64).sqrt()])
    };
    sums.iter().enumerate().filter_map(of).collect()
}

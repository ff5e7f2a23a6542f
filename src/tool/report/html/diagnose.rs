//! The HTML page of a diagnosis: effects, places, and reduction of the residuals.

use serde::Serialize;
use serde_json::{Value, json};
use tera::Context;

use super::format::{INTERVAL, fixed, percent};
use super::page::{ReportError, render};
use crate::gap::{
    Attribution, Diagnosis, Estimated, Finding, Interval, Place, Profile, Quantity, Shape, Trace,
};
use crate::tool::report::diagnose::{Basis, sentence, unknown};
use crate::tool::report::svg::{Curve, Plot, Size};

/// Size of the plots, px.
const SIZE: Size = Size { width: 620.0, height: 220.0 };
/// Minimum share of the squared residuals for a joint's regimes to be shown, %.
const MIN_PERCENT: f64 = 5.0;
/// Style classes of the curves: original model, refitted model, model with effects.
const MODELS: [&str; 3] = ["j2", "j4", "j3"];

/// The plots and source excerpts of the page.
#[derive(Clone, Debug, Default)]
pub struct Pictures {
    /// Shares of the squared residuals.
    pub attribution: Attribution,
    /// Residuals of the original, the refitted and the improved model over time.
    pub trace: Option<Trace>,
    /// By joint: these residuals over speed and over position.
    pub profiles: Vec<Vec<[Profile; 3]>>,
    /// Torques of the effects.
    pub shapes: Vec<Shape>,
    /// Program lines around the places with large residuals.
    pub sources: Vec<Excerpt>,
}

/// Lines of a program around a place.
#[derive(Clone, Debug, Serialize)]
pub struct Excerpt {
    /// File and line.
    pub place: String,
    /// The lines.
    pub lines: Vec<Line>,
}

/// A line of a program.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// From 1.
    pub number: usize,
    /// Its text.
    pub text: String,
    /// Whether it is the place itself.
    pub hot: bool,
}

/// The page of a diagnosis of the robot `robot`.
///
/// # Errors
/// A template does not fit its data.
pub fn diagnose_report(
    robot: &str,
    found: &Diagnosis,
    basis: &Basis,
    pictures: &Pictures,
) -> Result<String, ReportError> {
    let mut context = Context::new();
    let asserted = found.effects.iter().map(|of| effect(of, true));
    let considered = found.candidates.iter().map(|of| effect(of, false));
    // The attribution table already shows the regimes of the joints.
    let whole = |of: &&Place| of.joint.is_none() || of.regime == "all";
    let places: Vec<Value> = found.places.iter().filter(whole).map(place).collect();
    context.insert("robot", robot);
    context.insert("verdict", sentence(found.verdict));
    context.insert("heldout", &heldout(basis));
    context.insert("cards", &cards(found));
    context.insert("notes", &basis.notes);
    context.insert("effects", &asserted.chain(considered).collect::<Vec<_>>());
    context.insert("unknown", &unknown(found).collect::<Vec<_>>());
    context.insert("reasons", &found.reasons);
    context.insert("next", &basis.next);
    context.insert("gap", &gap(found));
    context.insert("places", &places);
    context.insert("players", &pictures.attribution.players);
    context.insert("cells", &cells(&pictures.attribution));
    context.insert("sources", &pictures.sources);
    context.insert("shapes", &pictures.shapes.iter().map(shape).collect::<Vec<_>>());
    context.insert("residuals", &residuals(pictures));
    context.insert("model", &basis.model);
    render(include_str!("../../../../templates/diagnose.html.tera"), context)
}

/// The held-out data in words.
fn heldout(basis: &Basis) -> String {
    let logs = basis.graded.join(", ");
    match basis.heldout.as_str() {
        "cycles" => format!("the last part of {logs}"),
        _ => logs,
    }
}

fn cards(found: &Diagnosis) -> Vec<Value> {
    if found.shrink.joints.is_empty() {
        return Vec::new();
    }
    let card = |name: &str, of: &Interval| {
        let [value, low, high] = [of.value, of.low, of.high].map(percent);
        json!({
            "name": name,
            "value": format!("{value} %"),
            "note": format!("95 %: {low} to {high} %"),
        })
    };
    let mut cards = vec![card("the gap shrinks, refit and effects", &found.shrink.total)];
    if !found.effects.is_empty() {
        cards.push(card("of this by the effects", &found.shrink.by_effect));
    }
    cards
}

fn effect(of: &Finding, asserted: bool) -> Value {
    let joints: Vec<String> = of.joints.iter().map(|joint| (joint + 1).to_string()).collect();
    let others: Vec<&str> = of.class.iter().copied().filter(|id| *id != of.effect.id).collect();
    let parameter = |of: &Estimated| {
        let half = INTERVAL * of.sd;
        format!("{} = {} ± {} {}", of.name, short(of.value), short(half), of.unit)
    };
    let parameters = of.parameters.iter().filter(|_| asserted).map(parameter);
    json!({
        "asserted": asserted,
        "id": of.effect.id,
        "title": of.effect.title,
        "joints": match joints.len() {
            0 => "robot".to_owned(),
            1 => format!("joint {}", joints[0]),
            _ => format!("joints {}", joints.join(", ")),
        },
        "probability": fixed(of.probability(asserted), 2),
        "parameters": parameters.collect::<Vec<_>>(),
        "others": others.join(", "),
    })
}

/// Four significant digits.
fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return fixed(x, 0);
    }
    let digits = (3.0 - x.abs().log10().floor()).clamp(0.0, 9.0);
    fixed(x, digits as usize)
}

fn gap(found: &Diagnosis) -> Vec<Value> {
    let row = |name: &str, [noise, model, refit, after]: [f64; 4], unit: &str| {
        json!({
            "name": name,
            "noise": short(noise),
            "model": short(model),
            "refit": short(refit),
            "after": short(after),
            "unit": unit,
        })
    };
    let joints = found.shrink.joints.iter().enumerate().map(|(joint, of)| {
        let values = [of.noise, of.model, of.refit, of.refit_plus_effect];
        row(&format!("torque of joint {}", joint + 1), values, "Nm")
    });
    let others = found.channels.iter().map(|(name, unit, [noise, before, after])| {
        row(name, [*noise, *before, *before, *after], unit)
    });
    joints.chain(others).collect()
}

fn place(of: &Place) -> Value {
    json!({
        "name": match of.joint {
            Some(joint) => format!("joint {}", joint + 1),
            None => of.regime.clone(),
        },
        "share": percent(of.share),
        "line": of.line.as_ref().map_or_else(String::new, |(file, line)| format!("{file}:{line}")),
    })
}

fn cells(of: &Attribution) -> Vec<Value> {
    // The darkest colour means half of the squared residuals or more.
    let heat = |x: f64| format!("{:.0}", (200.0 * x).clamp(0.0, 100.0));
    let row = |joint: usize, regime: &str, gap: f64, taken: &[f64]| {
        let taken = taken.iter().map(|x| json!({ "text": percent(*x), "heat": heat(*x) }));
        json!({
            "joint": joint + 1,
            "regime": regime,
            "gap": percent(gap),
            "heat": heat(gap),
            "taken": taken.collect::<Vec<_>>(),
        })
    };
    let mut rows = Vec::new();
    let joints = of.cells.iter().map(|cell| cell.joint + 1).max().unwrap_or(0);
    for joint in 0..joints {
        let (gap, taken) = of.of_joint(joint);
        rows.push(row(joint, "all", gap, &taken));
        if 100.0 * gap >= MIN_PERCENT {
            for cell in of.cells.iter().filter(|cell| cell.joint == joint) {
                rows.push(row(joint, &cell.regime(), cell.gap, &cell.taken));
            }
        }
    }
    rows
}

fn shape(of: &Shape) -> Value {
    let points = &of.profile.points;
    let curve = |class: &str, side: f64| {
        Curve::new(class, points.iter().map(|[x, y, half]| [*x, y + side * half]))
    };
    let curves = vec![curve("j3 before", -1.0), curve("j3 before", 1.0), curve("j3", 0.0)];
    picture(&format!("{}, joint {}", of.id, of.joint + 1), of.profile.quantity, curves)
}

fn residuals(pictures: &Pictures) -> Vec<Value> {
    let mut all = Vec::new();
    let Some(trace) = &pictures.trace else { return all };
    for joint in 0..trace.measured.len() {
        let curve = |(missed, class): (&Vec<Vec<f64>>, &str)| {
            Curve::new(class, trace.t.iter().zip(&missed[joint]).map(|(t, y)| [*t, *y]))
        };
        let curves = trace.missed.iter().zip(MODELS).map(curve).collect();
        all.push(picture(&format!("joint {}, over time", joint + 1), Quantity::Time, curves));
        for profiles in pictures.profiles.get(joint).into_iter().flatten() {
            let curve = |(profile, class): (&Profile, &str)| {
                Curve::new(class, profile.points.iter().map(|[x, y, _]| [*x, *y]))
            };
            let quantity = profiles[0].quantity;
            let curves = profiles.iter().zip(MODELS).map(curve).collect();
            let title = format!("joint {}, mean over {}", joint + 1, quantity.name());
            all.push(picture(&title, quantity, curves));
        }
    }
    all
}

fn picture(title: &str, over: Quantity, curves: Vec<Curve>) -> Value {
    let x_title = format!("{} ({})", over.name(), over.unit());
    let plot = Plot { name: title, x_title: &x_title, y_title: "Nm", curves, rules: Vec::new() };
    json!({ "title": title, "svg": plot.svg(SIZE) })
}

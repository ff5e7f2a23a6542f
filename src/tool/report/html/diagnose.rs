//! The HTML page of a diagnosis: effects, places, and reduction of the residuals.

use serde::Serialize;
use tera::Context;

use super::format::{INTERVAL, fixed};
use super::page::{ReportError, render};
use super::reliability::reliability;
use crate::examine::blind::Bin;
use crate::gap::{
    Attribution, COUNTED, Diagnosis, EXAMINED, Interval, Place, Profile, Quantity, Said, Shape,
    Trace,
};
use crate::tool::report::diagnose::{Basis, next, sentence};
use crate::tool::report::svg::{Curve, Plot, Size};

/// Size of the plots, px.
const SIZE: Size = Size { width: 620.0, height: 220.0 };
/// Minimum share of the squared residuals for a joint's regimes to be shown, %.
const SHOWN: f64 = 5.0;
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

#[derive(Serialize)]
struct Card {
    name: &'static str,
    value: String,
    note: String,
}

#[derive(Serialize)]
struct EffectRow {
    asserted: bool,
    id: &'static str,
    title: &'static str,
    joints: String,
    probability: String,
    parameters: Vec<String>,
    others: String,
}

#[derive(Serialize)]
struct Next {
    why: String,
    command: String,
}

#[derive(Serialize)]
struct GapRow {
    name: String,
    noise: String,
    model: String,
    refit: String,
    after: String,
    unit: &'static str,
}

#[derive(Serialize)]
struct PlaceRow {
    name: String,
    share: String,
    line: String,
}

#[derive(Serialize)]
struct Share {
    text: String,
    heat: String,
}

#[derive(Serialize)]
struct CellRow {
    joint: usize,
    regime: String,
    gap: String,
    heat: String,
    taken: Vec<Share>,
}

#[derive(Serialize)]
struct Picture {
    title: String,
    svg: String,
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
    let places: Vec<PlaceRow> = found.places.iter().filter(whole).map(place).collect();
    context.insert("robot", robot);
    context.insert("verdict", sentence(found.verdict));
    context.insert("heldout", &heldout(basis));
    context.insert("cards", &cards(found));
    context.insert("notes", &basis.notes);
    context.insert("effects", &asserted.chain(considered).collect::<Vec<_>>());
    context.insert("unknown", &unknown(found));
    context.insert("reasons", &found.reasons);
    let experiment = next(found, basis);
    context.insert("next", &experiment.map(|(why, command)| Next { why, command }));
    context.insert("gap", &gap(found));
    context.insert("places", &places);
    context.insert("players", &pictures.attribution.players);
    context.insert("cells", &cells(&pictures.attribution));
    context.insert("sources", &pictures.sources);
    context.insert("shapes", &pictures.shapes.iter().map(shape).collect::<Vec<_>>());
    context.insert("residuals", &residuals(pictures));
    context.insert("examined", &EXAMINED);
    context.insert("reliability", &reliability(&COUNTED.map(counted)));
    context.insert("error", &fixed(100.0 * found.error, 2));
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

fn cards(found: &Diagnosis) -> Vec<Card> {
    let card = |name: &'static str, of: &Interval| Card {
        name,
        value: format!("{} %", fixed(100.0 * of.value, 1)),
        note: format!("95 %: {} to {} %", fixed(100.0 * of.low, 1), fixed(100.0 * of.high, 1)),
    };
    let total = ("the gap shrinks, refit and effects", &found.shrink.total);
    let by_effect = ("of this by the effects", &found.shrink.by_effect);
    let told = if found.effects.is_empty() { &[total][..] } else { &[total, by_effect] };
    told.iter().map(|(name, of)| card(name, of)).collect()
}

fn counted([from, to, stated, hits, of]: [f64; 5]) -> Bin {
    Bin::new([from, to], stated, hits as usize, of as usize)
}

fn effect(of: &Said, asserted: bool) -> EffectRow {
    let joints: Vec<String> = of.joints.iter().map(|joint| (joint + 1).to_string()).collect();
    let others: Vec<&str> = of.class.iter().copied().filter(|id| *id != of.effect.id).collect();
    let parameter = |of: &crate::gap::Estimated| {
        let half = INTERVAL * of.sd;
        format!("{} = {} ± {} {}", of.name, short(of.value), short(half), of.unit)
    };
    EffectRow {
        asserted,
        id: of.effect.id,
        title: of.effect.title,
        joints: match joints.len() {
            0 => "robot".to_owned(),
            1 => format!("joint {}", joints[0]),
            _ => format!("joints {}", joints.join(", ")),
        },
        probability: fixed(of.probability, 2),
        parameters: of.parameters.iter().filter(|_| asserted).map(parameter).collect(),
        others: others.join(", "),
    }
}

/// Four significant digits.
fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return fixed(x, 0);
    }
    let digits = (3.0 - x.abs().log10().floor()).clamp(0.0, 9.0);
    fixed(x, digits as usize)
}

fn unknown(found: &Diagnosis) -> Vec<String> {
    let text = |of: &crate::gap::Anything| {
        let joint = of.joint.map_or_else(String::new, |joint| format!(" of joint {}", joint + 1));
        format!("a function of the {}{joint}", of.id.replace('_', " "))
    };
    found.anything.iter().map(text).collect()
}

fn gap(found: &Diagnosis) -> Vec<GapRow> {
    let row = |name: String, [noise, model, refit, after]: [f64; 4], unit| GapRow {
        name,
        noise: short(noise),
        model: short(model),
        refit: short(refit),
        after: short(after),
        unit,
    };
    let joints = found.shrink.joints.iter().enumerate().map(|(joint, of)| {
        let values = [of.noise, of.model, of.refit, of.refit_plus_effect];
        row(format!("torque of joint {}", joint + 1), values, "Nm")
    });
    let others = found.channels.iter().map(|(name, unit, [noise, before, after])| {
        row((*name).to_owned(), [*noise, *before, *before, *after], unit)
    });
    joints.chain(others).collect()
}

fn place(of: &Place) -> PlaceRow {
    PlaceRow {
        name: match of.joint {
            Some(joint) => format!("joint {}", joint + 1),
            None => of.regime.clone(),
        },
        share: fixed(100.0 * of.share, 1),
        line: of.line.as_ref().map_or_else(String::new, |(file, line)| format!("{file}:{line}")),
    }
}

fn cells(of: &Attribution) -> Vec<CellRow> {
    let percent = |x: f64| Share {
        text: fixed(100.0 * x, 1),
        // The darkest colour means half of the squared residuals or more.
        heat: format!("{:.0}", (200.0 * x).clamp(0.0, 100.0)),
    };
    let row = |joint: usize, regime: String, gap: f64, taken: &[f64]| {
        let Share { text, heat } = percent(gap);
        let taken = taken.iter().map(|x| percent(*x)).collect();
        CellRow { joint: joint + 1, regime, gap: text, heat, taken }
    };
    let mut rows = Vec::new();
    let joints = of.cells.iter().map(|cell| cell.joint + 1).max().unwrap_or(0);
    for joint in 0..joints {
        let (gap, taken) = of.of_joint(joint);
        rows.push(row(joint, "all".to_owned(), gap, &taken));
        if 100.0 * gap >= SHOWN {
            for cell in of.cells.iter().filter(|cell| cell.joint == joint) {
                rows.push(row(joint, cell.regime(), cell.gap, &cell.taken));
            }
        }
    }
    rows
}

fn shape(of: &Shape) -> Picture {
    let points = &of.profile.points;
    let curve = |class: &str, side: f64| Curve {
        class: class.to_owned(),
        points: points.iter().map(|[x, y, half]| [*x, y + side * half]).collect(),
    };
    let curves = vec![curve("j3 before", -1.0), curve("j3 before", 1.0), curve("j3", 0.0)];
    picture(format!("{}, joint {}", of.id, of.joint + 1), of.profile.quantity, curves)
}

fn residuals(pictures: &Pictures) -> Vec<Picture> {
    let mut all = Vec::new();
    let Some(trace) = &pictures.trace else { return all };
    for joint in 0..trace.measured.len() {
        let curve = |(missed, class): (&Vec<Vec<f64>>, &str)| Curve {
            class: class.to_owned(),
            points: trace.t.iter().zip(&missed[joint]).map(|(t, y)| [*t, *y]).collect(),
        };
        let curves = trace.missed.iter().zip(MODELS).map(curve).collect();
        all.push(picture(format!("joint {}, over time", joint + 1), Quantity::Time, curves));
        for profiles in pictures.profiles.get(joint).into_iter().flatten() {
            let curve = |(profile, class): (&Profile, &str)| Curve {
                class: class.to_owned(),
                points: profile.points.iter().map(|[x, y, _]| [*x, *y]).collect(),
            };
            let quantity = profiles[0].quantity;
            let curves = profiles.iter().zip(MODELS).map(curve).collect();
            let title = format!("joint {}, mean over {}", joint + 1, quantity.name());
            all.push(picture(title, quantity, curves));
        }
    }
    all
}

fn picture(title: String, over: Quantity, curves: Vec<Curve>) -> Picture {
    let plot = Plot {
        name: &title,
        x_title: &format!("{} ({})", over.name(), over.unit()),
        y_title: "Nm",
        curves,
        rules: Vec::new(),
    };
    let svg = plot.svg(SIZE);
    Picture { title, svg }
}

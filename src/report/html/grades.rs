//! Grades of an examination as a page: confusion, rates, and what stated probabilities are worth.

use std::collections::BTreeSet;

use serde::Serialize;
use tera::{Context, Tera};

use super::ReportError;
use super::format::fixed;
use crate::blind::{Asked, Bin, Grades, Rate};
use crate::report::svg::{Curve, Plot, Size};

/// Size of the diagram, px.
const SIZE: Size = Size { width: 460.0, height: 400.0 };

#[derive(Serialize)]
struct Confused {
    truth: String,
    counts: Vec<usize>,
}

#[derive(Serialize)]
struct RateRow {
    name: &'static str,
    hits: usize,
    of: usize,
    rate: String,
    interval: String,
    asked: String,
    met: Option<bool>,
}

#[derive(Serialize)]
struct BinRow {
    stated: String,
    mean: String,
    hits: usize,
    of: usize,
    rate: String,
    interval: String,
}

#[derive(Serialize)]
struct WrongRow<'a> {
    case: &'a str,
    truth: &'a str,
    said: &'a str,
}

/// The page of an examination.
///
/// # Errors
/// A template that does not fit its data.
pub fn grades_report(grades: &Grades) -> Result<String, ReportError> {
    let outcomes: BTreeSet<&str> =
        grades.confusion.values().flat_map(|row| row.keys().copied()).collect();
    let confused = grades.confusion.iter().map(|(truth, row)| Confused {
        truth: truth.clone(),
        counts: outcomes.iter().map(|name| row.get(name).copied().unwrap_or(0)).collect(),
    });
    let used: Vec<&Bin> = grades.reliability.iter().filter(|bin| bin.of > 0).collect();
    let wrong =
        grades.wrong.iter().map(|of| WrongRow { case: &of.case, truth: &of.truth, said: &of.said });
    let mut context = Context::new();
    context.insert("version", env!("CARGO_PKG_VERSION"));
    context.insert("cases", &grades.cases);
    context.insert("left_out", &grades.left_out);
    context.insert("outcomes", &outcomes);
    context.insert("confused", &confused.collect::<Vec<_>>());
    context.insert("rates", &grades.rates.iter().map(rate).collect::<Vec<_>>());
    context.insert("bins", &used.iter().map(|of| bin(of)).collect::<Vec<_>>());
    context.insert("diagram", &diagram(&used));
    context.insert("shrink", &grades.shrink_of_oracle.map(|share| fixed(share, 2)));
    context.insert("wrong", &wrong.collect::<Vec<_>>());
    let mut tera = Tera::default();
    tera.add_raw_templates(vec![
        ("report.css", include_str!("../../../templates/report.css")),
        ("grades.html", include_str!("../../../templates/grades.html.tera")),
    ])?;
    Ok(tera.render("grades.html", &context)?)
}

fn percent(x: f64) -> String {
    fixed(100.0 * x, 1)
}

fn rate(of: &Rate) -> RateRow {
    let asked = match of.asked {
        Asked::AtMost(most) => format!("\u{2264} {}", percent(most)),
        Asked::AtLeast(least) => format!("\u{2265} {}", percent(least)),
    };
    RateRow {
        name: of.name,
        hits: of.hits,
        of: of.of,
        rate: percent(of.rate.unwrap_or(f64::NAN)),
        interval: format!("{} to {}", percent(of.low), percent(of.high)),
        asked,
        met: of.met(),
    }
}

fn bin(of: &Bin) -> BinRow {
    BinRow {
        stated: format!("{} to {}", fixed(of.from, 2), fixed(of.to, 2)),
        mean: fixed(of.stated, 3),
        hits: of.hits,
        of: of.of,
        rate: percent(of.hits as f64 / of.of as f64),
        interval: format!("{} to {}", percent(of.low), percent(of.high)),
    }
}

/// How often effects were there over what was stated of them.
fn diagram(bins: &[&Bin]) -> String {
    let curve = |class: &str, points: Vec<[f64; 2]>| Curve { class: class.to_owned(), points };
    let mut curves = vec![curve("j2 before", vec![[0.0, 0.0], [1.0, 1.0]])];
    curves
        .extend(bins.iter().map(|of| curve("j4", vec![[of.stated, of.low], [of.stated, of.high]])));
    let rates = bins.iter().map(|of| [of.stated, of.hits as f64 / of.of as f64]);
    curves.push(curve("j3", rates.collect()));
    let plot = Plot {
        name: "how often effects were there over the stated probability",
        x_title: "stated probability",
        y_title: "share that was there",
        curves,
        rules: Vec::new(),
    };
    plot.svg(SIZE)
}

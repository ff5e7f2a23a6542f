//! The HTML page of an examination: confusion, rates, reliability of the probabilities.

use std::collections::BTreeSet;

use serde::Serialize;
use tera::Context;

use super::format::{fixed, percent};
use super::page::{ReportError, render};
use super::reliability::reliability;
use crate::examine::blind::{Asked, Grades, Rate};

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
struct WrongRow<'a> {
    case: &'a str,
    truth: &'a str,
    said: &'a str,
}

/// The page of an examination.
///
/// # Errors
/// A template does not fit its data.
pub fn grades_report(grades: &Grades) -> Result<String, ReportError> {
    let outcomes: BTreeSet<&str> =
        grades.confusion.values().flat_map(|row| row.keys().copied()).collect();
    let confused = grades.confusion.iter().map(|(truth, row)| Confused {
        truth: truth.clone(),
        counts: outcomes.iter().map(|name| row.get(name).copied().unwrap_or(0)).collect(),
    });
    let wrong =
        grades.wrong.iter().map(|of| WrongRow { case: &of.case, truth: &of.truth, said: &of.said });
    let mut context = Context::new();
    context.insert("cases", &grades.cases);
    context.insert("left_out", &grades.left_out);
    context.insert("outcomes", &outcomes);
    context.insert("confused", &confused.collect::<Vec<_>>());
    context.insert("rates", &grades.rates.iter().map(rate).collect::<Vec<_>>());
    context.insert("reliability", &reliability(&grades.reliability));
    context.insert("shrink", &grades.shrink_of_oracle.map(|share| fixed(share, 2)));
    context.insert("wrong", &wrong.collect::<Vec<_>>());
    render(include_str!("../../../../templates/grades.html.tera"), context)
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

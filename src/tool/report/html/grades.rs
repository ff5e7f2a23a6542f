//! The HTML page of an examination: confusion, rates, reliability of the probabilities.

use std::collections::BTreeSet;

use serde_json::{Value, json};
use tera::Context;

use super::format::{fixed, percent};
use super::page::{ReportError, render};
use super::reliability::reliability;
use crate::examine::blind::{Asked, Grades, Rate};

/// The page of an examination.
///
/// # Errors
/// A template does not fit its data.
pub fn grades_report(grades: &Grades) -> Result<String, ReportError> {
    let outcomes: BTreeSet<&str> =
        grades.confusion.values().flat_map(|row| row.keys().copied()).collect();
    let confused = grades.confusion.iter().map(|(truth, row)| {
        let counts = outcomes.iter().map(|name| row.get(name).copied().unwrap_or(0));
        json!({ "truth": truth, "counts": counts.collect::<Vec<_>>() })
    });
    let mut context = Context::new();
    context.insert("cases", &grades.cases);
    context.insert("left_out", &grades.left_out);
    context.insert("outcomes", &outcomes);
    context.insert("confused", &confused.collect::<Vec<_>>());
    context.insert("rates", &grades.rates.iter().map(rate).collect::<Vec<_>>());
    context.insert("reliability", &reliability(&grades.reliability));
    context.insert("shrink", &grades.shrink_of_oracle.map(|share| fixed(share, 2)));
    context.insert("wrong", &grades.wrong);
    render(include_str!("../../../../templates/grades.html.tera"), context)
}

fn rate(of: &Rate) -> Value {
    let asked = match of.asked {
        Asked::AtMost(most) => format!("\u{2264} {}", percent(most)),
        Asked::AtLeast(least) => format!("\u{2265} {}", percent(least)),
    };
    json!({
        "name": of.name,
        "hits": of.hits,
        "of": of.of,
        "rate": percent(of.rate.unwrap_or(f64::NAN)),
        "interval": format!("{} to {}", percent(of.low), percent(of.high)),
        "asked": asked,
        "met": of.met(),
    })
}

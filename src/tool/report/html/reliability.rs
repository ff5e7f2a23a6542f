//! The reliability diagram: observed frequency of effects over their stated probability.

use serde::Serialize;

use super::format::{fixed, percent};
use crate::examine::blind::Bin;
use crate::tool::report::svg::{Curve, Plot, Size};

/// Size of the diagram, px.
const SIZE: Size = Size { width: 460.0, height: 400.0 };

/// Data of `templates/reliability.html.tera`.
#[derive(Debug, Serialize)]
pub(super) struct Reliability {
    diagram: String,
    bins: Vec<BinRow>,
}

#[derive(Debug, Serialize)]
struct BinRow {
    stated: String,
    mean: String,
    hits: usize,
    of: usize,
    rate: String,
    interval: String,
}

/// The non-empty bins; `None` if all are empty.
pub(super) fn reliability(bins: &[Bin]) -> Option<Reliability> {
    let used: Vec<&Bin> = bins.iter().filter(|bin| bin.of > 0).collect();
    (!used.is_empty()).then(|| Reliability {
        diagram: diagram(&used),
        bins: used.iter().map(|of| row(of)).collect(),
    })
}

fn row(of: &Bin) -> BinRow {
    BinRow {
        stated: format!("{} to {}", fixed(of.from, 2), fixed(of.to, 2)),
        mean: fixed(of.stated, 3),
        hits: of.hits,
        of: of.of,
        rate: percent(of.hits as f64 / of.of as f64),
        interval: format!("{} to {}", percent(of.low), percent(of.high)),
    }
}

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

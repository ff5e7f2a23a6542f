//! The reliability diagram: observed frequency of effects over their stated probability.

use serde_json::{Value, json};

use super::format::{fixed, percent};
use crate::examine::blind::Bin;
use crate::tool::report::svg::{Curve, Plot, Size};

/// Size of the diagram, px.
const SIZE: Size = Size { width: 460.0, height: 400.0 };

/// The non-empty bins for `templates/reliability.html.tera`; `None` if all are empty.
pub(super) fn reliability(bins: &[Bin]) -> Option<Value> {
    let used: Vec<&Bin> = bins.iter().filter(|bin| bin.of > 0).collect();
    let row = |of: &&Bin| {
        json!({
            "stated": format!("{} to {}", fixed(of.from, 2), fixed(of.to, 2)),
            "mean": fixed(of.stated, 3),
            "hits": of.hits,
            "of": of.of,
            "rate": percent(of.hits as f64 / of.of as f64),
            "interval": format!("{} to {}", percent(of.low), percent(of.high)),
        })
    };
    let rows: Vec<Value> = used.iter().map(row).collect();
    (!used.is_empty()).then(|| json!({ "diagram": diagram(&used), "bins": rows }))
}

fn diagram(bins: &[&Bin]) -> String {
    let interval = |of: &&Bin| Curve::new("j4", [[of.stated, of.low], [of.stated, of.high]]);
    let mut curves = vec![Curve::new("j2 before", [[0.0, 0.0], [1.0, 1.0]])];
    curves.extend(bins.iter().map(interval));
    let rates = bins.iter().map(|of| [of.stated, of.hits as f64 / of.of as f64]);
    curves.push(Curve::new("j3", rates));
    let plot = Plot {
        name: "how often effects were there over the stated probability",
        x_title: "stated probability",
        y_title: "share that was there",
        curves,
        rules: Vec::new(),
    };
    plot.svg(SIZE)
}

//! Plots over time with their captions.

use serde::Serialize;

use crate::tool::report::svg::{Curve, Plot, Rule, Size};

/// A plot and its caption.
#[derive(Serialize)]
pub(super) struct Figure {
    caption: &'static str,
    svg: String,
}

/// Levels of a limit for curves of shares of it, %.
pub(super) const LIMITS: [Rule; 2] =
    [Rule { value: 100.0, label: "limit" }, Rule { value: -100.0, label: "limit" }];

/// Curves over time.
pub(super) fn figure(
    caption: &'static str,
    y_title: &str,
    curves: Vec<Curve>,
    rules: &[Rule],
    size: Size,
) -> Figure {
    let plot = Plot { name: caption, x_title: "time (s)", y_title, curves, rules: rules.to_vec() };
    Figure { caption, svg: plot.svg(size) }
}

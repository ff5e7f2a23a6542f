//! Curves over time.

use std::fmt::Write;

use super::escape::escape;
use super::frame::{Frame, Size};
use super::polyline::{points, simplify};
use super::scale::Scale;

/// Number of ticks of the abscissa.
const X_TICKS: usize = 8;
/// Number of ticks of the ordinate.
const Y_TICKS: usize = 5;

/// A curve, with gaps at values that are not finite.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Classes of the style sheet.
    pub class: String,
    /// Abscissa and ordinate.
    pub points: Vec<[f64; 2]>,
}

impl Curve {
    /// A curve of these points.
    pub fn new(class: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Curve {
        Curve { class: class.into(), points: points.into_iter().collect() }
    }
}

/// A reference level, drawn if the curves come near it.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Ordinate.
    pub value: f64,
    /// Its name.
    pub label: &'static str,
}

/// Curves in a frame.
#[derive(Clone, Debug)]
pub struct Plot<'a> {
    /// Text for screen readers.
    pub name: &'a str,
    /// Title with unit.
    pub x_title: &'a str,
    /// Title with unit.
    pub y_title: &'a str,
    /// Curves; later ones are drawn on top.
    pub curves: Vec<Curve>,
    /// Levels.
    pub rules: Vec<Rule>,
}

/// A plot is extended to a level if a curve reaches this share of it.
pub const NEAR: f64 = 0.6;

impl Plot<'_> {
    /// The plot as SVG.
    pub fn svg(&self, size: Size) -> String {
        let all = || self.curves.iter().flat_map(|curve| &curve.points);
        let ordinates = || all().map(|p| p[1]).filter(|y| y.is_finite());
        let reached = |rule: &Rule| {
            ordinates().any(|y| y.abs() >= NEAR * rule.value.abs() && y * rule.value > 0.0)
        };
        let rules: Vec<&Rule> = self.rules.iter().filter(|rule| reached(rule)).collect();
        let levels = rules.iter().map(|rule| rule.value);
        let abscissas = || all().map(|p| p[0]).filter(|x| x.is_finite());
        let (start, end) = (abscissas().fold(0.0, f64::min), abscissas().fold(0.0, f64::max));
        let frame = Frame::new(
            size,
            Scale::exact(start, end, X_TICKS),
            Scale::with_zero(ordinates().chain(levels), Y_TICKS),
        );
        let mut content = String::new();
        let [left, _, right, _] = frame.area();
        for rule in rules {
            let [_, y] = frame.at(0.0, rule.value);
            let _ = write!(
                content,
                "<line class=\"limit\" x1=\"{left:.1}\" y1=\"{y:.1}\" x2=\"{right:.1}\" \
                 y2=\"{y:.1}\"/><text class=\"note end\" x=\"{:.1}\" y=\"{:.1}\">{}</text>",
                right - 4.0,
                y - 4.0,
                escape(rule.label),
            );
        }
        for curve in &self.curves {
            for piece in curve.points.split(|p| !(p[0].is_finite() && p[1].is_finite())) {
                if piece.len() < 2 {
                    continue;
                }
                let pixels: Vec<[f64; 2]> = piece.iter().map(|p| frame.at(p[0], p[1])).collect();
                let _ = write!(
                    content,
                    "<polyline class=\"{}\" points=\"{}\"/>",
                    escape(&curve.class),
                    points(&simplify(&pixels)),
                );
            }
        }
        frame.svg(self.name, self.x_title, self.y_title, &content)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(curve: Vec<[f64; 2]>) -> String {
        let plot = Plot {
            name: "a <plot>",
            x_title: "time (s)",
            y_title: "share (%)",
            curves: vec![Curve::new("j1", curve)],
            rules: vec![Rule { value: 100.0, label: "limit" }],
        };
        plot.svg(Size { width: 600.0, height: 240.0 })
    }

    #[test]
    fn a_gap_parts_a_curve() {
        let svg = plot(vec![[0.0, 1.0], [1.0, 2.0], [2.0, f64::NAN], [3.0, 1.0], [4.0, 2.0]]);
        assert_eq!(svg.matches("<polyline").count(), 2);
        assert!(svg.contains("a &lt;plot&gt;"));
    }

    #[test]
    fn a_level_is_drawn_where_the_curve_comes_near() {
        assert!(plot(vec![[0.0, 1.0], [1.0, 70.0]]).contains("class=\"limit\""));
        assert!(!plot(vec![[0.0, 1.0], [1.0, 30.0]]).contains("class=\"limit\""));
        assert!(!plot(vec![[0.0, 1.0], [1.0, -70.0]]).contains("class=\"limit\""));
    }
}

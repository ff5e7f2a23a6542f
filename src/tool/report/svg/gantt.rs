//! Rows of bars over time.

use std::fmt::Write;

use super::escape::escape;
use super::scale::Scale;

/// Width of the names and of the whole chart, height of a row and of the axis, px.
const NAMES: f64 = 230.0;
const WIDTH: f64 = 1180.0;
const ROW: f64 = 22.0;
const AXIS: f64 = 34.0;
/// Narrowest bar, px.
const NARROWEST: f64 = 1.5;
/// Number of ticks.
const TICKS: usize = 12;

/// A bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar<'a> {
    /// Its start and end, s.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// Its class in the style sheet.
    pub class: &'a str,
}

/// A row of bars.
#[derive(Clone, Debug, PartialEq)]
pub struct Row<'a> {
    /// Its name.
    pub name: String,
    /// Its bars.
    pub bars: Vec<Bar<'a>>,
}

/// Rows of bars from 0 to `end`, s. `name` is the text for screen readers.
pub fn gantt(name: &str, rows: &[Row<'_>], end: f64) -> String {
    let scale = Scale::exact(0.0, end, TICKS);
    let at = |t: f64| NAMES + scale.share(t).clamp(0.0, 1.0) * (WIDTH - NAMES - 12.0);
    let bottom = ROW * rows.len() as f64;
    let mut out = format!(
        "<svg viewBox=\"0 0 {WIDTH:.0} {:.0}\" role=\"img\" aria-label=\"{}\">",
        bottom + AXIS,
        escape(name)
    );
    for (t, label) in scale.ticks() {
        let x = at(t);
        let _ = write!(
            out,
            "<line class=\"grid\" x1=\"{x:.1}\" y1=\"0\" x2=\"{x:.1}\" y2=\"{bottom:.1}\"/>\
             <text class=\"tick middle\" x=\"{x:.1}\" y=\"{:.1}\">{label}</text>",
            bottom + 14.0
        );
    }
    for (index, row) in rows.iter().enumerate() {
        let top = ROW * index as f64;
        let _ = write!(
            out,
            "<line class=\"grid\" x1=\"0\" y1=\"{0:.1}\" x2=\"{WIDTH:.1}\" y2=\"{0:.1}\"/>\
             <text x=\"2\" y=\"{1:.1}\">{2}</text>",
            top + ROW,
            top + 15.0,
            escape(&row.name)
        );
        for bar in &row.bars {
            let left = at(bar.from);
            let _ = write!(
                out,
                "<rect class=\"{}\" x=\"{left:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\">\
                 <title>{:.2} s: {:.2} to {:.2} s</title></rect>",
                bar.class,
                top + 4.0,
                (at(bar.to) - left).max(NARROWEST),
                ROW - 8.0,
                bar.to - bar.from,
                bar.from,
                bar.to
            );
        }
    }
    let _ = write!(
        out,
        "<text class=\"title end\" x=\"{:.1}\" y=\"{:.1}\">time in the cycle (s)</text></svg>",
        WIDTH - 12.0,
        bottom + 30.0
    );
    out
}

/// A small picture of a distribution: counts of equal steps.
pub fn histogram(name: &str, counts: &[usize], class: &str) -> String {
    let most = counts.iter().copied().max().unwrap_or(0).max(1) as f64;
    let width = 6.0;
    let mut out = format!(
        "<svg class=\"small\" viewBox=\"0 0 {:.0} 34\" role=\"img\" aria-label=\"{}\">",
        width * counts.len() as f64,
        escape(name)
    );
    for (index, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let height = (32.0 * *count as f64 / most).max(1.0);
        let _ = write!(
            out,
            "<rect class=\"{class}\" x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{height:.1}\"/>",
            width * index as f64,
            33.0 - height,
            width - 1.0
        );
    }
    out + "</svg>"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_stay_inside_the_chart() {
        let bars = vec![
            Bar { from: -1.0, to: 0.5, class: "slack" },
            Bar { from: 9.0, to: 99.0, class: "slack" },
        ];
        let chart = gantt("a < b", &[Row { name: "di<1>".to_owned(), bars }], 10.0);
        assert!(chart.contains("a &lt; b") && chart.contains("di&lt;1&gt;"));
        assert!(chart.contains(&format!("x=\"{NAMES:.1}\"")));
        assert!(!chart.contains("NaN") && !chart.contains("width=\"-"));
    }
}

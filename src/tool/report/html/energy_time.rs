//! Energy over time of each segment, as figure 5 of Paes et al. 2014: original, retrofit, and lower
//! bound of the energy on the same path.

use std::fmt::Write;

use super::format::{joules, seconds};
use super::segments::numbered;
use crate::tool::report::place::Places;
use crate::tool::report::svg::{Frame, Scale, Size, escape};
use crate::tool::retrofit::{Retrofit, SegmentKind};

const SIZE: Size = Size { width: 1260.0, height: 460.0 };
/// Half width of the tick of a lower bound, px.
const BOUND: f64 = 6.0;
/// Length and half width of an arrow head, px.
const HEAD: (f64, f64) = (7.0, 3.5);
/// Minimum distance of a label from points and other labels, px.
const LABEL: (f64, f64) = (17.0, 12.0);

/// The mean execution of a segment.
struct Point {
    number: usize,
    name: String,
    rewritten: bool,
    /// s, J.
    before: [f64; 2],
    /// s, J.
    after: [f64; 2],
    /// J.
    bound: Option<f64>,
    /// Minimum energy on the path over time, s and J.
    curve: Vec<[f64; 2]>,
}

/// The figure; `None` if nothing moves.
pub(super) fn energy_time(retrofit: &Retrofit, places: Places<'_>) -> Option<String> {
    let points: Vec<Point> = numbered(retrofit)
        .filter(|(_, segment)| segment.kind != SegmentKind::Idle && segment.time_before_s > 0.0)
        .map(|(number, segment)| {
            let n = segment.executions as f64;
            Point {
                number,
                name: places.of_pieces(&segment.pieces),
                rewritten: segment.rewritten,
                before: [segment.time_before_s / n, segment.energy_before_j / n],
                after: [segment.time_after_s / n, segment.energy_after_j / n],
                bound: segment.lower_bound_j.map(|bound| bound / n),
                curve: segment.pareto.iter().map(|p| [p.time_s, p.energy_j]).collect(),
            }
        })
        .collect();
    if points.is_empty() {
        return None;
    }
    let curves = || points.iter().flat_map(|p| p.curve.iter().copied());
    let ends = || points.iter().flat_map(|p| [p.before, p.after]).chain(curves());
    let bounds = points.iter().filter_map(|p| p.bound);
    let frame = Frame::new(
        SIZE,
        scale(ends().map(|p| p[0]), 10),
        scale(ends().map(|p| p[1]).chain(bounds), 8),
    );
    let mut content = String::new();
    for point in &points {
        mark(&mut content, &frame, point);
    }
    labels(&mut content, &frame, &points);
    Some(frame.svg(
        "energy over time of each segment, before and after",
        "time of one run (s)",
        "energy of one run (J)",
        &content,
    ))
}

/// Margin around the values, as share of their range.
const MARGIN: f64 = 0.05;

/// A scale that need not contain 0: the arrows are short relative to the values.
pub(super) fn scale(values: impl Iterator<Item = f64>, count: usize) -> Scale {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let margin = MARGIN * (high - low);
    Scale::new(low - margin, high + margin, count)
}

fn mark(out: &mut String, frame: &Frame, point: &Point) {
    let [x0, y0] = frame.at(point.before[0], point.before[1]);
    let [x1, y1] = frame.at(point.after[0], point.after[1]);
    let class = if point.rewritten { "rewritten" } else { "kept" };
    let _ = write!(
        out,
        "<g class=\"{class}\"><title>{}: {}, {} s and {} J before, {} s and {} J after</title>",
        point.number,
        escape(&point.name),
        seconds(point.before[0]),
        joules(point.before[1]),
        seconds(point.after[0]),
        joules(point.after[1]),
    );
    if !point.curve.is_empty() {
        out.push_str("<polyline class=\"curve\" points=\"");
        for [t, e] in &point.curve {
            let [x, y] = frame.at(*t, *e);
            let _ = write!(out, "{x:.1},{y:.1} ");
        }
        out.push_str("\"/>");
    }
    if let Some(bound) = point.bound {
        let [x, y] = frame.at(point.after[0], bound);
        let _ = write!(
            out,
            "<line class=\"bound\" x1=\"{:.1}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{y:.1}\"/>",
            x - BOUND,
            x + BOUND
        );
    }
    let _ = write!(out, "<circle class=\"from\" cx=\"{x0:.1}\" cy=\"{y0:.1}\" r=\"3\"/>");
    let length = (x1 - x0).hypot(y1 - y0);
    if point.rewritten && length > 0.0 {
        let (ux, uy) = ((x1 - x0) / length, (y1 - y0) / length);
        // A short arrow consists of its head only.
        let head = HEAD.0.min(length);
        let side = HEAD.1 * head / HEAD.0;
        let (bx, by) = (x1 - head * ux, y1 - head * uy);
        let _ = write!(
            out,
            "<line class=\"shaft\" x1=\"{x0:.1}\" y1=\"{y0:.1}\" x2=\"{bx:.1}\" y2=\"{by:.1}\"/>\
             <polygon class=\"head\" points=\"{x1:.1},{y1:.1} {:.1},{:.1} {:.1},{:.1}\"/>",
            bx - side * uy,
            by + side * ux,
            bx + side * uy,
            by - side * ux,
        );
    }
    out.push_str("</g>");
}

/// The numbers of the segments next to their points, as far as they fit.
fn labels(out: &mut String, frame: &Frame, points: &[Point]) {
    let mut taken: Vec<[f64; 2]> =
        points.iter().flat_map(|p| [p.before, p.after]).map(|[t, e]| frame.at(t, e)).collect();
    let [left, top, right, bottom] = frame.area();
    // The largest savings get their labels first.
    let mut order: Vec<&Point> = points.iter().collect();
    let saved = |point: &Point| point.before[1] - point.after[1];
    order.sort_by(|a, b| saved(b).total_cmp(&saved(a)));
    for point in order {
        let [x, y] = frame.at(point.before[0], point.before[1]);
        let places = [
            (18.0, 0.0),
            (-18.0, 0.0),
            (0.0, -14.0),
            (18.0, -13.0),
            (-18.0, -13.0),
            (18.0, 13.0),
            (-18.0, 13.0),
            (0.0, 14.0),
        ];
        let free = places.into_iter().map(|(dx, dy)| [x + dx, y + dy]).find(|[cx, cy]| {
            (left..=right).contains(cx)
                && (top..=bottom).contains(cy)
                && taken
                    .iter()
                    .all(|[tx, ty]| (tx - cx).abs() > LABEL.0 || (ty - cy).abs() > LABEL.1)
        });
        if let Some([cx, cy]) = free {
            taken.push([cx, cy]);
            let _ = write!(
                out,
                "<text class=\"label middle\" x=\"{cx:.1}\" y=\"{:.1}\">{}</text>",
                cy + 4.0,
                point.number
            );
        }
    }
}

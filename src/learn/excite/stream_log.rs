//! Comparison of logged stream tests with the predicted motion (the law).

use super::stream_test::StreamTest;
use crate::retime::motion::stream::{Joints, Stream};

/// Largest accepted distance from the law \[rad\]: at a reach of 1 m it moves the tool by 5 mm,
/// which is the tolerance of a stream for a joint movement.
const DEVIATION: f64 = 5e-3;
/// Accepted relative deviation of the duration, in addition to two rows of the log.
const LATE: f64 = 0.02;
/// Corners nearer to their points than this are below the errors of a log \[rad\].
const CORNER: f64 = 2e-3;
/// Accepted ratios of measured to predicted distance from the points; below `VISITED` the robot
/// visits them.
const PASSES: [f64; 2] = [0.75, 1.25];
const VISITED: f64 = 0.25;
/// Distance from the start or the end beyond which the robot moves \[rad\].
const MOVED: f64 = 1e-3;
/// Largest distance of the first logged position from the start of the test \[rad\].
const START: f64 = 0.02;
/// Largest mean interval of the rows \[s\]: longer ones do not resolve corners and times.
const COARSEST: f64 = 0.02;
/// Interval at which the law is compared \[s\].
const STEP: f64 = 0.002;
/// Steps of the search of the clock offset.
const HALVINGS: usize = 40;

/// Rows of a log: times \[s\] and positions \[rad\].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// Times, ascending.
    pub t: Vec<f64>,
    /// Positions, one for each time.
    pub q: Vec<Joints>,
}

/// Behaviour of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    /// As the law predicts.
    Law,
    /// It visits the points: corner zones have no effect.
    Visits,
    /// Another behaviour.
    Other,
}

/// Result of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Largest distance of a joint from the law with aligned clocks \[rad\].
    pub deviation: f64,
    /// Measured and predicted time between leaving the start and reaching the end \[s\].
    pub time: [f64; 2],
    /// Measured over predicted distance from the points; none if the predicted distance is too
    /// small.
    pub corners: Option<f64>,
    /// The finding.
    pub finding: Finding,
}

/// Compares a test with its logged rows; none if they begin away from its start, contain no motion,
/// or have a mean interval above 0.02 s.
pub fn measured(test: &StreamTest, rows: &Rows) -> Option<Measured> {
    let stream = &test.stream;
    let first = rows.q.first()?;
    if distance(first, stream.start()) > START {
        return None;
    }
    let row = (rows.t.last()? - rows.t.first()?) / (rows.t.len() - 1).max(1) as f64;
    if row > COARSEST {
        return None;
    }
    let steps = (stream.duration() / STEP).ceil() as usize;
    let t: Vec<f64> = (0..=steps).map(|k| STEP * k as f64).collect();
    let law = Rows { q: t.iter().map(|t| stream.eval(*t).0).collect(), t };
    let time = [moving(rows)?, moving(&law)?];
    let deviation = deviation(stream, rows);
    let corners = corners(stream, rows, &law);
    let in_time = (time[0] - time[1]).abs() <= LATE * time[1] + 2.0 * row;
    let finding = if corners.is_some_and(|share| share < VISITED) {
        Finding::Visits
    } else if deviation <= DEVIATION
        && in_time
        && corners.is_none_or(|share| (PASSES[0]..=PASSES[1]).contains(&share))
    {
        Finding::Law
    } else {
        Finding::Other
    };
    Some(Measured { deviation, time, corners, finding })
}

fn distance(a: &Joints, b: &Joints) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Time from leaving the first position to reaching the last one.
fn moving(rows: &Rows) -> Option<f64> {
    let (first, last) = (rows.q.first()?, rows.q.last()?);
    let left = rows.q.iter().position(|q| distance(q, first) > MOVED)?;
    let reached = rows.q.iter().rposition(|q| distance(q, last) > MOVED)?;
    Some(rows.t[reached] - rows.t[left])
}

/// The largest distance from the law, at the clock offset with the least sum of squares.
fn deviation(stream: &Stream, rows: &Rows) -> f64 {
    let squares = |offset: f64| -> f64 {
        let of_row = |(t, q): (&f64, &Joints)| {
            let law = stream.eval(t - offset).0;
            q.iter().zip(&law).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
        };
        rows.t.iter().zip(&rows.q).map(of_row).sum()
    };
    let (begin, end) = (rows.t[0], rows.t[rows.t.len() - 1]);
    let from = begin - 0.5 * stream.duration();
    let count = ((end - from) / (10.0 * STEP)).ceil().max(1.0) as usize;
    let coarse = (0..=count)
        .map(|k| from + 10.0 * STEP * k as f64)
        .min_by(|a, b| squares(*a).total_cmp(&squares(*b)))
        .unwrap_or(begin);
    let (mut low, mut high) = (coarse - 10.0 * STEP, coarse + 10.0 * STEP);
    for _ in 0..HALVINGS {
        let third = (high - low) / 3.0;
        if squares(low + third) < squares(high - third) { high -= third } else { low += third }
    }
    let offset = 0.5 * (low + high);
    let of_row = |(t, q): (&f64, &Joints)| distance(q, &stream.eval(t - offset).0);
    rows.t.iter().zip(&rows.q).map(of_row).fold(0.0, f64::max)
}

/// Distance of a motion from the inner points, as the least-squares multiple of the law's.
fn corners(stream: &Stream, rows: &Rows, law: &Rows) -> Option<f64> {
    let points = stream.points();
    let pairs: Vec<[f64; 2]> = points[..points.len() - 1]
        .iter()
        .map(|point| [passed(point, rows), passed(point, law)])
        .collect();
    let largest = pairs.iter().map(|pair| pair[1]).fold(0.0, f64::max);
    let product: f64 = pairs.iter().map(|pair| pair[0] * pair[1]).sum();
    let square: f64 = pairs.iter().map(|pair| pair[1] * pair[1]).sum();
    (largest > CORNER).then(|| product / square)
}

/// The least distance of a point from the polyline of the rows, in joint space \[rad\].
fn passed(point: &Joints, rows: &Rows) -> f64 {
    let from_line = |pair: &[Joints]| {
        let along: Joints = std::array::from_fn(|j| pair[1][j] - pair[0][j]);
        let to: Joints = std::array::from_fn(|j| point[j] - pair[0][j]);
        let dot = |a: &Joints, b: &Joints| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let square = dot(&along, &along);
        let share = if square > 0.0 { (dot(&to, &along) / square).clamp(0.0, 1.0) } else { 0.0 };
        let off: Joints = std::array::from_fn(|j| to[j] - share * along[j]);
        dot(&off, &off).sqrt()
    };
    rows.q.windows(2).map(from_line).fold(f64::INFINITY, f64::min)
}

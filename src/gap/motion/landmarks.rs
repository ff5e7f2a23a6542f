//! Points of a movement that the baseline shows, at which other logs are compared with it.

use std::ops::Range;

use crate::arm::robot::MAX_DOF;

use super::run::Span;
use super::smooth::Smooth;

/// The least way of a movement \[rad\]: below it a robot stands.
const LEAST_WAY: f64 = 0.02;
/// Share of a movement's speed below which it rests, and at which its ramps are compared \[1\].
const AT_REST: f64 = 0.05;
const IN_RAMP: f64 = 0.5;
/// Share of a movement's speed that is still its plateau \[1\].
const AT_PLATEAU: f64 = 0.97;
/// Deviations of a speed below which it may be noise.
const OF_NOISE: f64 = 4.0;
/// Share of a way that is taken for straight on both sides of its middle \[1\].
const STRAIGHT: f64 = 0.1;
/// The least angle of a corner \[rad\].
const CORNER: f64 = 0.2;

/// Positions of the joints \[rad\].
pub(super) type Point = [f64; MAX_DOF];

/// Points of a movement.
#[derive(Clone, Debug)]
pub(super) struct Landmarks {
    /// Number of the movement.
    pub number: usize,
    /// Number of the movement behind it.
    pub next: Option<usize>,
    /// Its length \[rad\].
    pub way: f64,
    /// Share of its way on which its speed is its highest \[1\].
    pub plateau: f64,
    /// Half of its way.
    pub middle: Option<Point>,
    /// The ramp from a rest.
    pub start: Option<Point>,
    /// The ramp to a rest.
    pub end: Option<Point>,
    /// The corner to the next one, which the path cuts.
    pub corner: Option<Point>,
    /// Speed between it and the next one below which the robot rests \[rad/s\].
    pub rest: f64,
}

impl Landmarks {
    /// The points of the movement of span `k`.
    pub(super) fn of(motion: &Smooth, spans: &[Span], k: usize) -> Landmarks {
        let span = spans[k];
        let way = way(motion, span.from..span.to);
        let middle = middle(motion, &span);
        let next = spans.get(k + 1);
        let mut landmarks = Landmarks {
            number: span.number,
            next: next.map(|next| next.number),
            way,
            plateau: 0.0,
            middle: middle.map(|row| motion.rows[row].q),
            start: None,
            end: None,
            corner: None,
            rest: 0.0,
        };
        let Some(middle) = middle else { return landmarks };
        let fast = motion.rows[middle].speed;
        let fastest = span.from..span.to;
        let fastest = fastest.filter(|row| motion.rows[*row].speed >= AT_PLATEAU * fast);
        landmarks.plateau = fastest.map(|row| motion.travelled(row)).sum::<f64>() / way;
        let neighbour = |span: &Span| self::middle(motion, span);
        let before = k.checked_sub(1).and_then(|k| neighbour(&spans[k])).unwrap_or(span.from);
        let after = next.and_then(neighbour).unwrap_or(span.to - 1);
        let rest = (AT_REST * fast).max(OF_NOISE * motion.noise);
        let slow = fast.min(motion.rows[after].speed);
        landmarks.rest = (AT_REST * slow).max(OF_NOISE * motion.noise);
        let is_slow = |row: &usize| motion.rows[*row].speed < rest;
        let in_ramp = |row: &usize| motion.rows[*row].speed >= IN_RAMP * fast;
        let point = |row: usize| motion.rows[row].q;
        if let Some(still) = (before..middle).rev().find(is_slow) {
            landmarks.start = (still..middle).find(in_ramp).map(point);
        }
        if let Some(still) = (middle..=after).find(is_slow) {
            landmarks.end = (middle..still).rev().find(in_ramp).map(point);
        } else if next.is_some_and(|next| next.has_end) {
            landmarks.corner = corner(motion, [middle, span.to, after]);
        }
        landmarks
    }
}

impl Smooth {
    /// The way from a row to the next one \[rad\]; none where the speed may be noise.
    fn travelled(&self, row: usize) -> f64 {
        let [here, next] = [self.rows[row], self.rows[(row + 1).min(self.rows.len() - 1)]];
        if here.speed > OF_NOISE * self.noise { here.speed * (next.t - here.t) } else { 0.0 }
    }
}

/// The length of a way \[rad\].
fn way(motion: &Smooth, rows: Range<usize>) -> f64 {
    rows.map(|row| motion.travelled(row)).sum()
}

/// The row at half of the way; `None` where the robot stands.
fn middle(motion: &Smooth, span: &Span) -> Option<usize> {
    let whole = way(motion, span.from..span.to);
    if whole < LEAST_WAY {
        return None;
    }
    let mut gone = 0.0;
    (span.from..span.to).find(|row| {
        gone += motion.travelled(*row);
        gone >= 0.5 * whole
    })
}

/// The corner between the middles of two movements: where the lines through both meet.
fn corner(motion: &Smooth, [first, bend, last]: [usize; 3]) -> Option<Point> {
    let (from, along) = line(motion, first, first, bend)?;
    let (to, beyond) = line(motion, last, bend, last)?;
    let cosine = dot(&along, &beyond);
    if cosine.abs() > CORNER.cos() {
        return None;
    }
    // The points of both lines that are nearest to each other.
    let apart = minus(&to, &from);
    let (a, b) = (dot(&apart, &along), dot(&apart, &beyond));
    let sine = 1.0 - cosine * cosine;
    let (s, t) = ((a - b * cosine) / sine, (a * cosine - b) / sine);
    let mut apex = [0.0; MAX_DOF];
    for (joint, apex) in apex.iter_mut().enumerate() {
        *apex = 0.5 * (from[joint] + s * along[joint] + to[joint] + t * beyond[joint]);
    }
    Some(apex)
}

/// A point and the direction of a path around a row, within some others.
fn line(motion: &Smooth, row: usize, from: usize, to: usize) -> Option<(Point, Point)> {
    let reach = (STRAIGHT * to.abs_diff(from) as f64).ceil() as usize;
    let low = motion.rows[row.saturating_sub(reach)].q;
    let high = motion.rows[(row + reach).min(motion.rows.len() - 1)].q;
    let along = minus(&high, &low);
    let length = dot(&along, &along).sqrt();
    (length > 0.0).then(|| (motion.rows[row].q, along.map(|x| x / length)))
}

fn minus(a: &Point, b: &Point) -> Point {
    let mut c = *a;
    c.iter_mut().zip(b).for_each(|(c, b)| *c -= b);
    c
}

fn dot(a: &Point, b: &Point) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

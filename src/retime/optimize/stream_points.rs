//! The points of a stream as variables of a program.
//!
//! Variables are the inner points P₁…Pₙ₋₁ of the moving joints, point by point. The ends are fixed,
//! and a joint at rest keeps exactly its angle.

use super::stream_limits::StreamLimits;
use super::stream_reference::Reference;
use crate::retime::motion::stream::{DOF, Joints, Knots, Stream, StreamError, Weights};

/// One side of a limit: Σ weight · variable + constant ≤ 1.
pub(super) struct LimitRow {
    pub(super) terms: Vec<(usize, f64)>,
    constant: f64,
    pub(super) active: bool,
}

impl LimitRow {
    fn add(&mut self, index: usize, weight: f64) {
        match self.terms.iter_mut().find(|(i, _)| *i == index) {
            Some((_, sum)) => *sum += weight,
            None => self.terms.push((index, weight)),
        }
    }

    pub(super) fn value(&self, points: &[f64]) -> f64 {
        self.constant + self.terms.iter().map(|(i, weight)| weight * points[*i]).sum::<f64>()
    }
}

/// The variables of a stream with fixed intervals and ends.
pub(super) struct Points {
    pub(super) knots: Knots,
    intervals: Vec<f64>,
    /// The joints that move.
    pub(super) joints: Vec<usize>,
    start: Joints,
    end: Joints,
}

impl Points {
    /// The variables of a stream with the ends and the moving joints of `reference`.
    pub(super) fn new(reference: &Reference, intervals: Vec<f64>) -> Result<Points, StreamError> {
        Ok(Points {
            knots: Knots::new(&intervals)?,
            intervals,
            joints: (0..DOF).filter(|j| reference.moves(*j)).collect(),
            start: *reference.start(),
            end: *reference.end(),
        })
    }

    /// Number of variables.
    pub(super) fn size(&self) -> usize {
        (self.knots.points() - 1) * self.joints.len()
    }

    /// Index of the variable of control point i (0 is the start) in moving joint m.
    pub(super) fn variable(&self, i: usize, m: usize) -> Option<usize> {
        (i > 0 && i < self.knots.points()).then(|| (i - 1) * self.joints.len() + m)
    }

    /// Value of a fixed control point, rad.
    pub(super) fn fixed(&self, i: usize, m: usize) -> f64 {
        (if i == 0 { &self.start } else { &self.end })[self.joints[m]]
    }

    /// The variables of a stream with the same knots and ends, rad.
    pub(super) fn variables(&self, stream: &Stream) -> Vec<f64> {
        let inner = &stream.points()[..self.knots.points() - 1];
        inner.iter().flat_map(|point| self.joints.iter().map(|j| point[*j])).collect()
    }

    /// All limits as rows in the variables (rad).
    pub(super) fn limit_rows(&self, limits: &StreamLimits) -> Vec<LimitRow> {
        let n = self.knots.points();
        let mut rows = Vec::new();
        let mut push = |terms: &[(usize, f64)], limit: &Joints| {
            for (m, j) in self.joints.iter().enumerate() {
                if limit[*j].is_infinite() {
                    continue;
                }
                for sign in [1.0, -1.0] {
                    let mut row = LimitRow { terms: Vec::new(), constant: 0.0, active: false };
                    for (i, weight) in terms {
                        let weight = sign * weight / limit[*j];
                        match self.variable(*i, m) {
                            Some(index) => row.add(index, weight),
                            None => row.constant += weight * self.fixed(*i, m),
                        }
                    }
                    rows.push(row);
                }
            }
        };
        let terms = |piece: usize, pick: fn(&Weights) -> [f64; 3]| {
            let weights = self.knots.weights(piece, 0.0);
            let values = pick(&weights);
            weights.support.zip(values).collect::<Vec<(usize, f64)>>()
        };
        let acceleration = |piece: usize| terms(piece, |w| w.acceleration);
        for piece in 0..=n {
            push(&acceleration(piece), &limits.acceleration);
            if piece > 0 {
                push(&terms(piece, |w| w.velocity), &limits.velocity);
                let mean = self.knots.mean_length(piece);
                let mut jump = acceleration(piece);
                jump.extend(acceleration(piece - 1).into_iter().map(|(i, w)| (i, -w)));
                for term in &mut jump {
                    term.1 /= mean;
                }
                push(&jump, &limits.jerk);
            }
        }
        for piece in [0, n] {
            let length = self.knots.piece_length(piece);
            let end: Vec<_> =
                acceleration(piece).into_iter().map(|(i, w)| (i, w / length)).collect();
            push(&end, &limits.jerk);
        }
        rows
    }

    /// The stream with the given variables; joints at rest keep exactly their angle.
    pub(super) fn stream(&self, variables: &[f64]) -> Result<Stream, StreamError> {
        let n = self.knots.points();
        let mut points = vec![self.start; n];
        for (i, point) in (1..=n).zip(&mut points) {
            for (m, j) in self.joints.iter().enumerate() {
                point[*j] = self.variable(i, m).map_or_else(|| self.fixed(i, m), |v| variables[v]);
            }
        }
        Stream::new(self.start, points, self.intervals.clone())
    }
}

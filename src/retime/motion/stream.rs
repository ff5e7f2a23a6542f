//! The model of a controller that executes a stream of `MoveAbsJ …\T` points.
//!
//! The zones of a stream reach half the distance of its points, so the realised motion is the
//! quadratic B-spline of the points P₁…Pₙ with the start position P₀. With the intervals d₁…dₙ of
//! their `\T` the knots are
//!
//! t₀ = 0, tᵢ = the middle of interval i, tₙ₊₁ = Σ d,
//!
//! except that t₁ and tₙ lie two thirds of their interval away from the rest (for a single point in
//! the middle). The joint velocity is 0 at both ends, vᵢ = (Pᵢ − Pᵢ₋₁) / Hᵢ at tᵢ with
//! Hᵢ = (tᵢ₊₁ − tᵢ₋₁)/2, and linear between knots. Hence the spline is local:
//! q(tᵢ) = Pᵢ₋₁ + (Pᵢ − Pᵢ₋₁) (tᵢ − tᵢ₋₁) / (tᵢ₊₁ − tᵢ₋₁).
//!
//! This model is inferred from the documented zone rules and not measured on a robot.

use std::ops::Range;

pub use crate::retime::path::joint_path::{DOF, Joints};

/// Zone size of a stream, `z200`, m: the zones of points at more than twice this distance do not
/// reach half of it.
pub const LARGEST_ZONE: f64 = 0.2;

/// Share of the first and of the last interval between the rest and the nearest inner knot.
const END_KNOT: f64 = 2.0 / 3.0;

/// Error in the points and intervals of a stream.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StreamError {
    /// No points.
    #[error("a stream needs at least one point")]
    Empty,
    /// Points and intervals differ in number.
    #[error("a stream of {points} points has {intervals} intervals; give one per point")]
    Lengths {
        /// Number of points.
        points: usize,
        /// Number of intervals.
        intervals: usize,
    },
    /// An interval that is not a positive finite time.
    #[error("interval {index} of a stream is {seconds} s; give a positive finite time")]
    Interval {
        /// Index from 0.
        index: usize,
        /// The refused value, s.
        seconds: f64,
    },
    /// A point that is not finite.
    #[error("point {index} of a stream is not finite; give joint angles in radians")]
    Point {
        /// Index into P₀…Pₙ (0 is the start).
        index: usize,
    },
}

/// The knots of a stream of n points: t₀ = 0 … tₙ₊₁ = Σ `\T`, s. They depend on the intervals only,
/// so with fixed intervals the realised motion is linear in the points.
#[derive(Clone, Debug, PartialEq)]
pub struct Knots {
    times: Vec<f64>,
}

/// The realised motion at one time as weights of the control points P₀ (the start) … Pₙ:
/// q = Σ `position[k]` · P[`support.start` + k], etc. Entries beyond the support are 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    /// The two or three control points with weights.
    pub support: Range<usize>,
    /// Weights of q.
    pub position: [f64; 3],
    /// Weights of q̇, 1/s.
    pub velocity: [f64; 3],
    /// Weights of q̈, 1/s².
    pub acceleration: [f64; 3],
}

impl Knots {
    /// Knots of the intervals (s, one per point).
    ///
    /// # Errors
    /// No interval, or one that is not a positive finite time.
    pub fn new(intervals: &[f64]) -> Result<Knots, StreamError> {
        let (Some(first), Some(last)) = (intervals.first(), intervals.last()) else {
            return Err(StreamError::Empty);
        };
        if let Some(index) = intervals.iter().position(|d| !(d.is_finite() && *d > 0.0)) {
            return Err(StreamError::Interval { index, seconds: intervals[index] });
        }
        let total: f64 = intervals.iter().sum();
        let n = intervals.len();
        let mut times = Vec::with_capacity(n + 2);
        times.push(0.0);
        if n == 1 {
            times.push(0.5 * total);
        } else {
            times.push(END_KNOT * first);
            let mut begin = *first;
            for d in &intervals[1..n - 1] {
                times.push(begin + 0.5 * d);
                begin += d;
            }
            times.push(total - END_KNOT * last);
        }
        times.push(total);
        Ok(Knots { times })
    }

    /// t₀ … tₙ₊₁, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Number n of points.
    pub fn points(&self) -> usize {
        self.times.len() - 2
    }

    /// Σ `\T`, s.
    pub fn duration(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Length of piece p = [tₚ, tₚ₊₁], s; p ≤ n.
    pub fn piece_length(&self, piece: usize) -> f64 {
        self.times[piece + 1] - self.times[piece]
    }

    /// Hᵢ = (tᵢ₊₁ − tᵢ₋₁)/2, s: divisor of Pᵢ − Pᵢ₋₁; 1 ≤ i ≤ n.
    pub fn mean_length(&self, knot: usize) -> f64 {
        0.5 * (self.times[knot + 1] - self.times[knot - 1])
    }

    /// The piece 0…n at `t`, the later one at a knot; outside the motion the nearest one.
    pub fn piece_at(&self, t: f64) -> usize {
        let inner = &self.times[1..self.times.len() - 1];
        inner.partition_point(|knot| *knot <= t)
    }

    /// Weights at the time `tau` (s) after the start of `piece` (≤ n).
    pub fn weights(&self, piece: usize, tau: f64) -> Weights {
        let n = self.points();
        let h = self.piece_length(piece);
        // Factors (position, velocity, acceleration) of the increments Pₚ − Pₚ₋₁ (leaving) and
        // Pₚ₊₁ − Pₚ (arriving).
        let leaving = (piece > 0).then(|| {
            let mean = self.mean_length(piece);
            let passed = 0.5 * self.piece_length(piece - 1);
            [(passed + tau - 0.5 * tau * tau / h) / mean, (1.0 - tau / h) / mean, -1.0 / (h * mean)]
        });
        let arriving = (piece < n).then(|| {
            let mean = self.mean_length(piece + 1);
            [0.5 * tau * tau / (h * mean), tau / (h * mean), 1.0 / (h * mean)]
        });
        let mut w = [[0.0; 3]; 3];
        w[0][0] = 1.0;
        let mut used = 1;
        for increment in [leaving, arriving].into_iter().flatten() {
            for kind in 0..3 {
                w[kind][used - 1] -= increment[kind];
                w[kind][used] += increment[kind];
            }
            used += 1;
        }
        let first = piece.saturating_sub(1);
        let [position, velocity, acceleration] = w;
        Weights { support: first..first + used, position, velocity, acceleration }
    }
}

/// One piece of the realised motion, with constant acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Start, s from the start of the stream.
    pub start: f64,
    /// Length, s.
    pub length: f64,
    /// Joint angles at the start, rad.
    pub q: Joints,
    /// Joint velocities at the start, rad/s.
    pub qd: Joints,
    /// Joint accelerations, rad/s².
    pub qdd: Joints,
}

impl Piece {
    /// (q, q̇, q̈) at the time `tau` (s) after the start.
    pub fn at(&self, tau: f64) -> (Joints, Joints, Joints) {
        let q = std::array::from_fn(|j| self.q[j] + tau * (self.qd[j] + 0.5 * tau * self.qdd[j]));
        let qd = std::array::from_fn(|j| self.qd[j] + tau * self.qdd[j]);
        (q, qd, self.qdd)
    }
}

/// A stream of joint points with their intervals, and its realised motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Stream {
    start: Joints,
    points: Vec<Joints>,
    intervals: Vec<f64>,
    knots: Knots,
    velocities: Vec<Joints>,
}

impl Stream {
    /// The stream from rest at `start` (P₀, rad) through `points` (P₁…Pₙ, rad) with their `\T`
    /// (`intervals`, s, one per point).
    ///
    /// # Errors
    /// No point, different lengths, intervals that are not positive, values that are not finite.
    pub fn new(
        start: Joints,
        points: Vec<Joints>,
        intervals: Vec<f64>,
    ) -> Result<Stream, StreamError> {
        if points.len() != intervals.len() {
            let (points, intervals) = (points.len(), intervals.len());
            return Err(StreamError::Lengths { points, intervals });
        }
        let knots = Knots::new(&intervals)?;
        let control = || std::iter::once(&start).chain(&points);
        if let Some(index) = control().position(|p| p.iter().any(|x| !x.is_finite())) {
            return Err(StreamError::Point { index });
        }
        let mut velocities = vec![[0.0; DOF]];
        for (i, (from, to)) in control().zip(&points).enumerate() {
            let mean = knots.mean_length(i + 1);
            velocities.push(std::array::from_fn(|j| (to[j] - from[j]) / mean));
        }
        velocities.push([0.0; DOF]);
        Ok(Stream { start, points, intervals, knots, velocities })
    }

    /// P₀, rad: the start position.
    pub fn start(&self) -> &Joints {
        &self.start
    }

    /// P₁…Pₙ, rad: the emitted points.
    pub fn points(&self) -> &[Joints] {
        &self.points
    }

    /// The `\T` of each point, s.
    pub fn intervals(&self) -> &[f64] {
        &self.intervals
    }

    /// Pₙ, rad: the end position.
    pub fn end(&self) -> &Joints {
        self.points.last().unwrap_or(&self.start)
    }

    /// Σ `\T`, s.
    pub fn duration(&self) -> f64 {
        self.knots.duration()
    }

    /// The knots t₀…tₙ₊₁.
    pub fn knots(&self) -> &Knots {
        &self.knots
    }

    /// Piece p of the motion, between tₚ and tₚ₊₁; p ≤ n.
    fn piece(&self, p: usize) -> Piece {
        let length = self.knots.piece_length(p);
        let (from, to) = (&self.velocities[p], &self.velocities[p + 1]);
        let mut q = self.start;
        if p > 0 {
            if p > 1 {
                q = self.points[p - 2];
            }
            let passed = 0.5 * self.knots.piece_length(p - 1);
            for j in 0..DOF {
                q[j] += from[j] * passed;
            }
        }
        Piece {
            start: self.knots.times[p],
            length,
            q,
            qd: *from,
            qdd: std::array::from_fn(|j| (to[j] - from[j]) / length),
        }
    }

    /// The n + 1 pieces of constant acceleration, in order.
    pub fn pieces(&self) -> impl DoubleEndedIterator<Item = Piece> + '_ {
        (0..=self.points.len()).map(|p| self.piece(p))
    }

    /// The edges P₀…Pₙ, 1 s each: the path of a robot that stops at every point.
    pub fn polygon(&self) -> impl Iterator<Item = Piece> + '_ {
        let from = std::iter::once(&self.start).chain(&self.points);
        from.zip(&self.points).enumerate().map(|(i, (from, to))| Piece {
            start: i as f64,
            length: 1.0,
            q: *from,
            qd: std::array::from_fn(|j| to[j] - from[j]),
            qdd: [0.0; DOF],
        })
    }

    /// (q, q̇, q̈) at `t` (s). At a knot the acceleration is that of the later piece; outside the
    /// motion the robot rests at P₀ or Pₙ.
    pub fn eval(&self, t: f64) -> (Joints, Joints, Joints) {
        let rest = [0.0; DOF];
        if t >= self.duration() {
            return (*self.end(), rest, rest);
        }
        if t.is_nan() || t < 0.0 {
            return (self.start, rest, rest);
        }
        let piece = self.piece(self.knots.piece_at(t));
        piece.at(t - piece.start)
    }

    /// Largest |q̇| of each joint, rad/s, exact.
    pub fn max_velocity(&self) -> Joints {
        max_abs(self.velocities.iter().copied())
    }

    /// Largest |q̈| of each joint, rad/s², exact.
    pub fn max_acceleration(&self) -> Joints {
        max_abs(self.pieces().map(|p| p.qdd))
    }

    /// Largest jerk of each joint, rad/s³: the change of acceleration at a knot over the mean
    /// length of the two pieces at it; at both ends the acceleration over the length of the piece.
    pub fn max_jerk(&self) -> Joints {
        let n = self.points.len();
        let (first, last) = (self.piece(0), self.piece(n));
        let ends = [first, last].map(|p| p.qdd.map(|a| a / p.length));
        let inner = (1..=n).map(|i| {
            let (before, after) = (self.piece(i - 1).qdd, self.piece(i).qdd);
            let mean = self.knots.mean_length(i);
            std::array::from_fn(|j| (after[j] - before[j]) / mean)
        });
        max_abs(inner.chain(ends))
    }
}

/// Largest absolute value per joint.
fn max_abs(rows: impl Iterator<Item = Joints>) -> Joints {
    rows.fold([0.0; DOF], |max, row| std::array::from_fn(|j| max[j].max(row[j].abs())))
}

#[cfg(test)]
mod tests;

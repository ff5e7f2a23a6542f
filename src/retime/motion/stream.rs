//! How a controller realises a stream of `MoveAbsJ …\T` points: the one place that knows.
//!
//! The zones of a stream are large enough for the half-distance cut, so the realised motion is
//! the quadratic B-spline of the points P₁…Pₙ, P₀ being where the robot stands. With the
//! intervals d₁…dₙ of their `\T` the knots are
//!
//! t₀ = 0, tᵢ = the middle of interval i, tₙ₊₁ = Σ d,
//!
//! except that t₁ and tₙ lie two thirds of their interval away from the rest (a single point:
//! the middle). The joint velocity is 0 at both ends, vᵢ = (Pᵢ − Pᵢ₋₁) / Hᵢ with
//! Hᵢ = (tᵢ₊₁ − tᵢ₋₁)/2 at tᵢ, and linear between knots. It follows that the spline is
//! local: q(tᵢ) = Pᵢ₋₁ + (Pᵢ − Pᵢ₋₁) (tᵢ − tᵢ₋₁) / (tᵢ₊₁ − tᵢ₋₁).
//!
//! This law is inferred from the documented zone rules. It is not measured on a robot.

use std::ops::Range;

pub use crate::retime::path::joint_path::{DOF, Joints};

/// Size of the zones of a stream, `z200`, m: points farther apart than twice this are cut at the
/// zone and not at half the distance.
pub const LARGEST_ZONE: f64 = 0.2;

/// Share of the first and of the last interval between the rest and the nearest inner knot.
const END_KNOT: f64 = 2.0 / 3.0;

/// Why points and intervals do not make a stream.
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
    /// An interval that is no time.
    #[error("interval {index} of a stream is {seconds} s; give a positive finite time")]
    Interval {
        /// Index from 0.
        index: usize,
        /// The refused value, s.
        seconds: f64,
    },
    /// A point that is no position.
    #[error("point {index} of a stream is not finite; give joint angles in radians")]
    Point {
        /// Index into P₀…Pₙ (0 is the start).
        index: usize,
    },
}

/// The knots of a stream of n points: t₀ = 0 … tₙ₊₁ = Σ `\T`, s. They depend on the intervals
/// alone, so with fixed intervals the realised motion is linear in the points.
#[derive(Clone, Debug, PartialEq)]
pub struct Knots {
    times: Vec<f64>,
}

/// The realised motion at one time as weights on the control points P₀ (the start) … Pₙ:
/// q = Σ `position[k]` · P[`support.start` + k], and so on. Entries beyond the support are 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    /// The two or three control points that matter.
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

    /// Hᵢ = (tᵢ₊₁ − tᵢ₋₁)/2, s: the time by which Pᵢ − Pᵢ₋₁ is divided; 1 ≤ i ≤ n.
    pub fn mean_length(&self, knot: usize) -> f64 {
        0.5 * (self.times[knot + 1] - self.times[knot - 1])
    }

    /// The piece 0…n that holds `t`, the later one at a knot; outside the motion the nearest.
    pub fn piece_at(&self, t: f64) -> usize {
        let inner = &self.times[1..self.times.len() - 1];
        inner.partition_point(|knot| *knot <= t)
    }

    /// Weights at the time `tau` (s) after the begin of `piece` (≤ n).
    pub fn weights(&self, piece: usize, tau: f64) -> Weights {
        let n = self.points();
        let h = self.piece_length(piece);
        // (position, velocity, acceleration) factors of the increments Pₚ − Pₚ₋₁ (leaving)
        // and Pₚ₊₁ − Pₚ (arriving).
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
    /// Begin, s from the stream's start.
    pub start: f64,
    /// Length, s.
    pub length: f64,
    /// Joint positions at the begin, rad.
    pub q: Joints,
    /// Joint velocities at the begin, rad/s.
    pub qd: Joints,
    /// Joint accelerations, rad/s².
    pub qdd: Joints,
}

impl Piece {
    /// (q, q̇, q̈) at the time `tau` (s) after the begin.
    pub fn at(&self, tau: f64) -> (Joints, Joints, Joints) {
        let q = std::array::from_fn(|j| self.q[j] + tau * (self.qd[j] + 0.5 * tau * self.qdd[j]));
        let qd = std::array::from_fn(|j| self.qd[j] + tau * self.qdd[j]);
        (q, qd, self.qdd)
    }
}

/// A stream of joint points with the times of its segments, and its realised motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Stream {
    start: Joints,
    points: Vec<Joints>,
    intervals: Vec<f64>,
    knots: Knots,
    velocities: Vec<Joints>,
}

impl Stream {
    /// The stream from rest at `start` (P₀, rad) over `points` (P₁…Pₙ, rad) with the `\T` of
    /// each (`intervals`, s, one per point).
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

    /// P₀, rad: where the robot stands.
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

    /// Where the motion ends, rad: Pₙ.
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

    /// Joint velocities at the knots t₀…tₙ₊₁, rad/s.
    pub fn velocities(&self) -> &[Joints] {
        &self.velocities
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

    /// The way from point to point P₀…Pₙ, 1 s each: what a robot does that stops at every point.
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

    /// (q, q̇, q̈) at `t` (s). At a knot the acceleration is that of the later piece; before the
    /// start and from the end on the robot rests at P₀ and Pₙ.
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

    /// Largest jerk of each joint, rad/s³: the change of acceleration at a knot over the mean of
    /// the two pieces beside it; at the ends the change from and to zero over the one piece there.
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

    /// Smallest and largest position that each joint reaches, rad, exact.
    pub fn position_range(&self) -> [(f64, f64); DOF] {
        let mut range = self.start.map(|x| (x, x));
        let mut widen = |j: usize, x: f64| range[j] = (range[j].0.min(x), range[j].1.max(x));
        for piece in self.pieces() {
            let (end, _, _) = piece.at(piece.length);
            for j in 0..DOF {
                widen(j, end[j]);
                let turn = -piece.qd[j] / piece.qdd[j];
                if turn > 0.0 && turn < piece.length {
                    widen(j, piece.at(turn).0[j]);
                }
            }
        }
        range
    }
}

/// Per joint the largest absolute value.
fn max_abs(rows: impl Iterator<Item = Joints>) -> Joints {
    rows.fold([0.0; DOF], |max, row| std::array::from_fn(|j| max[j].max(row[j].abs())))
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::*;

    /// Rounding of sums of a few dozen terms of order one.
    const ROUNDING: f64 = 1e-12;

    /// A stream with irregular intervals; joint 2 rests.
    fn irregular(n: usize) -> Stream {
        let wave = |i: usize, j: usize| {
            let x = i as f64;
            if j == 2 { 0.3 } else { (0.37 * x + 0.9 * j as f64).sin() + 0.05 * x }
        };
        let point = |i: usize| std::array::from_fn(|j| wave(i, j));
        let intervals = (0..n).map(|i| 0.05 + 0.03 * (i as f64 * 1.7).sin().abs()).collect();
        Stream::new(point(0), (1..=n).map(point).collect(), intervals).unwrap()
    }

    #[test]
    fn starts_and_ends_at_rest_on_the_first_and_the_last_point() {
        for n in [1, 2, 3, 17] {
            let stream = irregular(n);
            let total = stream.duration();
            assert_eq!(stream.eval(0.0).0, *stream.start());
            assert_eq!(stream.eval(0.0).1, [0.0; DOF]);
            assert_eq!(stream.eval(total).0, stream.points()[n - 1]);
            let last = stream.pieces().next_back().unwrap();
            let (q, qd, _) = last.at(last.length);
            for j in 0..DOF {
                assert!((q[j] - stream.points()[n - 1][j]).abs() < ROUNDING);
                assert!(qd[j].abs() < ROUNDING);
            }
        }
    }

    #[test]
    fn knots_follow_the_rule() {
        let close = |a: &[f64], b: &[f64]| {
            assert_eq!(a.len(), b.len());
            for (x, y) in a.iter().zip(b) {
                assert!((x - y).abs() < ROUNDING, "{a:?} {b:?}");
            }
        };
        let knots = |d: &[f64]| Knots::new(d).unwrap().times().to_vec();
        close(&knots(&[0.4]), &[0.0, 0.2, 0.4]);
        close(&knots(&[0.3, 0.6]), &[0.0, 0.2, 0.5, 0.9]);
        close(&knots(&[0.3, 0.2, 0.4, 0.6]), &[0.0, 0.2, 0.4, 0.7, 1.1, 1.5]);
    }

    #[test]
    fn displacement_is_the_sum_of_velocity_times_mean_length() {
        for n in [1, 2, 9] {
            let stream = irregular(n);
            let t = stream.knots().times();
            for j in 0..DOF {
                let moved: f64 =
                    (1..=n).map(|i| stream.velocities()[i][j] * 0.5 * (t[i + 1] - t[i - 1])).sum();
                let wanted = stream.points()[n - 1][j] - stream.start()[j];
                assert!((moved - wanted).abs() < ROUNDING);
            }
        }
    }

    #[test]
    fn evaluation_agrees_with_integration() {
        const STEPS: u32 = 50;
        let stream = irregular(11);
        let (mut q, mut qd) = (*stream.start(), [0.0; DOF]);
        for ends in stream.knots().times().windows(2) {
            // The midpoint rule is exact within a piece.
            let dt = (ends[1] - ends[0]) / f64::from(STEPS);
            for step in 0..STEPS {
                let middle = ends[0] + (f64::from(step) + 0.5) * dt;
                let (_, middle_qd, a) = stream.eval(middle);
                for j in 0..DOF {
                    q[j] += dt * middle_qd[j];
                    qd[j] += dt * a[j];
                }
                let (exact, exact_qd, _) = stream.eval(middle + 0.5 * dt);
                for j in 0..DOF {
                    assert!((q[j] - exact[j]).abs() < 1e2 * ROUNDING);
                    assert!((qd[j] - exact_qd[j]).abs() < 1e3 * ROUNDING);
                }
            }
        }
    }

    #[test]
    fn weights_reproduce_the_motion() {
        for n in [1, 2, 3, 8] {
            let stream = irregular(n);
            let control: Vec<Joints> =
                std::iter::once(*stream.start()).chain(stream.points().to_vec()).collect();
            for step in 0..200 {
                let t = stream.duration() * f64::from(step) / 200.0;
                let p = stream.knots().piece_at(t);
                let w = stream.knots().weights(p, t - stream.knots().times()[p]);
                let (q, qd, qdd) = stream.eval(t);
                for j in 0..DOF {
                    let sum = |weights: &[f64; 3]| -> f64 {
                        w.support.clone().zip(weights).map(|(i, x)| x * control[i][j]).sum()
                    };
                    assert!((sum(&w.position) - q[j]).abs() < ROUNDING);
                    assert!((sum(&w.velocity) - qd[j]).abs() < 1e2 * ROUNDING);
                    assert!((sum(&w.acceleration) - qdd[j]).abs() < 1e4 * ROUNDING);
                }
            }
        }
    }

    #[test]
    fn maxima_bound_what_dense_sampling_sees() {
        const STEPS: usize = 20_000;
        let stream = irregular(13);
        let (mut v, mut a) = ([0.0f64; DOF], [0.0f64; DOF]);
        let mut range = stream.start().map(|x| (x, x));
        for step in 0..STEPS {
            let (q, qd, qdd) = stream.eval(stream.duration() * step as f64 / STEPS as f64);
            for j in 0..DOF {
                v[j] = v[j].max(qd[j].abs());
                a[j] = a[j].max(qdd[j].abs());
                range[j] = (range[j].0.min(q[j]), range[j].1.max(q[j]));
            }
        }
        let (exact_v, exact_a) = (stream.max_velocity(), stream.max_acceleration());
        let exact_range = stream.position_range();
        for j in 0..DOF {
            assert!(v[j] <= exact_v[j] + ROUNDING && v[j] >= exact_v[j] - 0.05);
            assert!((a[j] - exact_a[j]).abs() <= 1e3 * ROUNDING);
            assert!(range[j].0 >= exact_range[j].0 - ROUNDING);
            assert!((range[j].0 - exact_range[j].0).abs() < 1e-5);
            assert!((range[j].1 - exact_range[j].1).abs() < 1e-5);
        }
        assert_eq!(exact_v[2], 0.0);
        assert_eq!(exact_range[2], (0.3, 0.3));
    }

    #[test]
    fn jerk_of_one_point_is_known() {
        // Up for d/2, down for d/2: a = 4/d², jumps 4/d² at the ends and 8/d² in the middle.
        let d = 0.5;
        let mut point = [0.0; DOF];
        point[0] = 1.0;
        let stream = Stream::new([0.0; DOF], vec![point], vec![d]).unwrap();
        assert!((stream.max_velocity()[0] - 2.0 / d).abs() < ROUNDING);
        assert!((stream.max_acceleration()[0] - 4.0 / (d * d)).abs() < ROUNDING);
        assert!((stream.max_jerk()[0] - 16.0 / (d * d * d)).abs() < 1e2 * ROUNDING);
    }

    #[test]
    fn resting_joints_stay_exactly() {
        let stream = irregular(9);
        for step in 0..=1000 {
            let (q, qd, qdd) = stream.eval(stream.duration() * f64::from(step) / 1000.0);
            assert_eq!((q[2], qd[2], qdd[2]), (0.3, 0.0, 0.0));
        }
    }

    #[test]
    fn wrong_input_is_refused() {
        let p = [0.0; DOF];
        let lengths = StreamError::Lengths { points: 1, intervals: 0 };
        assert_eq!(Stream::new(p, vec![], vec![]), Err(StreamError::Empty));
        assert_eq!(Stream::new(p, vec![p], vec![]), Err(lengths));
        for bad in [0.0, -0.1, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                Stream::new(p, vec![p, p], vec![0.1, bad]),
                Err(StreamError::Interval { index: 1, .. })
            ));
        }
        let mut nan = p;
        nan[3] = f64::NAN;
        assert_eq!(
            Stream::new(p, vec![p, nan], vec![0.1, 0.1]),
            Err(StreamError::Point { index: 2 })
        );
    }
}

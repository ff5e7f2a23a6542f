//! The stream whose realised motion follows an intended one within all joint limits.
//!
//! With fixed intervals the realised motion is linear in the points, so the fit is a quadratic
//! program. First the weighted least squares without limits, a band matrix; where that breaks a
//! limit, the nearest points (in the same weights) that keep the limits, which needs only the
//! rows that come near their bound.
//!
//! An error along the path is a matter of timing and costs less than one away from it.

use super::banded::Banded;
use super::cone::{Affine, ConeProgram, ConeStatus};
use super::stream_reference::Reference;
use crate::motion::stream::{DOF, Joints, Knots, Stream, StreamError, Weights};

/// Largest |q̇|, |q̈| and jerk of each joint in the realised motion; infinite for none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamLimits {
    /// rad/s.
    pub velocity: Joints,
    /// rad/s².
    pub acceleration: Joints,
    /// rad/s³.
    pub jerk: Joints,
}

impl StreamLimits {
    /// The largest share of a limit that the stream uses.
    pub fn worst_ratio(&self, stream: &Stream) -> f64 {
        let pairs = [
            (stream.max_velocity(), &self.velocity),
            (stream.max_acceleration(), &self.acceleration),
            (stream.max_jerk(), &self.jerk),
        ];
        let shares = pairs.iter().flat_map(|(used, limit)| (0..DOF).map(|j| used[j] / limit[j]));
        shares.fold(0.0, f64::max)
    }

    /// Factor on the time at which the stream with the same points keeps the limits, at least 1.
    pub fn stretch(&self, stream: &Stream) -> f64 {
        let pairs = [
            (stream.max_velocity(), self.velocity, 1.0),
            (stream.max_acceleration(), self.acceleration, 2.0),
            (stream.max_jerk(), self.jerk, 3.0),
        ];
        let of = |(used, limit, power): (Joints, Joints, f64)| {
            (0..DOF).map(move |j| (used[j] / limit[j]).powf(1.0 / power))
        };
        pairs.into_iter().flat_map(of).fold(1.0, f64::max)
    }
}

/// How the fit ended.
#[derive(Clone, Debug, PartialEq)]
pub enum StreamFit {
    /// The stream, verified against the limits.
    Fitted(FittedStream),
    /// The limits cannot be kept in this time.
    TooFast {
        /// Factor on the time at which the fit without limits keeps them: an upper bound.
        stretch: f64,
    },
    /// The solver broke off or its answer did not verify.
    Failed,
}

/// A stream and how far its realised motion is from the intended one.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedStream {
    /// The stream.
    pub stream: Stream,
    /// Largest distance from the path, in the units of the levers.
    pub deviation: f64,
    /// Largest error along the path, in the units of the levers.
    pub lag: f64,
}

/// Samples per interval at which the error counts.
const SAMPLES: usize = 6;
/// Weight of the squared error along the path; 1 away from it.
const ALONG: f64 = 0.02;
/// Time by which the error of the velocity is weighed against that of the position, s.
const HORIZON: f64 = 0.01;
/// Room that the program keeps to the limits.
const MARGIN: f64 = 1e-3;
/// Share of its limit from which a row is part of the program.
const NEAR: f64 = 0.9;
/// Rounds in which rows are added.
const MAX_ROUNDS: usize = 10;
/// Unit of the program's variables, rad.
const UNIT: f64 = 1e-3;

/// Fits a stream with the given intervals (s) to `reference`, which is stretched to their sum.
/// `lever` weighs the joints (1 for radians, the distance to the tool for metres).
///
/// # Errors
/// Intervals that are not positive finite times.
pub fn fit_stream(
    reference: &Reference,
    intervals: Vec<f64>,
    limits: &StreamLimits,
    lever: &Joints,
) -> Result<StreamFit, StreamError> {
    let knots = Knots::new(&intervals)?;
    let joints: Vec<usize> = (0..DOF).filter(|j| reference.moves(*j)).collect();
    let fit = Fit { reference, knots, intervals, joints, lever };
    let (matrix, right) = fit.normal_equations();
    let Some(free) = matrix.clone().solve(right) else {
        return Ok(StreamFit::Failed);
    };
    let unlimited = fit.stream(&free)?;
    if limits.worst_ratio(&unlimited) <= 1.0 {
        return Ok(StreamFit::Fitted(fit.measured(unlimited)));
    }
    if free.is_empty() {
        return Ok(StreamFit::TooFast { stretch: limits.stretch(&unlimited) });
    }
    let mut rows = fit.limit_rows(limits);
    for row in &mut rows {
        row.active = row.value(&free) > NEAR;
    }
    for _ in 0..MAX_ROUNDS {
        let mut program = ConeProgram::new(free.len());
        for (i, j, value) in matrix.entries() {
            program.curve(i, j, value);
        }
        for row in rows.iter().filter(|row| row.active) {
            let mut affine = Affine::constant((row.value(&free) - (1.0 - MARGIN)) / UNIT);
            for (index, weight) in &row.terms {
                affine.add(Some(*index), *weight);
            }
            program.at_most_zero(affine);
        }
        let solution = program.solve();
        match solution.status {
            ConeStatus::Infeasible => {
                return Ok(StreamFit::TooFast { stretch: limits.stretch(&unlimited) });
            }
            ConeStatus::Failed => return Ok(StreamFit::Failed),
            ConeStatus::Solved | ConeStatus::AlmostSolved => {}
        }
        let points: Vec<f64> =
            free.iter().zip(&solution.x).map(|(free, x)| free + UNIT * x).collect();
        let stream = fit.stream(&points)?;
        if limits.worst_ratio(&stream) <= 1.0 {
            return Ok(StreamFit::Fitted(fit.measured(stream)));
        }
        let mut added = false;
        for row in &mut rows {
            let near = !row.active && row.value(&points) > NEAR;
            added |= near;
            row.active |= near;
        }
        if !added {
            break;
        }
    }
    Ok(StreamFit::Failed)
}

/// One limit on one side: Σ weight · variable + constant ≤ 1.
struct LimitRow {
    terms: Vec<(usize, f64)>,
    constant: f64,
    active: bool,
}

impl LimitRow {
    fn value(&self, points: &[f64]) -> f64 {
        self.constant + self.terms.iter().map(|(i, weight)| weight * points[*i]).sum::<f64>()
    }
}

/// The data of a fit. The variables are the inner points P₁…Pₙ₋₁ in the joints that move, point
/// by point.
struct Fit<'a> {
    reference: &'a Reference,
    knots: Knots,
    intervals: Vec<f64>,
    joints: Vec<usize>,
    lever: &'a Joints,
}

impl Fit<'_> {
    /// Index of the variable of the control point i (0 is the start) in the moving joint m.
    fn variable(&self, i: usize, m: usize) -> Option<usize> {
        (i > 0 && i < self.knots.points()).then(|| (i - 1) * self.joints.len() + m)
    }

    /// The value of a control point that is no variable, rad.
    fn fixed(&self, i: usize, m: usize) -> f64 {
        let at = if i == 0 { self.reference.start() } else { self.reference.end() };
        at[self.joints[m]]
    }

    /// The intended motion at the stream's time t.
    fn intended(&self, t: f64) -> (Joints, Joints) {
        let stretch = self.reference.duration() / self.knots.duration();
        let (q, qd) = self.reference.at(t * stretch);
        (q, qd.map(|v| v * stretch))
    }

    /// The direction of the path in the moving joints, of length one; zero at rest.
    fn direction(&self, qd: &Joints) -> Vec<f64> {
        let along: Vec<f64> = self.joints.iter().map(|j| self.lever[*j] * qd[*j]).collect();
        let norm = along.iter().map(|x| x * x).sum::<f64>().sqrt();
        along.iter().map(|x| if norm > 0.0 { x / norm } else { 0.0 }).collect()
    }

    /// The times of the error samples with their weights.
    fn samples(&self) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        (0..=self.knots.points()).flat_map(move |piece| {
            let step = self.knots.piece_length(piece) / SAMPLES as f64;
            (0..SAMPLES).map(move |i| (piece, (i as f64 + 0.5) * step, step))
        })
    }

    /// The matrix and right side of the least squares in the variables (rad), with a mean error
    /// of `UNIT` as one.
    fn normal_equations(&self) -> (Banded, Vec<f64>) {
        let moving = self.joints.len();
        let size = (self.knots.points() - 1) * moving;
        let mut matrix = Banded::zeros(size, (3 * moving).saturating_sub(1).min(size));
        let mut right = vec![0.0; size];
        for (piece, tau, step) in self.samples() {
            let weights = self.knots.weights(piece, tau);
            let (q, qd) = self.intended(self.knots.times()[piece] + tau);
            let direction = self.direction(&qd);
            let scale = step / self.knots.duration();
            for (basis, target, factor) in [
                (&weights.position, &q, scale),
                (&weights.velocity, &qd, scale * HORIZON * HORIZON),
            ] {
                // e = Σ basis · P − target; fixed points go to the other side.
                let mut wanted: Vec<f64> = self.joints.iter().map(|j| target[*j]).collect();
                for (i, w) in weights.support.clone().zip(basis) {
                    for (m, wanted) in wanted.iter_mut().enumerate() {
                        if self.variable(i, m).is_none() {
                            *wanted -= w * self.fixed(i, m);
                        }
                    }
                }
                let metric = |m: usize, l: usize| {
                    let same = if m == l { 1.0 } else { 0.0 };
                    let along = (1.0 - ALONG) * direction[m] * direction[l];
                    factor
                        * self.lever[self.joints[m]]
                        * self.lever[self.joints[l]]
                        * (same - along)
                };
                for (i, w) in weights.support.clone().zip(basis) {
                    for m in 0..moving {
                        let Some(row) = self.variable(i, m) else { continue };
                        for (l, wanted) in wanted.iter().enumerate() {
                            right[row] += w * metric(m, l) * wanted;
                            for (k, v) in weights.support.clone().zip(basis) {
                                if let Some(column) = self.variable(k, l).filter(|c| *c <= row) {
                                    matrix.add(row, column, w * v * metric(m, l));
                                }
                            }
                        }
                    }
                }
            }
        }
        (matrix, right)
    }

    /// All limits as rows in the variables (rad).
    fn limit_rows(&self, limits: &StreamLimits) -> Vec<LimitRow> {
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
                            Some(index) => row.terms.push((index, weight)),
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

    /// The stream with the given variables; joints that do not move stay exactly.
    fn stream(&self, variables: &[f64]) -> Result<Stream, StreamError> {
        let n = self.knots.points();
        let mut points = vec![*self.reference.start(); n];
        for (i, point) in (1..=n).zip(&mut points) {
            for (m, j) in self.joints.iter().enumerate() {
                point[*j] = self.variable(i, m).map_or_else(|| self.fixed(i, m), |v| variables[v]);
            }
        }
        Stream::new(*self.reference.start(), points, self.intervals.clone())
    }

    fn measured(&self, stream: Stream) -> FittedStream {
        let (mut deviation, mut lag) = (0.0f64, 0.0f64);
        for (piece, tau, _) in self.samples() {
            let t = self.knots.times()[piece] + tau;
            let (intended, qd) = self.intended(t);
            let (q, _, _) = stream.eval(t);
            let error = self.joints.iter().map(|j| self.lever[*j] * (q[*j] - intended[*j]));
            let along: f64 = error.clone().zip(self.direction(&qd)).map(|(e, d)| e * d).sum();
            let square: f64 = error.map(|e| e * e).sum();
            deviation = deviation.max((square - along * along).max(0.0).sqrt());
            lag = lag.max(along.abs());
        }
        FittedStream { stream, deviation, lag }
    }
}

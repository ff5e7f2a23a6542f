//! Fits a stream to a reference motion within all joint limits.
//!
//! With fixed intervals the realised motion is linear in the points, so the fit is a quadratic
//! program. First the weighted least squares without limits, a banded system. If it exceeds a
//! limit, the nearest feasible points in the same metric; only rows near their bound are included.
//!
//! An error along the path is an error of timing and has less weight than one across it.

use super::banded::Banded;
use super::cone::{Affine, ConeProgram, ConeStatus};
use super::stream_limits::StreamLimits;
use super::stream_points::Points;
use super::stream_reference::Reference;
use crate::retime::motion::stream::{Joints, Stream, StreamError};

/// Outcome of the fit.
#[derive(Clone, Debug, PartialEq)]
pub enum StreamFit {
    /// The stream, checked against the limits.
    Fitted(FittedStream),
    /// The limits cannot be kept in this time.
    TooFast {
        /// Time factor at which the fit without limits keeps them: an upper bound.
        stretch: f64,
    },
    /// The solver stopped, or its solution failed the check.
    Failed,
}

/// A stream and the error of its realised motion.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedStream {
    /// The stream.
    pub stream: Stream,
    /// Largest distance from the path, in lever units.
    pub deviation: f64,
    /// Largest error along the path, in lever units.
    pub lag: f64,
}

/// Error samples per interval.
const SAMPLES: usize = 6;
/// Weight of the squared error along the path; across it the weight is 1.
const ALONG: f64 = 0.02;
/// Weight of velocity errors relative to position errors, s.
const HORIZON: f64 = 0.01;
/// Margin of the program to the limits.
const MARGIN: f64 = 1e-3;
/// Share of its limit from which a row is in the program.
const NEAR: f64 = 0.9;
/// Largest number of solves with added rows.
const MAX_ROUNDS: usize = 10;
/// Unit of the program's variables, rad.
const UNIT: f64 = 1e-3;

/// Fits a stream with the given intervals (s) to `reference`, which is stretched to their sum.
/// `lever` is the weight of each joint (1 for radians, the distance to the TCP for metres).
///
/// # Errors
/// Intervals that are not positive finite times.
pub fn fit_stream(
    reference: &Reference,
    intervals: Vec<f64>,
    limits: &StreamLimits,
    lever: &Joints,
) -> Result<StreamFit, StreamError> {
    let points = Points::new(reference, intervals)?;
    let fit = Fit { reference, points, lever };
    let (matrix, right) = fit.normal_equations();
    let Some(factor) = matrix.clone().factor() else {
        return Ok(StreamFit::Failed);
    };
    let free = factor.solve(right);
    let unlimited = fit.points.stream(&free)?;
    if limits.worst_ratio(&unlimited) <= 1.0 {
        return Ok(StreamFit::Fitted(fit.measured(unlimited)));
    }
    if free.is_empty() {
        return Ok(StreamFit::TooFast { stretch: limits.stretch(&unlimited) });
    }
    let mut rows = fit.points.limit_rows(limits);
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
        let stream = fit.points.stream(&points)?;
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

/// The data of a fit.
struct Fit<'a> {
    reference: &'a Reference,
    points: Points,
    lever: &'a Joints,
}

impl Fit<'_> {
    /// The reference motion at time t of the stream.
    fn intended(&self, t: f64) -> (Joints, Joints) {
        let stretch = self.reference.duration() / self.points.knots.duration();
        let (q, qd) = self.reference.at(t * stretch);
        (q, qd.map(|v| v * stretch))
    }

    /// Unit vector of the path direction in the moving joints; zero at rest.
    fn direction(&self, qd: &Joints) -> Vec<f64> {
        let along: Vec<f64> = self.points.joints.iter().map(|j| self.lever[*j] * qd[*j]).collect();
        let norm = along.iter().map(|x| x * x).sum::<f64>().sqrt();
        along.iter().map(|x| if norm > 0.0 { x / norm } else { 0.0 }).collect()
    }

    /// The error samples: piece, time in it (s) and weight (s).
    fn samples(&self) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        (0..=self.points.knots.points()).flat_map(move |piece| {
            let step = self.points.knots.piece_length(piece) / SAMPLES as f64;
            (0..SAMPLES).map(move |i| (piece, (i as f64 + 0.5) * step, step))
        })
    }

    /// Matrix and right-hand side of the least squares in the variables (rad).
    fn normal_equations(&self) -> (Banded, Vec<f64>) {
        let moving = self.points.joints.len();
        let size = self.points.size();
        let mut matrix = Banded::zeros(size, (3 * moving).saturating_sub(1).min(size));
        let mut right = vec![0.0; size];
        for (piece, tau, step) in self.samples() {
            let weights = self.points.knots.weights(piece, tau);
            let (q, qd) = self.intended(self.points.knots.times()[piece] + tau);
            let direction = self.direction(&qd);
            let scale = step / self.points.knots.duration();
            for (basis, target, factor) in [
                (&weights.position, &q, scale),
                (&weights.velocity, &qd, scale * HORIZON * HORIZON),
            ] {
                // e = Σ basis · P − target; fixed points are moved to the target.
                let mut wanted: Vec<f64> = self.points.joints.iter().map(|j| target[*j]).collect();
                for (i, w) in weights.support.clone().zip(basis) {
                    for (m, wanted) in wanted.iter_mut().enumerate() {
                        if self.points.variable(i, m).is_none() {
                            *wanted -= w * self.points.fixed(i, m);
                        }
                    }
                }
                let metric = |m: usize, l: usize| {
                    let same = if m == l { 1.0 } else { 0.0 };
                    let along = (1.0 - ALONG) * direction[m] * direction[l];
                    factor
                        * self.lever[self.points.joints[m]]
                        * self.lever[self.points.joints[l]]
                        * (same - along)
                };
                for (i, w) in weights.support.clone().zip(basis) {
                    for m in 0..moving {
                        let Some(row) = self.points.variable(i, m) else { continue };
                        for (l, wanted) in wanted.iter().enumerate() {
                            right[row] += w * metric(m, l) * wanted;
                            for (k, v) in weights.support.clone().zip(basis) {
                                if let Some(column) =
                                    self.points.variable(k, l).filter(|c| *c <= row)
                                {
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

    fn measured(&self, stream: Stream) -> FittedStream {
        let (mut deviation, mut lag) = (0.0f64, 0.0f64);
        for (piece, tau, _) in self.samples() {
            let t = self.points.knots.times()[piece] + tau;
            let (intended, qd) = self.intended(t);
            let (q, _, _) = stream.eval(t);
            let error = self.points.joints.iter().map(|j| self.lever[*j] * (q[*j] - intended[*j]));
            let along: f64 = error.clone().zip(self.direction(&qd)).map(|(e, d)| e * d).sum();
            let square: f64 = error.map(|e| e * e).sum();
            deviation = deviation.max((square - along * along).max(0.0).sqrt());
            lag = lag.max(along.abs());
        }
        FittedStream { stream, deviation, lag }
    }
}

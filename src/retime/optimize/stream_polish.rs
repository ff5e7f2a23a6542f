//! Lowers the energy of the realised motion of a stream at fixed intervals, within all limits.
//!
//! Sequential quadratic programming on the points. The copper loss is a sum of squares of torques
//! that are linearised in the points (Gauss–Newton). The braking loss is smoothed where the power
//! changes its sign. Joint limits are linear rows and hold exactly; torque and path limits are
//! linearised rows with priced slacks. The distance from the path has a price: a distance equal to
//! the tolerance costs the share `DEVIATION_PRICE` of the energy.

use super::banded_program::{BandedProgram, Optimum, Row};
use super::path_energy::EnergyModel;
use super::plant::{Plant, ROOM, Realised};
use super::polish_problem::{PathPenalty, PolishProblem, Quadratic, UNIT};
use super::stream_limits::StreamLimits;
use super::stream_points::LimitRow;
use super::stream_reference::Reference;
use crate::retime::motion::stream::{Stream, StreamError};

/// Outcome of polishing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PolishStatus {
    /// No further step lowers the energy.
    Converged,
    /// The iteration limit was reached.
    Stopped,
}

/// A polished stream.
#[derive(Clone, Debug, PartialEq)]
pub struct Polished {
    /// The stream, never worse than the given one in energy plus priced violations.
    pub stream: Stream,
    /// Outcome of polishing.
    pub status: PolishStatus,
    /// Cost of its motion and used shares of the limits.
    pub realised: Realised,
    /// Largest distance of the realised motion from the reference path, in lever units.
    pub deviation: f64,
}

/// Largest number of steps.
const MAX_STEPS: usize = 80;
/// Relative decrease of the merit at which the iteration ends.
const CONVERGED: f64 = 3e-5;
/// Gap of the programs. A step is accepted by its effect on the merit, so low accuracy suffices.
const ROUGH_GAP: f64 = 1e-5;
/// Initial price of a step of one unit in every variable, in initial energies; and its bounds.
const DAMPING: f64 = 1e-3;
const DAMPING_RANGE: (f64, f64) = (1e-6, 1e2);
/// Factor on the damping after a good or a bad step.
const DAMPING_STEP: f64 = 5.0;
/// Tried parts of a proposed step.
const PARTS: [f64; 4] = [1.0, 0.4, 0.15, 0.05];

/// Lowers the energy of `stream`, which has the ends of `reference` and keeps `limits`.
///
/// # Errors
/// None for a valid stream; those of [`Stream::new`].
pub fn polish_stream(
    stream: &Stream,
    reference: &Reference,
    plant: &impl Plant,
    limits: &StreamLimits,
    model: &EnergyModel,
    penalty: &PathPenalty,
) -> Result<Polished, StreamError> {
    let problem = PolishProblem::new(stream, reference, plant, model, penalty)?;
    let rows = problem.points.limit_rows(limits);
    let polish = Polish { problem, limits, rows };
    let mut best = polish.candidate(stream.clone());
    let status = polish.improve(&mut best)?;
    Ok(Polished {
        status,
        realised: best.realised,
        deviation: polish.problem.deviation(&best.stream),
        stream: best.stream,
    })
}

/// A stream with its merit in units of the initial energy.
struct Candidate {
    stream: Stream,
    realised: Realised,
    merit: f64,
}

/// A proposed change of the variables (rad) and the predicted decrease of the merit.
struct Proposal {
    change: Vec<f64>,
    predicted: f64,
}

struct Polish<'a, P> {
    problem: PolishProblem<'a, P>,
    limits: &'a StreamLimits,
    /// The joint limits as rows.
    rows: Vec<LimitRow>,
}

impl<P: Plant> Polish<'_, P> {
    /// Steps of the quadratic programs from `best` on, which becomes the best stream found.
    fn improve(&self, best: &mut Candidate) -> Result<PolishStatus, StreamError> {
        if self.problem.points.size() == 0 {
            return Ok(PolishStatus::Converged);
        }
        let mut damping = DAMPING;
        let mut model = self.quadratic(best);
        for _ in 0..MAX_STEPS {
            let Some(step) = self.step(best, &model, damping) else {
                return Ok(PolishStatus::Converged);
            };
            let Some((part, next)) = self.along(best, &step)? else {
                if damping < DAMPING_RANGE.1 && step.predicted > CONVERGED {
                    damping *= DAMPING_STEP.powi(2);
                    continue;
                }
                return Ok(PolishStatus::Converged);
            };
            let fall = best.merit - next.merit;
            if part < 1.0 {
                damping *= DAMPING_STEP;
            } else if fall > 0.5 * step.predicted {
                damping = (damping / DAMPING_STEP).max(DAMPING_RANGE.0);
            }
            *best = next;
            if fall < CONVERGED {
                return Ok(PolishStatus::Converged);
            }
            model = self.quadratic(best);
        }
        Ok(PolishStatus::Stopped)
    }

    fn candidate(&self, stream: Stream) -> Candidate {
        let (realised, merit) = self.problem.merit(&stream);
        Candidate { stream, realised, merit }
    }

    fn quadratic(&self, best: &Candidate) -> Quadratic {
        self.problem.quadratic(&best.stream, best.realised.excess)
    }

    /// Line search: the largest part of a step that lowers the merit, and the stream there. Joint
    /// limits are convex, so a part of a feasible step is feasible.
    fn along(
        &self,
        best: &Candidate,
        step: &Proposal,
    ) -> Result<Option<(f64, Candidate)>, StreamError> {
        let from = self.problem.points.variables(&best.stream);
        for part in PARTS {
            let variables: Vec<f64> =
                from.iter().zip(&step.change).map(|(x, change)| x + part * change).collect();
            let next = self.candidate(self.problem.points.stream(&variables)?);
            let kept = self.limits.worst_ratio(&next.stream)
                <= self.limits.worst_ratio(&best.stream).max(1.0);
            if kept && next.merit < best.merit {
                return Ok(Some((part, next)));
            }
        }
        Ok(None)
    }

    /// The step of the quadratic program around `best`. None if the solver fails.
    fn step(&self, best: &Candidate, model: &Quadratic, damping: f64) -> Option<Proposal> {
        let size = self.problem.points.size();
        let variables = self.problem.points.variables(&best.stream);
        let mut matrix = model.matrix.clone();
        let price = 2.0 * damping / size as f64;
        for i in 0..size {
            matrix.add(i, i, price);
        }
        // A row beyond its limit must not increase.
        let kept = self.rows.iter().filter(|row| !row.terms.is_empty()).map(|row| Row {
            terms: row.terms.iter().map(|(i, weight)| (*i, UNIT * weight)).collect(),
            bound: (1.0 - ROOM - row.value(&variables)).max(0.0),
            price: f64::INFINITY,
        });
        let rows = kept.chain(model.shares.iter().cloned()).collect();
        let program = BandedProgram { matrix, gradient: model.gradient.clone(), rows };
        let Optimum { x, cost } = program.solve(ROUGH_GAP)?;
        let damped: f64 = x.iter().map(|x| 0.5 * price * x * x).sum();
        let predicted = model.broken - (cost - damped);
        Some(Proposal { change: x.iter().map(|x| UNIT * x).collect(), predicted })
    }
}

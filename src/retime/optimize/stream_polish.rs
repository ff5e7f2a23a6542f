//! Lowers the energy of the realised motion of a stream at fixed intervals, within all limits.
//!
//! Sequential quadratic programming on the points. The copper loss is a sum of squares of torques
//! that are linearised in the points (Gauss–Newton). The braking loss is smoothed where the power
//! changes its sign. Joint limits are linear rows and hold exactly; torque and path limits are
//! linearised rows with priced slacks. A limit that a step exceeds is added as a row at the end of
//! that step, and the program is solved again: on the path, the distance from it has no derivative.
//! That distance has a price: a distance equal to the tolerance costs the share `DEVIATION_PRICE` of
//! the energy.

use super::banded_program::{BandedProgram, Optimum, Row};
use super::path_energy::EnergyModel;
use super::plant::{Plant, ROOM, Realised};
use super::polish_problem::{PathPenalty, PolishProblem, Quadratic, UNIT, VIOLATION_PRICE};
use super::stream_limits::StreamLimits;
use super::stream_points::LimitRow;
use super::stream_reference::Reference;
use crate::retime::motion::stream::{Stream, StreamError};

/// Outcome of polishing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PolishStatus {
    /// The stream is as good as was asked for, or no step makes it better.
    Converged,
    /// The iteration limit was reached, or limits stay exceeded by far.
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
/// Excess of limits beyond which a stream is far from allowed: there it costs more than the energy.
pub(super) const FAR: f64 = 1.0 / VIOLATION_PRICE;
/// A larger excess has to fall to this share in so many steps. Chosen on the corners of
/// `fixtures/pick_place` with all suggestions: the streams that became allowed there kept to it.
const FALL: f64 = 0.5;
const PATIENCE: usize = 10;
/// Relative decrease of the merit at which the iteration ends.
const CONVERGED: f64 = 3e-5;
/// Gap of the programs. A step is accepted by its effect on the merit, so low accuracy suffices.
const ROUGH_GAP: f64 = 1e-5;
/// Initial price of a step of one unit in every variable, in initial energies; and its bounds.
const DAMPING: f64 = 1e-3;
const DAMPING_RANGE: (f64, f64) = (1e-6, 1e2);
/// Factor on the damping after a good or a bad step.
const DAMPING_STEP: f64 = 5.0;
/// Largest number of programs for one step.
const PROGRAMS: usize = 3;
/// Share of the predicted decrease at which the linear rows were close enough, and at which a step
/// is accepted.
const CLOSE: f64 = 0.5;
const ENOUGH: f64 = 0.05;
/// Tried parts of a proposed step.
const PARTS: [f64; 4] = [1.0, 0.4, 0.15, 0.05];

/// When the search for a better stream ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// All limits are kept.
    Kept,
    /// All limits are kept and no further step lowers the energy.
    Least,
}

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
    until: Until,
) -> Result<Polished, StreamError> {
    let problem = PolishProblem::new(stream, reference, plant, model, penalty)?;
    let rows = problem.points.limit_rows(limits);
    let polish = Polish { problem, limits, rows, until };
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

/// A proposed change of the variables (rad), the predicted decrease of the merit, and the stream
/// after the change.
struct Proposal {
    change: Vec<f64>,
    predicted: f64,
    next: Candidate,
}

struct Polish<'a, P> {
    problem: PolishProblem<'a, P>,
    limits: &'a StreamLimits,
    /// The joint limits as rows.
    rows: Vec<LimitRow>,
    until: Until,
}

impl<P: Plant> Polish<'_, P> {
    /// Steps of the quadratic programs from `best` on, which becomes the best stream found.
    fn improve(&self, best: &mut Candidate) -> Result<PolishStatus, StreamError> {
        if self.problem.points.size() == 0 {
            return Ok(PolishStatus::Converged);
        }
        let mut damping = DAMPING;
        let mut model = self.quadratic(best);
        let mut earlier = f64::INFINITY;
        for step in 0..MAX_STEPS {
            if step % PATIENCE == 0 {
                if best.realised.excess > FAR.max(FALL * earlier) {
                    return Ok(PolishStatus::Stopped);
                }
                earlier = best.realised.excess;
            }
            if self.until == Until::Kept && best.realised.excess <= 0.0 {
                return Ok(PolishStatus::Converged);
            }
            let Some(step) = self.step(best, &model, damping)? else {
                return Ok(PolishStatus::Converged);
            };
            let predicted = step.predicted;
            let Some((part, next)) = self.along(best, step)? else {
                if damping < DAMPING_RANGE.1 && predicted > CONVERGED {
                    damping *= DAMPING_STEP.powi(2);
                    continue;
                }
                return Ok(PolishStatus::Converged);
            };
            let fall = best.merit - next.merit;
            if part < 1.0 {
                damping *= DAMPING_STEP;
            } else if fall > CLOSE * predicted {
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
        step: Proposal,
    ) -> Result<Option<(f64, Candidate)>, StreamError> {
        let enough = best.merit - ENOUGH * step.predicted;
        if step.next.merit < enough && self.keeps(&step.next, best) {
            return Ok(Some((1.0, step.next)));
        }
        for part in PARTS {
            let next = self.moved(best, &step.change, part)?;
            if self.keeps(&next, best) && next.merit < best.merit {
                return Ok(Some((part, next)));
            }
        }
        Ok(None)
    }

    /// The stream after a part of a change.
    fn moved(&self, best: &Candidate, change: &[f64], part: f64) -> Result<Candidate, StreamError> {
        let from = self.problem.points.variables(&best.stream);
        let to: Vec<f64> = from.iter().zip(change).map(|(x, change)| x + part * change).collect();
        Ok(self.candidate(self.problem.points.stream(&to)?))
    }

    /// Whether a candidate keeps the joint limits, or exceeds them by no more than another.
    fn keeps(&self, next: &Candidate, best: &Candidate) -> bool {
        self.limits.worst_ratio(&next.stream) <= self.limits.worst_ratio(&best.stream).max(1.0)
    }

    /// The best step of the quadratic program around `best`, with the limits that its own streams
    /// exceed. None if the solver fails.
    fn step(
        &self,
        best: &Candidate,
        model: &Quadratic,
        damping: f64,
    ) -> Result<Option<Proposal>, StreamError> {
        let mut exceeded = Vec::new();
        let mut found: Option<Proposal> = None;
        for _ in 0..PROGRAMS {
            let Some((change, predicted)) = self.solution(best, model, &exceeded, damping) else {
                break;
            };
            if predicted <= 0.0 && found.is_some() {
                break;
            }
            let next = self.moved(best, &change, 1.0)?;
            let is_close = next.merit < best.merit - CLOSE * predicted;
            if !is_close {
                exceeded.extend(self.exceeded(&next.stream, &change));
            }
            if found.as_ref().is_none_or(|found| next.merit < found.next.merit) {
                found = Some(Proposal { change, predicted, next });
            }
            if is_close {
                break;
            }
        }
        Ok(found)
    }

    /// The limits that a stream exceeds after a change, as rows for the change.
    fn exceeded(&self, next: &Stream, change: &[f64]) -> Vec<Row> {
        let mut rows = self.problem.exceeded(next);
        for row in &mut rows {
            let moved = row.terms.iter().map(|(i, weight)| weight * change[*i] / UNIT);
            row.bound += moved.sum::<f64>();
        }
        rows
    }

    /// The change (rad) that solves the quadratic program around `best` with more rows, and the
    /// predicted decrease of the merit. None if the solver fails.
    fn solution(
        &self,
        best: &Candidate,
        model: &Quadratic,
        more: &[Row],
        damping: f64,
    ) -> Option<(Vec<f64>, f64)> {
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
        let rows = kept.chain(model.shares.iter().chain(more).cloned()).collect();
        let program = BandedProgram { matrix, gradient: model.gradient.clone(), rows };
        let Optimum { x, cost } = program.solve(ROUGH_GAP)?;
        let damped: f64 = x.iter().map(|x| 0.5 * price * x * x).sum();
        let predicted = model.broken - (cost - damped);
        Some((x.iter().map(|x| UNIT * x).collect(), predicted))
    }
}

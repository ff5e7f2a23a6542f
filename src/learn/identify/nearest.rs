//! The physically consistent parameters nearest to a fit.

use nalgebra::{DMatrix, DVector};

use crate::arm::dynamics::{
    BaseParameters, JOINT, Load, RIGID, link_parameters, parameters, pseudo_inertia,
};
use crate::arm::robot::Model;

use super::consistent::{Piece, Target, consistent, placed};
use super::factors::Factors;
use super::fit::Fit;
use super::guess::{prior, small_body};
use super::least_squares::{Solution, solve};
use super::settings::Free;

/// Largest number of rounds that lift bounds.
const FREED: usize = 3;
/// A parameter below this share of its prior has an active lower bound.
const BOUND: f64 = 0.3;
/// Least share of the residuals' power that lifting bounds has to remove.
const WORTH: f64 = 0.005;
/// Least residuals as a share of the torque.
const DIGITS: f64 = 1e-4;
/// Typical size of an unknown parameter, in its SI unit.
const SMALL: f64 = 1e-3;

/// Computes physically consistent free parameters, with the priors and scales of the fit to all
/// data.
pub(super) struct Nearest<'a> {
    pieces: Vec<Piece>,
    fit: &'a Fit,
    base: &'a BaseParameters,
    among: &'a [usize],
}

impl Nearest<'_> {
    /// `among` contains the indices of the free parameters among all standard parameters.
    pub(super) fn new<'a>(
        model: &Model,
        free: Free,
        fit: &'a Fit,
        base: &'a BaseParameters,
        among: &'a [usize],
    ) -> Nearest<'a> {
        Nearest { pieces: pieces(model, free, fit, base, among), fit, base, among }
    }

    /// The free parameters nearest to the unconstrained solution of `factors`.
    pub(super) fn parameters(&self, factors: &Factors) -> Option<DVector<f64>> {
        // Each joint is weighted by its residuals, also after an ordinary fit. The lower bound
        // avoids excessive accuracy for noiseless data.
        let fit = self.fit;
        let weights: Vec<f64> = fit
            .rms
            .iter()
            .zip(&fit.relative_rms)
            .map(|(rms, relative)| 1.0 / rms.max(DIGITS * rms / relative).max(f64::MIN_POSITIVE))
            .collect();
        let weighted = solve(&factors.stacked(&weights, self.base.rank()));
        let beta = DVector::from_iterator(
            weighted.determined.len(),
            weighted.determined.iter().map(|k| weighted.beta[*k]),
        );
        let target = Target {
            combination: &combination(self.base, &weighted, self.among),
            factor: &weighted.factor,
            beta: &beta,
            least: factors.rows_without(None).iter().sum::<usize>() as f64,
        };
        let found = consistent(&self.pieces, &target)?;
        Some(self.with_apparent(&target, found))
    }

    /// The base parameters of the free parameters `free`; fixed ones count as 0.
    pub(super) fn base_values(&self, free: &[f64]) -> DVector<f64> {
        DVector::from_vec(base_values(self.base, self.among, free))
    }

    /// Lifts the bound of rotor inertias and viscous frictions if it costs the fit much: a delay, a
    /// filter or elasticity gives them negative apparent values.
    fn with_apparent(&self, target: &Target<'_>, mut found: DVector<f64>) -> DVector<f64> {
        let Nearest { pieces, fit, base, among } = self;
        let rigid = RIGID * base.dof;
        let kind = |index: usize| index.checked_sub(rigid).map(|k| k % JOINT);
        let free = |index: usize| matches!(kind(index), Some(0 | 1));
        // Largest standard deviation of the parameters of one kind.
        let size = |of: usize| -> f64 {
            let all = fit.solution.determined.iter().enumerate();
            all.filter(|(_, row)| kind(base.independent[**row]) == kind(of))
                .map(|(k, _)| fit.covariance[(k, k)].sqrt())
                .fold(SMALL, f64::max)
        };
        let mut pieces = pieces.clone();
        let mut missed = target.squares(&found);
        for _ in 0..FREED {
            let lifted = |(at, piece): (usize, &Piece)| match piece {
                Piece::Positive(prior) if free(among[at]) && found[at] < BOUND * prior => {
                    Piece::Any(size(among[at]))
                }
                other => other.clone(),
            };
            let freed: Vec<Piece> = placed(&pieces).map(lifted).collect();
            if freed == pieces {
                break;
            }
            let Some(next) = consistent(&freed, target) else { break };
            let misses = target.squares(&next);
            if misses > (1.0 - WORTH) * missed {
                break;
            }
            (pieces, found, missed) = (freed, next, misses);
        }
        found
    }
}

/// The base parameters of the free parameters `free` with the indices `among`; fixed ones count as
/// 0.
pub(super) fn base_values(base: &BaseParameters, among: &[usize], free: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; (RIGID + JOINT) * base.dof];
    for (index, value) in among.iter().zip(free) {
        all[*index] = *value;
    }
    base.of_parameters(&all)
}

/// The determined base parameters as combinations of the free parameters; inseparable base
/// parameters are merged.
fn combination(base: &BaseParameters, solution: &Solution, among: &[usize]) -> DMatrix<f64> {
    let place = |index: usize| among.iter().position(|known| *known == index);
    let row_of = |row: usize| {
        let mut values = vec![0.0; among.len()];
        if let Some(head) = place(base.independent[row]) {
            values[head] = 1.0;
        }
        for (k, index) in base.dependent.iter().enumerate() {
            if let Some(to) = place(*index) {
                values[to] = base.grouping[(row, k)];
            }
        }
        values
    };
    let determined = &solution.determined;
    let mut rows: Vec<Vec<f64>> = determined.iter().map(|row| row_of(*row)).collect();
    for (column, parts) in &solution.dependent {
        let values = row_of(*column);
        for (to, factor) in parts {
            if let Some(row) = determined.iter().position(|known| known == to) {
                for (sum, value) in rows[row].iter_mut().zip(&values) {
                    *sum += factor * value;
                }
            }
        }
    }
    DMatrix::from_fn(rows.len(), among.len(), |row, column| rows[row][column])
}

/// The free parameters with their priors.
fn pieces(
    model: &Model,
    free: Free,
    fit: &Fit,
    base: &BaseParameters,
    among: &[usize],
) -> Vec<Piece> {
    let n = model.dof;
    let rigid = RIGID * n;
    if free == Free::Payload {
        return vec![Piece::Body(pseudo_inertia(&link_parameters(&small_body(model))))];
    }
    let mut pieces = Vec::new();
    if free == Free::All {
        pieces.extend((0..n).map(|joint| Piece::Body(prior(model, joint))));
    }
    let nominal = parameters(model, &Load::none());
    for index in among.iter().filter(|index| **index >= rigid) {
        // Value and standard deviation, if the data determine this parameter alone.
        let estimate = base.independent.iter().position(|known| known == index).and_then(|row| {
            let k = fit.solution.determined.iter().position(|known| *known == row)?;
            Some((fit.solution.beta[row], fit.covariance[(k, k)].sqrt()))
        });
        let kind = (index - rigid) % JOINT;
        if kind == JOINT - 1 {
            let size = estimate.map_or(1.0, |(value, sd)| value.abs().max(sd));
            pieces.push(Piece::Any(size.max(SMALL)));
        } else {
            let nominal = nominal.get(*index).copied().unwrap_or(0.0);
            let known = estimate.map_or(0.0, |(value, sd)| value.max(sd));
            pieces.push(Piece::Positive(if nominal > 0.0 { nominal } else { known.max(SMALL) }));
        }
    }
    pieces
}

//! Base parameters from a log: weighted least squares, standard errors, cross-validation.

use nalgebra::{DMatrix, DVector};

use super::equations::Equations;
use super::error::IdentifyError;
use super::factors::Factors;
use super::least_squares::{Condition, Solution, solve};
use super::misses::{Misses, root_mean};
use super::noise::{Residual, autocovariance};
use super::repetitions::{self, Fold};
use super::samples::Samples;
use super::whiteness::{Whiteness, whiteness};

/// Number of parts of the time in cross-validation.
const PARTS: usize = 5;
/// Least number of equations per unknown.
const LEAST: usize = 2;
/// Largest number of reweighting rounds.
const ROUNDS: usize = 20;
/// Relative change of the weights at which reweighting ends.
const SETTLED: f64 = 1e-4;
/// Number of instants for the effect of coloured noise on the covariance.
const INSTANTS: usize = 6000;
/// Ratio of residual to noise variance above which the residuals contain model error.
const MISSES: f64 = 1.5;
/// Length of a piece of consecutive instants, in lags of the noise.
const PIECE: usize = 12;

/// How the joints are weighted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weighting {
    /// Equal weights: ordinary least squares.
    Ordinary,
    /// By the standard deviation of each joint's residuals, iteratively.
    Joint,
}

/// A fit of the base parameters.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The solution.
    pub solution: Solution,
    /// Covariance of the determined parameters.
    pub covariance: DMatrix<f64>,
    /// Condition of the weighted equations.
    pub condition: Condition,
    /// Usable equations of each joint.
    pub rows: Vec<usize>,
    /// Root mean square of each joint's residuals \[Nm\].
    pub rms: Vec<f64>,
    /// `rms` over the root mean square of the torque \[1\].
    pub relative_rms: Vec<f64>,
    /// Root mean square of held-out residuals \[Nm\].
    pub cross_rms: Vec<f64>,
    /// Whether `cross_rms` is over held-out repetitions, for one instant of a single repetition;
    /// else it is over held-out fifths of the time.
    pub over_repetitions: bool,
    /// Autocorrelation of each joint's residuals at lag 1.
    pub memory: Vec<f64>,
    /// Whiteness of each joint's residuals; `None` with too few instants.
    pub whiteness: Vec<Option<Whiteness>>,
    /// The equations.
    pub factors: Factors,
    /// The folds of cross-validation: groups of repetitions; `None`: parts of the time.
    pub(super) folds: Option<Vec<Fold>>,
}

/// Root mean square of each joint's held-out residuals \[Nm\]; `found` gives the parameters for the
/// equations of the other parts, `factors` are those of all parts.
pub(super) fn held_out_rms(
    folds: Option<&[Fold]>,
    factors: &Factors,
    found: &dyn Fn(&Factors) -> DVector<f64>,
) -> Vec<f64> {
    let joints = factors.layout.columns.len();
    if let Some(folds) = folds {
        let (squares, rows) = repetitions::cross_squares(folds, joints, found);
        return root_mean(&squares, &rows);
    }
    let mut sums = vec![0.0; joints];
    for part in 0..factors.parts.len() {
        let beta = found(&factors.merged(Some(part)));
        let squares = factors.residual_squares(&beta, Some(part));
        sums.iter_mut().zip(squares).for_each(|(sum, of)| *sum += of);
    }
    root_mean(&sums, &factors.rows_without(None))
}

/// Fits the base parameters of `equations` to `samples`.
///
/// # Errors
/// Fewer equations than unknowns.
pub fn fit(
    equations: &Equations<'_>,
    samples: &Samples,
    weighting: Weighting,
) -> Result<Fit, IdentifyError> {
    let unknowns = equations.base.rank();
    let factors = Factors::new(equations, samples, PARTS);
    let rows = factors.rows_without(None);
    let count: usize = rows.iter().sum();
    // With as many unknowns as equations, the residuals are always 0.
    if count < LEAST * unknowns {
        return Err(IdentifyError::TooFew { equations: count, unknowns });
    }
    let merged = factors.merged(None);
    let (solution, weights) = reweighted(&merged, weighting, unknowns);
    let Misses { rms, relative } = Misses::new(&solution.beta, std::slice::from_ref(&factors));
    let folds = repetitions::folds(equations, samples);
    let free = |part: &Factors| reweighted(part, weighting, unknowns).0.beta;
    let cross_rms = held_out_rms(folds.as_deref(), &factors, &free);
    let Errors { covariance, memory, whiteness } =
        errors(equations, samples, &merged, &solution, &weights, weighting);
    Ok(Fit {
        condition: solution.condition(),
        rms,
        relative_rms: relative,
        cross_rms,
        over_repetitions: folds.is_some(),
        folds,
        covariance,
        memory,
        whiteness,
        rows,
        solution,
        factors,
    })
}

/// Root mean square of each joint's residuals in a fit without standard errors \[Nm\].
pub(super) fn without_errors(factors: &Factors, unknowns: usize) -> Vec<f64> {
    let (solution, _) = reweighted(factors, Weighting::Joint, unknowns);
    root_mean(&factors.residual_squares(&solution.beta, None), &factors.rows_without(None))
}

/// The solution, and the weight of each joint: the inverse standard deviation of its residuals.
pub(super) fn reweighted(
    factors: &Factors,
    weighting: Weighting,
    unknowns: usize,
) -> (Solution, Vec<f64>) {
    let rows = factors.rows_without(None);
    let mut sigma = vec![1.0; rows.len()];
    let mut weights = sigma.clone();
    let mut solution = solve(&factors.stacked(&weights, unknowns));
    if weighting == Weighting::Ordinary {
        return (solution, weights);
    }
    for _ in 0..ROUNDS {
        let squares = factors.residual_squares(&solution.beta, None);
        let lost = lost(factors, &solution, &weights);
        let next: Vec<f64> = (0..rows.len())
            .map(|joint| {
                let n = rows[joint] as f64;
                let torque: f64 = factors.squares.iter().map(|part| part[joint]).sum();
                let found = (squares[joint] / (n - lost[joint]).max(1.0)).sqrt();
                // Lower bound for noiseless data.
                found.max(1e-9 * (torque / n.max(1.0)).sqrt()).max(1e-12)
            })
            .collect();
        let change = next.iter().zip(&sigma).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
        sigma = next;
        weights = sigma.iter().map(|sigma| 1.0 / sigma).collect();
        solution = solve(&factors.stacked(&weights, unknowns));
        if change < SETTLED {
            break;
        }
    }
    (solution, weights)
}

/// Degrees of freedom that the fit uses of each joint's equations.
fn lost(factors: &Factors, solution: &Solution, weights: &[f64]) -> Vec<f64> {
    let inverse = solution.inverse_normal();
    let place = |column: &usize| solution.determined.iter().position(|known| known == column);
    factors
        .layout
        .columns
        .iter()
        .enumerate()
        .map(|(joint, columns)| {
            let kept: Vec<(usize, usize)> = columns
                .iter()
                .enumerate()
                .filter_map(|(from, column)| Some((from, place(column)?)))
                .collect();
            let mut trace = 0.0;
            for part in &factors.parts {
                for row in part[joint].row_iter() {
                    for (from, to) in &kept {
                        if row[*from] == 0.0 {
                            continue;
                        }
                        let product: f64 =
                            kept.iter().map(|(f, t)| inverse[(*to, *t)] * row[*f]).sum();
                        trace += row[*from] * product;
                    }
                }
            }
            trace * weights[joint] * weights[joint]
        })
        .collect()
}

struct Errors {
    covariance: DMatrix<f64>,
    memory: Vec<f64>,
    whiteness: Vec<Option<Whiteness>>,
}

/// Covariance of the parameters with the noise of the residuals.
fn errors(
    equations: &Equations<'_>,
    samples: &Samples,
    factors: &Factors,
    solution: &Solution,
    weights: &[f64],
    weighting: Weighting,
) -> Errors {
    let joints = weights.len();
    let layout = &factors.layout;
    let mut residuals: Vec<Vec<Residual>> = vec![Vec::new(); joints];
    let mut instants = 0;
    equations.each(samples, layout, &mut |instant| {
        instants += 1;
        for (joint, columns, place) in layout.joints().filter(|(j, ..)| instant.usable[*j]) {
            let predicted = instant.predicted(columns, place, solution.beta.as_slice());
            residuals[joint].push((instant.block, instant.index, instant.y[joint] - predicted));
        }
    });
    let lost = lost(factors, solution, weights);
    let mut noise: Vec<Vec<f64>> =
        residuals.iter().zip(&lost).map(|(e, lost)| autocovariance(e, *lost)).collect();
    if let Some(known) = &samples.noise {
        for (found, known) in noise.iter_mut().zip(known) {
            // The noise of repetitions does not depend on the fit. Much larger residuals contain
            // model error and are used instead.
            if found[0] < MISSES * known[0] {
                found.clone_from(known);
            }
        }
    }
    let whiteness = residuals.iter().map(|of| whiteness(of)).collect();
    drop(residuals);
    let memory = noise
        .iter()
        .map(|of| if of[0] > 0.0 { of.get(1).copied().unwrap_or(0.0) / of[0] } else { 0.0 })
        .collect();
    let inverse = solution.inverse_normal();
    let white = noise.iter().all(|of| of.len() == 1);
    if white && weighting == Weighting::Joint && samples.noise.is_none() {
        return Errors { covariance: inverse, memory, whiteness };
    }
    let noise = Noise { weights, autocovariances: &noise };
    let middle = between(equations, samples, factors, solution, &noise, instants);
    Errors { covariance: &inverse * middle * &inverse, memory, whiteness }
}

/// Noise of each joint's equations: w, the inverse standard deviation, and the autocovariances Ω.
struct Noise<'a> {
    weights: &'a [f64],
    autocovariances: &'a [Vec<f64>],
}

/// Σ w⁴ Xᵀ Ω X over the joints, from pieces of the log.
fn between(
    equations: &Equations<'_>,
    samples: &Samples,
    factors: &Factors,
    solution: &Solution,
    noise: &Noise<'_>,
    instants: usize,
) -> DMatrix<f64> {
    let layout = &factors.layout;
    let lags = noise.autocovariances.iter().map(Vec::len).max().unwrap_or(1);
    let piece = (PIECE * lags).max(200);
    let pieces = (INSTANTS / piece).max(2);
    let period = (instants / pieces).max(piece);
    let unknowns = solution.beta.len();
    let mut middle = DMatrix::zeros(unknowns, unknowns);
    let mut used = vec![0_usize; noise.weights.len()];
    // Rows of the current piece; unusable ones are zeros.
    let mut rows: Vec<f64> = Vec::new();
    let width = layout.width();
    let mut number = 0;
    let mut block = 0;
    let mut close = |rows: &mut Vec<f64>| {
        if !rows.is_empty() {
            add_piece(&mut middle, rows, width, factors, noise);
        }
        rows.clear();
    };
    equations.each(samples, layout, &mut |instant| {
        if number % period == 0 || number % period == piece || instant.block != block {
            close(&mut rows);
        }
        block = instant.block;
        if number % period < piece {
            for (joint, columns, place) in layout.joints() {
                if instant.usable[joint] {
                    rows.extend(&instant.x[place]);
                    used[joint] += 1;
                } else {
                    rows.resize(rows.len() + columns.len(), 0.0);
                }
            }
        }
        number += 1;
    });
    close(&mut rows);
    // The pieces are a sample of all instants.
    let all: usize = factors.rows_without(None).iter().sum();
    let share = all as f64 / used.iter().sum::<usize>().max(1) as f64;
    let kept = middle.select_columns(&solution.determined).select_rows(&solution.determined);
    kept * share
}

fn add_piece(
    middle: &mut DMatrix<f64>,
    rows: &[f64],
    width: usize,
    factors: &Factors,
    noise: &Noise<'_>,
) {
    let count = rows.len() / width;
    for (joint, columns, place) in factors.layout.joints() {
        let x = DMatrix::from_fn(count, columns.len(), |i, k| rows[i * width + place.start + k]);
        let mut coloured = DMatrix::zeros(count, columns.len());
        for k in 0..columns.len() {
            let column = x.column(k);
            let mut to = coloured.column_mut(k);
            for (lag, covariance) in noise.autocovariances[joint].iter().enumerate().take(count) {
                for i in 0..count - lag {
                    to[i] += covariance * column[i + lag];
                    if lag > 0 {
                        to[i + lag] += covariance * column[i];
                    }
                }
            }
        }
        let product = x.tr_mul(&coloured) * noise.weights[joint].powi(4);
        for (a, to) in columns.iter().enumerate() {
            for (b, other) in columns.iter().enumerate() {
                middle[(*to, *other)] += product[(a, b)];
            }
        }
    }
}

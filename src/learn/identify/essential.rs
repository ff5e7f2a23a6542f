//! Significant parameters of a fit, and collinear ones.

use nalgebra::{DMatrix, DVector};

use super::fit::Fit;

/// Distance from 0, in standard deviations, below which a parameter is not significant.
const CARRIES: f64 = 2.0;
/// Least condition index of collinear parameters (D. Belsley, E. Kuh, R. Welsch, "Regression
/// diagnostics", 1980).
const INDEX: f64 = 30.0;
/// Least share of a parameter's variance in a collinear direction.
const SHARE: f64 = 0.5;

/// A group of collinear parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Collinear {
    /// Condition index of the direction.
    pub index: f64,
    /// The base parameters, ascending.
    pub parameters: Vec<usize>,
}

/// The significant base parameters, by backward elimination: the least significant ones are removed
/// first.
#[must_use]
pub fn essential(fit: &Fit) -> Vec<usize> {
    let solution = &fit.solution;
    let white = solution.inverse_normal();
    // Factor by which coloured noise increases the variance of each parameter.
    let count = solution.determined.len();
    let more: Vec<f64> = (0..count)
        .map(|k| (fit.covariance[(k, k)] / white[(k, k)]).max(f64::MIN_POSITIVE))
        .collect();
    let right = &solution.factor
        * DVector::from_iterator(count, solution.determined.iter().map(|k| solution.beta[*k]));
    let mut kept: Vec<usize> = (0..count).collect();
    while kept.len() > 1 {
        let part = solution.factor.select_columns(&kept);
        let Some(inverse) = (part.tr_mul(&part)).try_inverse() else { break };
        let beta: DVector<f64> = &inverse * part.tr_mul(&right);
        let weakest = (0..kept.len())
            .map(|k| (k, beta[k] * beta[k] / (inverse[(k, k)] * more[kept[k]])))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        match weakest {
            Some((k, significance)) if significance < CARRIES * CARRIES => kept.remove(k),
            _ => break,
        };
    }
    kept.into_iter().map(|k| solution.determined[k]).collect()
}

/// Groups of parameters that the motion hardly separates.
#[must_use]
pub fn collinear(fit: &Fit) -> Vec<Collinear> {
    let solution = &fit.solution;
    let (scaled, _) = solution.scaled();
    if scaled.ncols() == 0 {
        return Vec::new();
    }
    let svd = scaled.svd(false, true);
    let Some(v) = svd.v_t else { return Vec::new() };
    let largest = svd.singular_values.max();
    let part = DMatrix::from_fn(v.nrows(), v.ncols(), |direction, k| {
        (v[(direction, k)] / svd.singular_values[direction]).powi(2)
    });
    let total: Vec<f64> = part.column_iter().map(|column| column.sum()).collect();
    let mut groups = Vec::new();
    for direction in 0..v.nrows() {
        let index = largest / svd.singular_values[direction];
        let parameters: Vec<usize> = (0..v.ncols())
            .filter(|k| part[(direction, *k)] > SHARE * total[*k])
            .map(|k| solution.determined[k])
            .collect();
        if index > INDEX && parameters.len() > 1 {
            groups.push(Collinear { index, parameters });
        }
    }
    groups.sort_by(|a, b| b.index.total_cmp(&a.index));
    groups
}

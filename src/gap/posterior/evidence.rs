//! How probable measurements are with some columns of a small linear model.

use nalgebra::{Cholesky, DMatrix, DVector};

/// Marginal likelihoods with columns whose factors have normal priors about 0.
pub(in crate::gap) struct Evidence {
    /// `ΦᵀWΦ` and `ΦᵀWy`, the parameters marginalised.
    a: DMatrix<f64>,
    b: DVector<f64>,
    /// Standard deviations of the factors.
    sds: DVector<f64>,
}

/// Factors of some columns.
pub(in crate::gap) struct Estimate {
    /// Their expected values.
    pub mean: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
}

impl Evidence {
    /// From weighted products of the difference, `parameters` parameters (in deviations) and columns;
    /// `None` if these are no numbers.
    #[must_use]
    pub(in crate::gap) fn new(
        gram: &DMatrix<f64>,
        parameters: usize,
        sds: DVector<f64>,
    ) -> Option<Evidence> {
        let (first, count) = (1 + parameters, sds.len());
        let view = |row: usize, column: usize, rows: usize, columns: usize| {
            gram.view((row, column), (rows, columns)).into_owned()
        };
        let pp = view(1, 1, parameters, parameters) + DMatrix::identity(parameters, parameters);
        let pc = view(1, first, parameters, count);
        let solved = Cholesky::new(pp)?.solve(&pc);
        let a = view(first, first, count, count) - pc.tr_mul(&solved);
        let b = view(first, 0, count, 1) - solved.tr_mul(&view(1, 0, parameters, 1));
        Some(Evidence { a, b: b.column(0).into_owned(), sds })
    }

    /// Logarithm of how much more probable the measurement is with the columns than without.
    #[must_use]
    pub(in crate::gap) fn gain(&self, columns: &[usize]) -> f64 {
        let Some(factor) = self.factor(columns) else { return f64::NEG_INFINITY };
        let right =
            DVector::from_fn(columns.len(), |k, _| self.sds[columns[k]] * self.b[columns[k]]);
        let log_det: f64 = factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum();
        0.5 * right.dot(&factor.solve(&right)) - log_det
    }

    /// The columns' factors.
    #[must_use]
    pub(in crate::gap) fn estimate(&self, columns: &[usize]) -> Option<Estimate> {
        let inverse = self.factor(columns)?.inverse();
        let sd = |k: usize| self.sds[columns[k]];
        let n = columns.len();
        let covariance = DMatrix::from_fn(n, n, |i, k| sd(i) * sd(k) * inverse[(i, k)]);
        let left = DVector::from_fn(n, |k, _| self.b[columns[k]]);
        Some(Estimate { mean: &covariance * left, covariance })
    }

    /// Factor of `I + S A S`.
    fn factor(&self, columns: &[usize]) -> Option<Cholesky<f64, nalgebra::Dyn>> {
        let n = columns.len();
        let sd = |k: usize| self.sds[columns[k]];
        Cholesky::new(DMatrix::from_fn(n, n, |i, k| {
            sd(i) * sd(k) * self.a[(columns[i], columns[k])] + if i == k { 1.0 } else { 0.0 }
        }))
    }
}

//! How probable the measurement is with some columns and without them, whatever their factors
//! and the model's parameters are.

use nalgebra::{Cholesky, DMatrix, DVector};

/// Marginal likelihoods at one size of the model's own error.
pub struct Evidence {
    /// `ΦᵀWΦ` with the parameters marginalised.
    a: DMatrix<f64>,
    /// `ΦᵀWy`, the same.
    b: DVector<f64>,
    means: DVector<f64>,
    sds: DVector<f64>,
    parameters: Option<OfParameters>,
    /// Logarithm of the probability of the measurement without any column, up to a constant.
    pub null: f64,
}

/// What tells the model's parameters, in deviations.
struct OfParameters {
    factor: Cholesky<f64, nalgebra::Dyn>,
    /// `YᵀWy` and `YᵀWΦ`.
    y: DVector<f64>,
    c: DMatrix<f64>,
}

/// Products of the difference, the parameters and columns with some of the columns.
pub(super) struct Products {
    /// Places of these among the columns.
    pub(super) of: Vec<usize>,
    /// By row, then by column.
    pub(super) with: DMatrix<f64>,
    /// Expected factors of these, and their deviations.
    pub(super) means: Vec<f64>,
    pub(super) sds: Vec<f64>,
}

/// Evidence when some columns are there.
pub struct Given {
    /// What these bring.
    base: f64,
    columns: Vec<usize>,
    evidence: Evidence,
}

impl Given {
    /// Gain of the columns that are there and of more.
    #[must_use]
    pub fn gain(&self, more: &[usize]) -> f64 {
        let more: Vec<usize> =
            more.iter().copied().filter(|column| !self.columns.contains(column)).collect();
        self.base + self.evidence.gain(&more)
    }

    /// Takes another measurement, by its products with the columns.
    pub(super) fn measure(&mut self, products: DVector<f64>) {
        self.evidence.b = products;
    }
}

/// Factors of some columns.
pub struct Estimate {
    /// Their expected values.
    pub mean: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
}

impl Evidence {
    /// Of weighted products of difference, `parameters` parameters (in deviations) and columns.
    pub(super) fn new(
        gram: &DMatrix<f64>,
        parameters: usize,
        means: DVector<f64>,
        sds: DVector<f64>,
        log_weights: f64,
    ) -> Evidence {
        let count = means.len();
        let first = 1 + parameters;
        let yy = gram[(0, 0)];
        let yp = gram.view((1, 0), (parameters, 1)).into_owned();
        let pp = gram.view((1, 1), (parameters, parameters)).into_owned()
            + DMatrix::identity(parameters, parameters);
        let pc = gram.view((1, first), (parameters, count)).into_owned();
        let cc = gram.view((first, first), (count, count)).into_owned();
        let yc = gram.view((first, 0), (count, 1)).column(0).into_owned();
        let Some(factor) = Cholesky::new(pp) else {
            let null = f64::NEG_INFINITY;
            return Evidence { a: cc, b: yc, means, sds, parameters: None, null };
        };
        let lower = factor.l();
        let solved_c = lower.solve_lower_triangular(&pc).unwrap_or_else(|| pc.clone());
        let solved_y = lower.solve_lower_triangular(&yp).unwrap_or_else(|| yp.clone());
        let left = yy - solved_y.norm_squared();
        let log_det: f64 = lower.diagonal().iter().map(|x| x.ln()).sum();
        Evidence {
            a: cc - solved_c.transpose() * &solved_c,
            b: yc - solved_c.tr_mul(&solved_y).column(0),
            means,
            sds,
            parameters: Some(OfParameters { factor, y: yp.column(0).into_owned(), c: pc }),
            null: log_weights - 0.5 * left - log_det,
        }
    }

    /// Takes other columns in the place of some.
    pub(super) fn replace(&mut self, products: &Products) {
        let Some(of) = &mut self.parameters else { return };
        let (count, first) = (of.y.len(), 1 + of.y.len());
        for (place, column) in products.of.iter().zip(products.with.column_iter()) {
            of.c.column_mut(*place).copy_from(&column.rows(1, count));
        }
        for (k, place) in products.of.iter().enumerate() {
            let column = products.with.column(k);
            let told = of.factor.solve(&column.rows(1, count).into_owned());
            let left = column.rows_range(first..) - of.c.tr_mul(&told);
            self.a.column_mut(*place).copy_from(&left);
            self.a.row_mut(*place).tr_copy_from(&left);
            self.b[*place] = column[0] - of.y.dot(&told);
            (self.means[*place], self.sds[*place]) = (products.means[k], products.sds[k]);
        }
    }

    /// Products of the columns with measurements of noise alone, whose own products are `noise`, the
    /// parameters being off as they may be and marginalised.
    pub(super) fn by_chance(
        &self,
        noise: &DMatrix<f64>,
        normal: &mut impl FnMut() -> f64,
    ) -> DMatrix<f64> {
        let columns = noise.rows(noise.nrows() - self.b.len(), self.b.len());
        let Some(of) = &self.parameters else { return columns.into_owned() };
        let count = of.y.len();
        let off = DMatrix::from_fn(count, noise.ncols(), |_, _| normal());
        columns + of.c.transpose() * of.factor.solve(&(off - noise.rows(1, count)))
    }

    /// Logarithm of how much more probable the measurement is with the columns than without.
    #[must_use]
    pub fn gain(&self, columns: &[usize]) -> f64 {
        let (fixed, left) = self.of_means(columns);
        let free: Vec<usize> = (0..columns.len()).filter(|k| self.sds[columns[*k]] > 0.0).collect();
        if free.is_empty() {
            return fixed;
        }
        // In deviations: I + S A S.
        let sd = |k: usize| self.sds[columns[free[k]]];
        let a = |i: usize, k: usize| self.a[(columns[free[i]], columns[free[k]])];
        let scaled = DMatrix::from_fn(free.len(), free.len(), |i, k| {
            sd(i) * sd(k) * a(i, k) + if i == k { 1.0 } else { 0.0 }
        });
        let right = DVector::from_fn(free.len(), |k, _| sd(k) * left[free[k]]);
        let Some(factor) = Cholesky::new(scaled) else { return f64::NEG_INFINITY };
        let lower = factor.l();
        let log_det: f64 = lower.diagonal().iter().map(|x| x.ln()).sum();
        let solved = lower.solve_lower_triangular(&right).unwrap_or(right);
        fixed + 0.5 * solved.norm_squared() - log_det
    }

    /// What is left to explain when some columns are there: gains count on top of theirs.
    #[must_use]
    pub fn given(&self, columns: &[usize]) -> Given {
        let base = self.gain(columns);
        let mut b = self.b.clone();
        for column in columns.iter().filter(|column| self.means[**column] != 0.0) {
            b.axpy(-self.means[*column], &self.a.column(*column), 1.0);
        }
        let free: Vec<usize> =
            columns.iter().copied().filter(|column| self.sds[*column] > 0.0).collect();
        let mut a = self.a.clone();
        if !free.is_empty() {
            let n = free.len();
            let sd = |k: usize| self.sds[free[k]];
            let scaled = DMatrix::from_fn(n, n, |i, k| {
                sd(i) * sd(k) * self.a[(free[i], free[k])] + if i == k { 1.0 } else { 0.0 }
            });
            let across = DMatrix::from_fn(n, a.ncols(), |i, k| sd(i) * self.a[(free[i], k)]);
            let left = DVector::from_fn(n, |k, _| sd(k) * b[free[k]]);
            if let Some(factor) = Cholesky::new(scaled) {
                let lower = factor.l();
                let across = lower.solve_lower_triangular(&across).unwrap_or(across);
                let left = lower.solve_lower_triangular(&left).unwrap_or(left);
                a.gemm(-1.0, &across.transpose(), &across, 1.0);
                b.gemv_tr(-1.0, &across, &left, 1.0);
            }
        }
        let evidence = Evidence {
            a,
            b,
            means: self.means.clone(),
            sds: self.sds.clone(),
            parameters: None,
            null: self.null,
        };
        Given { base, columns: columns.to_vec(), evidence }
    }

    /// The columns' factors.
    #[must_use]
    pub fn estimate(&self, columns: &[usize]) -> Option<Estimate> {
        let (_, left) = self.of_means(columns);
        let n = columns.len();
        let sd = DVector::from_fn(n, |k, _| self.sds[columns[k]]);
        let scaled = DMatrix::from_fn(n, n, |i, k| {
            sd[i] * sd[k] * self.a[(columns[i], columns[k])] + if i == k { 1.0 } else { 0.0 }
        });
        let inverse = Cholesky::new(scaled)?.inverse();
        let covariance = DMatrix::from_fn(n, n, |i, k| sd[i] * sd[k] * inverse[(i, k)]);
        let means = DVector::from_fn(n, |k, _| self.means[columns[k]]);
        Some(Estimate { mean: means + &covariance * left, covariance })
    }

    /// The parameters of the model, in deviations, with these factors of columns.
    #[must_use]
    pub fn parameters(&self, columns: &[usize], factors: &DVector<f64>) -> DVector<f64> {
        let Some(of) = &self.parameters else { return DVector::zeros(0) };
        let mut right = of.y.clone();
        for (column, factor) in columns.iter().zip(factors.iter()) {
            right.axpy(-factor, &of.c.column(*column), 1.0);
        }
        of.factor.solve(&right)
    }

    /// What the expected factors explain, and what is left for the rest.
    fn of_means(&self, columns: &[usize]) -> (f64, DVector<f64>) {
        let mut fixed = 0.0;
        let mut left = DVector::from_fn(columns.len(), |k, _| self.b[columns[k]]);
        for column in columns {
            let mean = self.means[*column];
            if mean == 0.0 {
                continue;
            }
            fixed += mean * self.b[*column];
            for (i, other) in columns.iter().enumerate() {
                let product = mean * self.a[(*other, *column)];
                left[i] -= product;
                fixed -= 0.5 * product * self.means[*other];
            }
        }
        (fixed, left)
    }
}

#[cfg(test)]
mod tests {
    use super::super::normal::normal;
    use super::*;

    /// Rounding.
    const SAME: f64 = 1e-12;
    /// How far columns are apart that are nearly alike.
    const ALIKE: f64 = 1e-8;
    /// Draws, and how far their covariance may be off, of itself.
    const MANY: usize = 20_000;
    const NEAR: f64 = 0.1;

    /// Products of a difference, two parameters and three columns over some rows.
    fn products(columns: &DMatrix<f64>) -> Evidence {
        let gram = columns.transpose() * columns;
        let [means, sds] =
            [[0.0, 1.0, 0.0], [2.0, 0.5, 1.0]].map(|of| DVector::from_row_slice(&of));
        Evidence::new(&gram, 2, means, sds, 0.0)
    }

    #[test]
    fn a_replaced_column_counts_as_if_it_had_always_been_there() {
        let mut random = fastrand::Rng::with_seed(5);
        let before = DMatrix::from_fn(20, 6, |_, _| random.f64() - 0.5);
        let mut after = before.clone();
        after.column_mut(4).iter_mut().for_each(|x| *x = random.f64());
        let mut evidence = products(&before);
        let with = DMatrix::from_columns(&[after.transpose() * after.column(4)]);
        evidence.replace(&Products { of: vec![1], with, means: vec![1.0], sds: vec![0.5] });
        let anew = products(&after);
        for columns in [vec![0, 1, 2], vec![1], vec![0, 2]] {
            assert!((evidence.gain(&columns) - anew.gain(&columns)).abs() < SAME);
            let factors = DVector::from_element(columns.len(), 0.3);
            let [a, b] = [&evidence, &anew].map(|of| of.parameters(&columns, &factors));
            assert!((a - b).norm() < SAME);
        }
    }

    #[test]
    fn products_with_noise_are_as_uncertain_as_the_columns_products() {
        let mut random = fastrand::Rng::with_seed(3);
        let mut rows = DMatrix::from_fn(30, 6, |_, _| random.f64() - 0.5);
        let alike = rows.column(3) * (1.0 + ALIKE);
        rows.set_column(4, &alike);
        let evidence = products(&rows);
        let mut normal = || normal(&mut random);
        let noise = rows.transpose() * DMatrix::from_fn(30, MANY, |_, _| normal());
        let drawn = evidence.by_chance(&noise, &mut normal);
        let covariance = &drawn * drawn.transpose() / MANY as f64;
        assert!((covariance - &evidence.a).norm() < NEAR * evidence.a.norm());
        // Nothing is where columns alike differ.
        let apart = drawn.row(0) - drawn.row(1);
        assert!(apart.norm() < NEAR * ALIKE.sqrt() * drawn.row(0).norm());
    }
}

//! Least squares with numerical rank determination.

use nalgebra::{DMatrix, DVector};

/// A column depends on the columns before it if its orthogonal part is below this share.
const TOLERANCE: f64 = 1e-7;

/// The solution of stacked equations.
#[derive(Clone, Debug)]
pub struct Solution {
    /// All parameters; undetermined ones are 0.
    pub beta: DVector<f64>,
    /// The determined parameters, ascending.
    pub determined: Vec<usize>,
    /// For each other column, the determined columns that it combines, with factors; none for a
    /// column of zeros.
    pub dependent: Vec<(usize, Vec<(usize, f64)>)>,
    /// Triangular factor of the determined columns.
    pub factor: DMatrix<f64>,
}

impl Solution {
    /// (AᵀA)⁻¹ of the determined columns.
    #[must_use]
    pub fn inverse_normal(&self) -> DMatrix<f64> {
        let n = self.factor.ncols();
        let inverse = self
            .factor
            .solve_upper_triangular(&DMatrix::identity(n, n))
            .unwrap_or_else(|| DMatrix::zeros(n, n));
        &inverse * inverse.transpose()
    }

    /// Length of column `of` in the combination `parts`, over the length of the sum \[1\].
    #[must_use]
    pub fn share(&self, parts: &[(usize, f64)], of: usize) -> f64 {
        let mut whole = DVector::zeros(self.factor.nrows());
        let mut own = 0.0;
        for (column, factor) in parts {
            let Some(k) = self.determined.iter().position(|known| known == column) else {
                continue;
            };
            let part = self.factor.column(k) * *factor;
            if *column == of {
                own = part.norm();
            }
            whole += part;
        }
        own / whole.norm().max(f64::MIN_POSITIVE)
    }

    /// Condition numbers of the equations, raw and with columns of one length.
    #[must_use]
    pub fn condition(&self) -> Condition {
        Condition { raw: condition(&self.factor), scaled: condition(&self.scaled().0) }
    }

    /// The factor with columns of length 1, and their lengths.
    #[must_use]
    pub fn scaled(&self) -> (DMatrix<f64>, Vec<f64>) {
        let mut scaled = self.factor.clone();
        let lengths: Vec<f64> = scaled.column_iter().map(|column| column.norm()).collect();
        for (mut column, length) in scaled.column_iter_mut().zip(&lengths) {
            column /= *length;
        }
        (scaled, lengths)
    }
}

/// Condition numbers of the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// With columns of one length, independent of units.
    pub scaled: f64,
    /// In the units of the parameters.
    pub raw: f64,
}

fn condition(factor: &DMatrix<f64>) -> f64 {
    if factor.ncols() == 0 {
        return 1.0;
    }
    let values = factor.clone().svd(false, false).singular_values;
    values.max() / values.min()
}

/// Minimises |A x − b| with b the last column of `stacked`.
#[must_use]
pub(super) fn solve(stacked: &DMatrix<f64>) -> Solution {
    let unknowns = stacked.ncols() - 1;
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut determined = Vec::new();
    let mut others = Vec::new();
    for column in 0..unknowns {
        let values = stacked.column(column).into_owned();
        let length = values.norm();
        let mut rest = values;
        // Two passes give full orthogonality.
        for _ in 0..2 {
            for direction in &basis {
                let share = direction.dot(&rest);
                rest.axpy(-share, direction, 1.0);
            }
        }
        let left = rest.norm();
        if length > 0.0 && left > TOLERANCE * length {
            basis.push(rest / left);
            determined.push(column);
        } else {
            others.push((column, length));
        }
    }
    let mut kept = stacked.select_columns(&determined);
    let lengths: Vec<f64> = kept.column_iter().map(|column| column.norm()).collect();
    for (mut column, length) in kept.column_iter_mut().zip(&lengths) {
        column /= *length;
    }
    let qr = kept.qr();
    let mut factor = qr.r();
    let q = qr.q();
    let against = |values: DVector<f64>| {
        let right = q.tr_mul(&values);
        let mut x = factor.solve_upper_triangular(&right).unwrap_or_else(|| right * 0.0);
        for (x, length) in x.iter_mut().zip(&lengths) {
            *x /= length;
        }
        x
    };
    let x = against(stacked.column(unknowns).into_owned());
    let mut beta = DVector::zeros(unknowns);
    for (column, value) in determined.iter().zip(x.iter()) {
        beta[*column] = *value;
    }
    let dependent = others
        .into_iter()
        .map(|(column, length)| {
            if length == 0.0 {
                return (column, Vec::new());
            }
            let factors = against(stacked.column(column).into_owned());
            let parts = determined.iter().copied().zip(factors.iter().copied());
            let largest = factors.amax();
            (column, parts.filter(|(_, factor)| factor.abs() > 1e-6 * largest).collect())
        })
        .collect();
    for (mut column, length) in factor.column_iter_mut().zip(&lengths) {
        column *= *length;
    }
    Solution { beta, determined, dependent, factor }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dependent_and_zero_columns_are_found() {
        let value = |i: usize, k: usize| (0.7 * (i * 3 + k) as f64).sin() + 0.2 * k as f64;
        let stacked = DMatrix::from_fn(40, 6, |i, k| match k {
            2 => 2.0 * value(i, 0) - 3.0 * value(i, 1),
            3 => 0.0,
            5 => 4.0 * value(i, 0) + 5.0 * value(i, 1) + 6.0 * value(i, 4),
            k => value(i, k),
        });
        let solution = solve(&stacked);
        assert_eq!(solution.determined, [0, 1, 4]);
        let expected = [4.0, 5.0, 0.0, 0.0, 6.0];
        for (found, expected) in solution.beta.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9);
        }
        let [(2, parts), (3, none)] = solution.dependent.as_slice() else { panic!() };
        assert!(none.is_empty());
        assert!((parts[0].1 - 2.0).abs() < 1e-9 && (parts[1].1 + 3.0).abs() < 1e-9);
    }
}

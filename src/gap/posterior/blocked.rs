//! Cholesky factors in blocks, whose products are those of whole matrices: several times faster than
//! column by column (G. Golub, C. Van Loan, Matrix Computations, 4.2.9).

use nalgebra::{Cholesky, DMatrix};

/// Width of a block.
const WIDTH: usize = 24;

/// The lower factor of a symmetric positive definite matrix.
#[derive(Clone)]
pub(super) struct Factor {
    lower: DMatrix<f64>,
}

impl Factor {
    /// The factor of a matrix; `None` if it is not positive definite.
    pub(super) fn new(mut a: DMatrix<f64>) -> Option<Factor> {
        let n = a.nrows();
        for from in (0..n).step_by(WIDTH) {
            let width = WIDTH.min(n - from);
            let next = from + width;
            let own = a.view((from, from), (width, width)).into_owned();
            let own = Cholesky::new(own)?.l();
            a.view_mut((from, from), (width, width)).copy_from(&own);
            // Below: A Lᵀ⁻¹, and what it takes off the rest.
            let mut below = a.view((next, from), (n - next, width)).transpose();
            if !own.solve_lower_triangular_mut(&mut below) {
                return None;
            }
            a.view_mut((next, from), (n - next, width)).tr_copy_from(&below);
            let panel = below.transpose();
            a.view_mut((next, next), (n - next, n - next)).gemm(-1.0, &panel, &below, 1.0);
        }
        a.fill_upper_triangle(0.0, 1);
        Some(Factor { lower: a })
    }

    /// Half the logarithm of the determinant.
    pub(super) fn log_det(&self) -> f64 {
        self.lower.diagonal().iter().map(|x| x.ln()).sum()
    }

    /// The solution for some right sides.
    pub(super) fn solve(&self, right: &DMatrix<f64>) -> DMatrix<f64> {
        let (n, count) = right.shape();
        let mut x = right.clone();
        let blocks = || (0..n).step_by(WIDTH);
        let block = |from: usize| {
            let width = WIDTH.min(n - from);
            (width, self.lower.view((from, from), (width, width)))
        };
        for from in blocks() {
            let (width, own) = block(from);
            let mut part = x.rows(from, width).into_owned();
            own.solve_lower_triangular_unchecked_mut(&mut part);
            x.rows_mut(from, width).copy_from(&part);
            let next = from + width;
            let below = self.lower.view((next, from), (n - next, width));
            x.view_mut((next, 0), (n - next, count)).gemm(-1.0, &below, &part, 1.0);
        }
        for from in blocks().rev() {
            let (width, own) = block(from);
            let mut part = x.rows(from, width).into_owned();
            own.tr_solve_lower_triangular_unchecked_mut(&mut part);
            x.rows_mut(from, width).copy_from(&part);
            let left = self.lower.view((from, 0), (width, from)).transpose();
            x.view_mut((0, 0), (from, count)).gemm(-1.0, &left, &part, 1.0);
        }
        x
    }

    /// The inverse of the matrix.
    pub(super) fn inverse(&self) -> DMatrix<f64> {
        let n = self.lower.nrows();
        self.solve(&DMatrix::identity(n, n))
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

    use super::*;

    /// Largest difference to the factor of nalgebra, of entries near 1.
    const SAME: f64 = 1e-10;

    #[test]
    fn blocks_give_what_columns_give() {
        for n in [1, 23, 24, 61] {
            let b = DMatrix::from_fn(n, n, |i, k| ((3 * i + 7 * k * k + i * k) % 11) as f64 / 11.0);
            let a = b.transpose() * &b + DMatrix::identity(n, n);
            let right = DMatrix::from_fn(n, 3, |i, k| (i + k) as f64 / n as f64);
            let (own, other) = (Factor::new(a.clone()).unwrap(), Cholesky::new(a.clone()).unwrap());
            assert!((own.solve(&right) - other.solve(&right)).amax() < SAME);
            assert!((own.inverse() - other.inverse()).amax() < SAME);
            assert!((own.log_det() - 0.5 * other.ln_determinant()).abs() < SAME);
        }
        assert!(Factor::new(-DMatrix::<f64>::identity(30, 30)).is_none());
    }
}

//! Least squares from a stream of rows: A = Q R, and only R is stored.

use nalgebra::DMatrix;

/// Rows per column that are collected before a factorisation.
const ROWS_PER_COLUMN: usize = 3;

/// Triangular factor of all rows added so far; the last column is the right side.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    columns: usize,
    /// R in the upper rows, new rows below it.
    work: DMatrix<f64>,
    waiting: usize,
    rows: usize,
}

impl Triangle {
    /// An empty factor with `unknowns` columns and a right side.
    #[must_use]
    pub(super) fn new(unknowns: usize) -> Triangle {
        let columns = unknowns + 1;
        let work = DMatrix::zeros(columns * (1 + ROWS_PER_COLUMN), columns);
        Triangle { columns, work, waiting: 0, rows: 0 }
    }

    /// Number of rows added.
    #[must_use]
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Adds the row `x` with the right side `y`.
    pub(super) fn push(&mut self, x: &[f64], y: f64) {
        let row = self.columns + self.waiting;
        for (column, value) in x.iter().enumerate() {
            self.work[(row, column)] = *value;
        }
        self.work[(row, self.columns - 1)] = y;
        self.waiting += 1;
        self.rows += 1;
        if self.columns + self.waiting == self.work.nrows() {
            self.reduce();
        }
    }

    /// The factor: `unknowns + 1` rows and columns, upper triangular.
    #[must_use]
    pub(super) fn factor(&mut self) -> DMatrix<f64> {
        self.reduce();
        self.work.rows(0, self.columns).into_owned()
    }

    /// Householder reflections; each acts on the diagonal row and the new ones.
    fn reduce(&mut self) {
        let n = self.columns;
        let below = n..n + self.waiting;
        if below.is_empty() {
            return;
        }
        let mut mirror = vec![0.0; self.waiting];
        for k in 0..n {
            let column = self.work.column(k);
            mirror.copy_from_slice(&column.as_slice()[below.clone()]);
            let lower: f64 = mirror.iter().map(|x| x * x).sum();
            if lower == 0.0 {
                continue;
            }
            let head = self.work[(k, k)];
            let norm = (head * head + lower).sqrt();
            let first = head + norm.copysign(head);
            let scale = 2.0 / (first * first + lower);
            for c in k..n {
                let mut column = self.work.column_mut(c);
                let values = column.as_mut_slice();
                let product: f64 =
                    values[below.clone()].iter().zip(&mirror).map(|(a, b)| a * b).sum();
                let share = scale * (first * values[k] + product);
                values[k] -= share * first;
                for (value, m) in values[below.clone()].iter_mut().zip(&mirror) {
                    *value -= share * m;
                }
            }
        }
        self.waiting = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_has_the_products_of_the_rows() {
        let mut triangle = Triangle::new(4);
        let value = |i: usize| (1.3 * i as f64).sin() + 0.1 * (i as f64 % 7.0);
        let rows = DMatrix::from_fn(103, 5, |i, k| value(5 * i + k));
        for row in rows.row_iter() {
            let row: Vec<f64> = row.iter().copied().collect();
            triangle.push(&row[..4], row[4]);
        }
        let r = triangle.factor();
        assert!((r.transpose() * &r - rows.transpose() * &rows).amax() < 1e-11);
        assert!(r.lower_triangle().amax() <= r.upper_triangle().amax());
        assert_eq!(triangle.rows(), 103);
    }
}

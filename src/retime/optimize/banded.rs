//! Symmetric positive definite band matrices and their Cholesky factors.

/// The lower triangle of a symmetric matrix with entries no farther than `width` off the diagonal.
#[derive(Clone, Debug)]
pub(super) struct Banded {
    size: usize,
    width: usize,
    /// Row i holds the columns i − `width` … i.
    entries: Vec<f64>,
}

impl Banded {
    pub(super) fn zeros(size: usize, width: usize) -> Banded {
        Banded { size, width, entries: vec![0.0; size * (width + 1)] }
    }

    #[inline]
    fn index(&self, i: usize, j: usize) -> usize {
        i * (self.width + 1) + self.width + j - i
    }

    /// Adds to the entry at (i, j) and its mirror; |i − j| ≤ width.
    #[inline]
    pub(super) fn add(&mut self, i: usize, j: usize, value: f64) {
        let index = self.index(i.max(j), i.min(j));
        self.entries[index] += value;
    }

    /// The entries of the lower triangle that are not zero, as (i, j, value).
    pub(super) fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        (0..self.size)
            .flat_map(move |i| (i.saturating_sub(self.width)..=i).map(move |j| (i, j)))
            .map(|(i, j)| (i, j, self.entries[self.index(i, j)]))
            .filter(|(_, _, value)| *value != 0.0)
    }

    /// A · x.
    pub(super) fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.size];
        for i in 0..self.size {
            for j in i.saturating_sub(self.width)..=i {
                let value = self.entries[self.index(i, j)];
                out[i] += value * x[j];
                if j < i {
                    out[j] += value * x[i];
                }
            }
        }
        out
    }

    /// The columns `from` … `to` of row i, from i − `width` to i.
    fn row(&self, i: usize, from: usize, to: usize) -> &[f64] {
        &self.entries[self.index(i, from)..self.index(i, to)]
    }

    /// L with A = L Lᵀ. None if A is not positive definite.
    pub(super) fn factor(mut self) -> Option<Cholesky> {
        for i in 0..self.size {
            let first = i.saturating_sub(self.width);
            for j in first..=i {
                let product = self.row(i, first, j).iter().zip(self.row(j, first, j));
                let sum = self.entries[self.index(i, j)] - product.map(|(a, b)| a * b).sum::<f64>();
                let at = self.index(i, j);
                self.entries[at] = if i > j {
                    sum / self.entries[self.index(j, j)]
                } else if sum > 0.0 {
                    sum.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(Cholesky { lower: self })
    }
}

/// The Cholesky factor of a band matrix.
pub(super) struct Cholesky {
    lower: Banded,
}

impl Cholesky {
    /// x with L Lᵀ x = right.
    pub(super) fn solve(&self, mut right: Vec<f64>) -> Vec<f64> {
        let Banded { size, width, .. } = self.lower;
        for i in 0..size {
            let first = i.saturating_sub(width);
            let row = self.lower.row(i, first, i + 1);
            let known: f64 = row.iter().zip(&right[first..i]).map(|(a, x)| a * x).sum();
            right[i] = (right[i] - known) / row[i - first];
        }
        for i in (0..size).rev() {
            let first = i.saturating_sub(width);
            let row = self.lower.row(i, first, i + 1);
            right[i] /= row[i - first];
            let x = right[i];
            for (right, a) in right[first..i].iter_mut().zip(row) {
                *right -= a * x;
            }
        }
        right
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::*;

    #[test]
    fn solves_what_it_was_made_from() {
        const SIZE: usize = 23;
        const WIDTH: usize = 4;
        let mut matrix = Banded::zeros(SIZE, WIDTH);
        let mut dense = vec![vec![0.0; SIZE]; SIZE];
        for i in 0..SIZE {
            for j in i.saturating_sub(WIDTH)..=i {
                let value = if i == j { 9.0 } else { ((i * 7 + j * 3) % 5) as f64 - 2.0 };
                matrix.add(i, j, value);
                dense[i][j] = value;
                dense[j][i] = value;
            }
        }
        let x: Vec<f64> = (0..SIZE).map(|i| (i as f64).sin()).collect();
        let right: Vec<f64> =
            dense.iter().map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum()).collect();
        for (got, wanted) in matrix.times(&x).iter().zip(&right) {
            assert!((got - wanted).abs() < 1e-12);
        }
        for (got, wanted) in matrix.factor().unwrap().solve(right).iter().zip(&x) {
            assert!((got - wanted).abs() < 1e-12);
        }
    }

    #[test]
    fn refuses_what_is_not_definite() {
        let mut matrix = Banded::zeros(2, 1);
        matrix.add(0, 0, 1.0);
        matrix.add(1, 0, 2.0);
        matrix.add(1, 1, 1.0);
        assert!(matrix.factor().is_none());
    }
}

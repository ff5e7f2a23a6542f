//! Symmetric matrices of which one half is kept.

use nalgebra::DMatrix;

/// Products of columns: column by column, down to the diagonal.
#[derive(Clone, Debug)]
pub(in crate::gap) struct Packed {
    size: usize,
    values: Vec<f64>,
}

impl Packed {
    /// Zeros.
    #[must_use]
    pub(in crate::gap) fn zeros(size: usize) -> Packed {
        Packed { size, values: vec![0.0; size * (size + 1) / 2] }
    }

    /// The upper half of a matrix.
    #[must_use]
    pub(in crate::gap) fn of(matrix: &DMatrix<f64>) -> Packed {
        let size = matrix.ncols();
        let column = |k: usize| matrix.view((0, k), (k + 1, 1)).iter().copied().collect::<Vec<_>>();
        Packed { size, values: (0..size).flat_map(column).collect() }
    }

    /// Adds another one, `weight` times.
    pub(in crate::gap) fn add(&mut self, weight: f64, other: &Packed) {
        for (to, x) in self.values.iter_mut().zip(&other.values) {
            *to += weight * x;
        }
    }

    /// The whole matrix.
    #[must_use]
    pub(in crate::gap) fn whole(&self) -> DMatrix<f64> {
        let mut whole = DMatrix::zeros(self.size, self.size);
        let mut from = 0;
        for k in 0..self.size {
            let column = &self.values[from..=from + k];
            whole.view_mut((0, k), (k + 1, 1)).copy_from_slice(column);
            from += k + 1;
        }
        whole.fill_lower_triangle_with_upper_triangle();
        whole
    }

    /// The sum of the products with another one's elements, each with its mirror image; `doubled` has
    /// what is off the diagonal twice.
    #[must_use]
    pub(in crate::gap) fn dot(&self, doubled: &Packed) -> f64 {
        // Several sums at once are faster.
        const LANES: usize = 8;
        let mut sums = [0.0; LANES];
        let (a, b) = (self.values.chunks_exact(LANES), doubled.values.chunks_exact(LANES));
        let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
        for (a, b) in a.zip(b) {
            for k in 0..LANES {
                sums[k] += a[k] * b[k];
            }
        }
        sums.iter().sum::<f64>() + rest
    }

    /// With what is off the diagonal twice.
    #[must_use]
    pub(in crate::gap) fn doubled(matrix: &DMatrix<f64>) -> Packed {
        let mut packed = Packed::of(&(matrix * 2.0));
        let mut at = 0;
        for k in 0..packed.size {
            at += k;
            packed.values[at] *= 0.5;
            at += 1;
        }
        packed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_whole_matrices() {
        let a = DMatrix::from_fn(5, 5, |i, k| ((i + 2) * (k + 2)) as f64 + (i + k) as f64);
        let b = DMatrix::from_fn(5, 5, |i, k| (i * k) as f64 - 3.0);
        assert_eq!(Packed::of(&a).whole(), a);
        assert!((Packed::of(&a).dot(&Packed::doubled(&b)) - a.dot(&b)).abs() < 1e-9);
    }
}

//! What windows would add to a fit: sums of the products of their parts.

use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView};

use super::amplitude::best;

/// Gains of what acts in some parts of a motion.
pub(in crate::gap) struct WindowGains<'a> {
    /// Products of the columns of all parts, those of a part one after another.
    products: (DMatrix<f64>, DVector<f64>),
    prior: &'a [(f64, f64)],
    spread: f64,
}

impl<'a> WindowGains<'a> {
    /// From the products `A`, `b` of the columns of all parts; a part has the columns of `prior`.
    pub(super) fn new(
        products: (DMatrix<f64>, DVector<f64>),
        prior: &'a [(f64, f64)],
        spread: f64,
    ) -> WindowGains<'a> {
        WindowGains { products, prior, spread }
    }

    /// Gains of what acts from the part `from` on: in one part, in two, … in `count`. The parts come
    /// again \[nats\].
    #[must_use]
    pub(in crate::gap) fn at_once(&self, from: usize, count: usize) -> Vec<f64> {
        let mut gains = Vec::with_capacity(count);
        let (mut a, mut b) = self.none();
        for last in from..from + count {
            for part in from..last {
                a += self.block(part, last);
                a += self.block(last, part);
            }
            a += self.block(last, last);
            b += self.right(last);
            let sums = (a, b);
            gains.push(best(&sums, self.prior, self.spread));
            (a, b) = sums;
        }
        gains
    }

    /// Gain of what acts with these shares in the parts from `from` on \[nats\].
    #[must_use]
    pub(in crate::gap) fn of(&self, from: usize, shares: &[f64]) -> f64 {
        let (mut a, mut b) = self.none();
        for (i, x) in shares.iter().enumerate() {
            b += *x * self.right(from + i);
            for (k, y) in shares.iter().enumerate() {
                a += x * y * self.block(from + i, from + k);
            }
        }
        best(&(a, b), self.prior, self.spread)
    }

    fn block(&self, i: usize, k: usize) -> DMatrixView<'_, f64> {
        let width = self.prior.len();
        self.products.0.view((width * self.wrapped(i), width * self.wrapped(k)), (width, width))
    }

    fn right(&self, part: usize) -> DVectorView<'_, f64> {
        let width = self.prior.len();
        self.products.1.rows(width * self.wrapped(part), width)
    }

    fn wrapped(&self, part: usize) -> usize {
        part % (self.products.1.len() / self.prior.len())
    }

    fn none(&self) -> (DMatrix<f64>, DVector<f64>) {
        let width = self.prior.len();
        (DMatrix::zeros(width, width), DVector::zeros(width))
    }
}

//! What single pieces would add to a fit, at its sizes.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::amplitude::best;
use super::fit::Fit;
use super::reduced::variance;
use super::windows::WindowGains;
use crate::gap::design::{Design, PieceRows};

/// A fit that answers what pieces would add.
pub(in crate::gap) struct Gains<'a> {
    design: &'a Design,
    fit: &'a Fit,
    /// By joint.
    weighted: Vec<Weighted>,
}

struct Weighted {
    /// Weights of the rows that are used: the first ones.
    weights: DVector<f64>,
    /// What is left of the difference.
    left: DVector<f64>,
}

impl<'a> Gains<'a> {
    /// Prepares the rows of a fit.
    #[must_use]
    pub(in crate::gap) fn new(design: &'a Design, fit: &'a Fit) -> Gains<'a> {
        let parameters = design.parameters.count();
        let weighted = (0..design.joints.len())
            .into_par_iter()
            .map(|joint| {
                let (of, extra) = (&design.joints[joint], &fit.extra[joint]);
                let mut weights = DVector::zeros(of.y.len());
                for (cell, laws) in of.cells.iter().zip(&extra.laws) {
                    let weight = variance(cell, &fit.sizes[joint], *laws).recip();
                    weights.rows_mut(cell.rows.start, cell.rows.len()).fill(weight);
                }
                let reduced = &fit.reduced[joint];
                let mut u = reduced.solved.column(0)
                    - reduced.solved.columns(1, fit.mean.len()) * &fit.mean;
                u.component_mul_assign(&DVector::from_column_slice(&reduced.sizes));
                let (h, everyday) = (extra.effects, of.groups.len());
                let mut left = of.y.clone();
                left -= of.base.columns(0, parameters) * fit.mean.rows(0, parameters);
                left -= of.base.columns(parameters, everyday) * u.rows(0, everyday);
                if !extra.transposed.is_empty() {
                    let f = extra.forms.len();
                    let mut all = DVector::zeros(h + f);
                    all.rows_mut(0, h).copy_from(&fit.mean.rows(parameters, h));
                    all.rows_mut(h, f).copy_from(&u.rows(everyday, f));
                    left -= extra.transposed.tr_mul(&all);
                }
                Weighted { weights, left }
            })
            .collect();
        Gains { design, fit, weighted }
    }

    /// Weights of a joint's rows, and what is left of the difference.
    #[must_use]
    pub(in crate::gap) fn left(&self, joint: usize) -> (&DVector<f64>, &DVector<f64>) {
        let of = &self.weighted[joint];
        (&of.weights, &of.left)
    }

    /// Products of pieces' columns with everything else marginalised: `A`, `b` of each; rows below
    /// a frequency \[Hz\].
    fn products(&self, pieces: &[&PieceRows], below: f64) -> Vec<(DMatrix<f64>, DVector<f64>)> {
        let m = self.fit.mean.len();
        let parameters = self.design.parameters.count();
        let mut all: Vec<(DMatrix<f64>, DVector<f64>, DMatrix<f64>)> = pieces
            .iter()
            .map(|piece| {
                let count = piece.prior.len();
                (DMatrix::zeros(count, count), DVector::zeros(count), DMatrix::zeros(m, count))
            })
            .collect();
        for (joint, Weighted { weights, left }) in self.weighted.iter().enumerate() {
            let (of, extra) = (&self.design.joints[joint], &self.fit.extra[joint]);
            let rows = of.rows_below(below);
            let reached: Vec<(usize, &DMatrix<f64>)> = pieces
                .iter()
                .enumerate()
                .filter_map(|(number, piece)| {
                    let found = piece.rows.iter().find(|(of, _)| *of == joint);
                    found.map(|(_, rows)| (number, rows))
                })
                .collect();
            let count: usize = reached.iter().map(|(_, rows)| rows.ncols()).sum();
            if count == 0 || rows == 0 {
                continue;
            }
            // Products of narrow matrices are slow: empty columns make it a wide one.
            let width = count.max(WIDE);
            let mut columns = DMatrix::zeros(rows, width);
            let from = reached.iter().flat_map(|(_, rows)| rows.column_iter());
            for (mut to, from) in columns.column_iter_mut().zip(from) {
                to.copy_from(&from.rows(0, rows));
                to.component_mul_assign(&weights.rows(0, rows));
            }
            let reduced = &self.fit.reduced[joint];
            let with_base = of.transposed.columns(0, rows) * &columns;
            let (h, everyday, f) = (extra.effects, of.groups.len(), extra.forms.len());
            let mut with_local = DMatrix::zeros(everyday + f, width);
            with_local.rows_mut(0, everyday).copy_from(&with_base.rows(parameters, everyday));
            let mut with_global = DMatrix::zeros(m, width);
            with_global.rows_mut(0, parameters).copy_from(&with_base.rows(0, parameters));
            if h + f > 0 {
                let with_extra = extra.transposed.columns(0, rows) * &columns;
                with_local.rows_mut(everyday, f).copy_from(&with_extra.rows(h, f));
                with_global.rows_mut(parameters, h).copy_from(&with_extra.rows(0, h));
            }
            for (mut row, size) in with_local.row_iter_mut().zip(&reduced.sizes) {
                row *= *size;
            }
            let solved = reduced.factor.solve(&with_local);
            with_global -= reduced.solved.columns(1, m).transpose() * &with_local;
            let mut from = 0;
            for (number, rows_of) in reached {
                let count = rows_of.ncols();
                let (a, b, g) = &mut all[number];
                let own = columns.columns(from, count);
                *a += own.tr_mul(&rows_of.rows(0, rows));
                *a -= with_local.columns(from, count).tr_mul(&solved.columns(from, count));
                *b += own.tr_mul(&left.rows(0, rows));
                *g += with_global.columns(from, count);
                from += count;
            }
        }
        all.into_iter().map(|(a, b, g)| (a - g.tr_mul(&(&self.fit.covariance * &g)), b)).collect()
    }

    /// Logarithm of how much more probable the logs are with a piece, over the amplitudes
    /// that are tried.
    #[must_use]
    pub(in crate::gap) fn of(&self, piece: &PieceRows, below: f64) -> f64 {
        let products = self.products(&[piece], below);
        let spread = self.design.tunables.amplitude_spread;
        products.first().map_or(f64::NEG_INFINITY, |of| best(of, &piece.prior, spread))
    }

    /// Squares of what is added by the first column of pieces, in deviations, everything of the fit
    /// marginalised.
    #[must_use]
    pub(in crate::gap) fn squares(&self, pieces: &[PieceRows]) -> Vec<f64> {
        let all: Vec<&PieceRows> = pieces.iter().collect();
        self.products(&all, f64::INFINITY).iter().map(|(a, _)| a[(0, 0)]).collect()
    }

    /// The most probable factor of a piece's first column, and its standard deviation; `None` where nothing
    /// is known of it.
    #[must_use]
    pub(in crate::gap) fn factor(&self, piece: &PieceRows) -> Option<[f64; 2]> {
        let (a, b) = self.products(&[piece], f64::INFINITY).remove(0);
        (a[(0, 0)] > 0.0).then(|| [b[0] / a[(0, 0)], a[(0, 0)].sqrt().recip()])
    }

    /// Gains of windows of a piece whose columns are those of `count` parts, one after another; rows below
    /// a frequency \[Hz\].
    #[must_use]
    pub(in crate::gap) fn of_windows<'b>(
        &self,
        piece: &'b PieceRows,
        count: usize,
        below: f64,
    ) -> WindowGains<'b> {
        let prior = &piece.prior[..piece.prior.len() / count];
        let products = self.products(&[piece], below).remove(0);
        WindowGains::new(products, prior, self.design.tunables.amplitude_spread)
    }

    /// Gains of all pieces. What a shape does by itself counts as far as it helps: the right shape may be
    /// between the tried ones.
    #[must_use]
    pub(in crate::gap) fn of_all(&self, pieces: &[PieceRows], below: f64) -> Vec<f64> {
        let spread = self.design.tunables.amplitude_spread;
        let gains = |pieces: &[PieceRows]| -> Vec<f64> {
            let of: Vec<&PieceRows> = pieces.iter().collect();
            let all = self.products(&of, below);
            all.iter().zip(pieces).map(|(of, piece)| most(of, piece, spread)).collect()
        };
        pieces.par_chunks(TOGETHER).flat_map_iter(gains).collect()
    }
}

/// Columns from which on nalgebra multiplies in blocks.
const WIDE: usize = 6;
/// Pieces whose products are computed together.
const TOGETHER: usize = 64;

/// The gain of a piece, of as much of it as helps where it acts by itself.
fn most(products: &(DMatrix<f64>, DVector<f64>), piece: &PieceRows, spread: f64) -> f64 {
    let (a, b) = products;
    match piece.is_fixed() {
        true if b[0] > 0.0 => 0.5 * b[0] * b[0] / a[(0, 0)].max(f64::MIN_POSITIVE),
        true => f64::NEG_INFINITY,
        false => best(products, &piece.prior, spread),
    }
}

//! What single pieces would add to a fit, at its sizes.

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use super::fit::Fit;
use super::reduced::variance;
use crate::gap::design::{Design, PieceRows};

/// A fit that answers what pieces would add.
pub struct Gains<'a> {
    amplitude_spread: f64,
    fit: &'a Fit,
    /// By joint: the columns y, P, H, L, F of all rows, each row times the root of its weight.
    weighted: Vec<Weighted>,
}

struct Weighted {
    /// Rows that are used.
    rows: Vec<usize>,
    /// Roots of the weights of the rows.
    roots: DVector<f64>,
    /// Global columns P, H, transposed.
    global: DMatrix<f64>,
    /// Local columns, times their sizes, transposed.
    local: DMatrix<f64>,
    /// What is left of the difference.
    left: DVector<f64>,
}

impl<'a> Gains<'a> {
    /// Prepares the rows of a fit.
    #[must_use]
    pub fn new(design: &'a Design, fit: &'a Fit) -> Gains<'a> {
        Gains::up_to(design, fit, usize::MAX)
    }

    /// The same with frequencies below a bin alone.
    #[must_use]
    pub fn up_to(design: &'a Design, fit: &'a Fit, limit: usize) -> Gains<'a> {
        let parameters = design.parameters.count();
        let weighted = (0..design.joints.len())
            .into_par_iter()
            .map(|joint| {
                let (of, extra) = (&design.joints[joint], &fit.extra[joint]);
                let (mut rows, mut roots) = (Vec::new(), Vec::new());
                for cell in of.cells.iter().filter(|cell| cell.first_bin < limit) {
                    let root = variance(cell, &fit.sizes[joint]).sqrt().recip();
                    rows.extend(cell.rows.clone());
                    roots.resize(rows.len(), root);
                }
                let roots = DVector::from_vec(roots);
                let (h, everyday, f) = (extra.effects, of.groups.len(), extra.forms.len());
                let reduced = &fit.reduced[joint];
                let weighted = |from: nalgebra::DVectorView<'_, f64>, size: f64| {
                    DVector::from_iterator(
                        rows.len(),
                        rows.iter().zip(roots.iter()).map(|(row, root)| size * root * from[*row]),
                    )
                };
                let global: Vec<DVector<f64>> = (0..parameters)
                    .map(|k| weighted(of.base.column(k), 1.0))
                    .chain((0..h).map(|k| weighted(extra.columns.column(k), 1.0)))
                    .collect();
                let local: Vec<DVector<f64>> = (0..everyday)
                    .map(|k| weighted(of.base.column(parameters + k), reduced.sizes[k]))
                    .chain((0..f).map(|k| {
                        weighted(extra.columns.column(h + k), reduced.sizes[everyday + k])
                    }))
                    .collect();
                let global = DMatrix::from_columns(&global);
                let local = DMatrix::from_columns(&local);
                let solved_theta = reduced.solved.columns(1, fit.mean.len());
                let u = reduced.solved.column(0) - solved_theta * &fit.mean;
                let mut left = weighted(of.y.column(0), 1.0);
                left -= &global * &fit.mean;
                left -= &local * u;
                let (global, local) = (global.transpose(), local.transpose());
                Weighted { rows, roots, global, local, left }
            })
            .collect();
        Gains { amplitude_spread: design.tunables.amplitude_spread, fit, weighted }
    }

    /// Products of pieces' columns with everything else marginalised: `A`, `b` of each.
    fn products(&self, pieces: &[&PieceRows]) -> Vec<(DMatrix<f64>, DVector<f64>)> {
        let m = self.fit.mean.len();
        let mut all: Vec<(DMatrix<f64>, DVector<f64>, DMatrix<f64>)> = pieces
            .iter()
            .map(|piece| {
                let count = piece.prior.len();
                (DMatrix::zeros(count, count), DVector::zeros(count), DMatrix::zeros(m, count))
            })
            .collect();
        for (joint, weighted) in self.weighted.iter().enumerate() {
            let Weighted { rows: used, roots, global, local, left } = weighted;
            let reached: Vec<(usize, &DMatrix<f64>)> = pieces
                .iter()
                .enumerate()
                .filter_map(|(number, piece)| {
                    let found = piece.rows.iter().find(|(of, _)| *of == joint);
                    found.map(|(_, rows)| (number, rows))
                })
                .collect();
            let count: usize = reached.iter().map(|(_, rows)| rows.ncols()).sum();
            if count == 0 {
                continue;
            }
            let mut columns = DMatrix::zeros(used.len(), count);
            let from = reached.iter().flat_map(|(_, rows)| rows.column_iter());
            for (mut to, from) in columns.column_iter_mut().zip(from) {
                for ((to, row), root) in to.iter_mut().zip(used).zip(roots.iter()) {
                    *to = root * from[*row];
                }
            }
            let reduced = &self.fit.reduced[joint];
            let with_local = local * &columns;
            let solved = reduced.factor.solve(&with_local);
            let mut with_global = global * &columns;
            with_global -= reduced.solved.columns(1, m).transpose() * &with_local;
            let with_left = columns.tr_mul(left);
            let mut from = 0;
            for (number, rows) in reached {
                let count = rows.ncols();
                let (a, b, g) = &mut all[number];
                let own = columns.columns(from, count);
                *a += own.tr_mul(&own);
                *a -= with_local.columns(from, count).tr_mul(&solved.columns(from, count));
                *b += with_left.rows(from, count);
                *g += with_global.columns(from, count);
                from += count;
            }
        }
        all.into_iter()
            .map(|(a, b, g)| (a - g.tr_mul(&(&self.fit.covariance * &g)), b))
            .collect()
    }

    /// Logarithm of how much more probable the logs are with a piece, over the amplitudes
    /// that are tried.
    #[must_use]
    pub fn of(&self, piece: &PieceRows) -> f64 {
        let products = self.products(&[piece]);
        products.first().map_or(f64::NEG_INFINITY, |of| best(of, piece, self.amplitude_spread))
    }

    /// Gains of all pieces, and what the columns gain by themselves that each brings along.
    #[must_use]
    pub fn of_all(&self, pieces: &[PieceRows]) -> Vec<[f64; 2]> {
        let gains = |pieces: &[PieceRows]| -> Vec<[f64; 2]> {
            let of: Vec<&PieceRows> = pieces.iter().collect();
            let both = |(of, piece)| [best(of, piece, self.amplitude_spread), brought(of, piece)];
            self.products(&of).iter().zip(pieces).map(both).collect()
        };
        pieces.par_chunks(TOGETHER).flat_map_iter(gains).collect()
    }
}

/// Pieces whose products are computed together.
const TOGETHER: usize = 64;

/// What the columns gain that a piece brings along: it is none of its own.
fn brought((a, b): &(DMatrix<f64>, DVector<f64>), piece: &PieceRows) -> f64 {
    let count = piece.prior.len() - piece.own;
    if count == 0 {
        return 0.0;
    }
    let a = a.view((piece.own, piece.own), (count, count)).into_owned();
    let b = b.rows(piece.own, count).into_owned();
    gain(&a, &b, &piece.prior[piece.own..], 1.0).max(0.0)
}

/// The gain of a piece over the amplitudes that are tried.
fn best((a, b): &(DMatrix<f64>, DVector<f64>), piece: &PieceRows, spread: f64) -> f64 {
    let is_fixed = piece.prior.iter().any(|(mean, _)| *mean != 0.0);
    let tried: &[f64] = if is_fixed { &[1.0] } else { &TRIED };
    let gain =
        |amplitude: &f64| gain(a, b, &piece.prior, *amplitude) - 0.5 * (amplitude.ln() / spread).powi(2);
    tried.iter().map(gain).fold(f64::NEG_INFINITY, f64::max)
}

/// Amplitudes that are tried, over the usual one.
const TRIED: [f64; 4] = [0.3, 1.0, 3.0, 10.0];

/// The gain of columns with some prior.
fn gain(a: &DMatrix<f64>, b: &DVector<f64>, prior: &[(f64, f64)], amplitude: f64) -> f64 {
    let n = prior.len();
    let mean = DVector::from_fn(n, |k, _| prior[k].0);
    let moved = a * &mean;
    let fixed = mean.dot(b) - 0.5 * mean.dot(&moved);
    let left = b - moved;
    let free: Vec<usize> = (0..n).filter(|k| prior[*k].1 > 0.0).collect();
    let sd = |k: usize| amplitude * prior[free[k]].1;
    let scaled = DMatrix::from_fn(free.len(), free.len(), |i, k| {
        sd(i) * sd(k) * a[(free[i], free[k])] + if i == k { 1.0 } else { 0.0 }
    });
    let right = DVector::from_fn(free.len(), |k, _| sd(k) * left[free[k]]);
    let Some(factor) = Cholesky::new(scaled) else { return f64::NEG_INFINITY };
    let log_det: f64 = factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum();
    fixed + 0.5 * right.dot(&factor.solve(&right)) - log_det
}

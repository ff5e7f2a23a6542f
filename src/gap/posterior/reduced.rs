//! A joint with its everyday errors marginalised.

use nalgebra::DMatrix;

use super::blocked::Factor;
use super::hypothesis::Extra;
use super::sizes::{JointSizes, LAWS, NOISE, WRITTEN};
use crate::gap::design::{Cell, Group, JointDesign, Packed, Set};

/// Weighted products of a joint whose everyday errors are marginalised.
///
/// Columns that are common to the joints ("global") are the difference y, the parameters P and the
/// effects H, in this order.
#[derive(Clone)]
pub(super) struct Reduced {
    /// Products of the global columns.
    pub(super) global: DMatrix<f64>,
    /// Logarithm of the determinant of `I + S Lᵀ W L S`, half of it.
    pub(super) log_det: f64,
    /// Sum of the logarithms of the weights' roots.
    pub(super) log_weights: f64,
    /// Factor of `I + S Lᵀ W L S`.
    pub(super) factor: Factor,
    /// `(I + S Lᵀ W L S)⁻¹ S Lᵀ W [y, P, H]`.
    pub(super) solved: DMatrix<f64>,
    /// S.
    pub(super) sizes: Vec<f64>,
}

/// The variance of a row of a cell.
pub(super) fn variance(cell: &Cell, sizes: &JointSizes, laws: f64) -> f64 {
    let error = match cell.set {
        Set::Now => sizes.error[cell.range].value,
        Set::Baseline => sizes.error[3 + cell.range].value,
        Set::Drift => 0.0,
    };
    let share = |k: usize| sizes.error[k].value.powi(2);
    let written = if cell.set == Set::Now { share(WRITTEN) * cell.all } else { 0.0 };
    let known = cell.noise + error * error * cell.power + written;
    known + share(NOISE) * cell.white + share(LAWS) * laws
}

/// Sizes of the local columns: of everyday errors, then of forms.
fn local_sizes(design: &JointDesign, extra: &Extra, sizes: &JointSizes) -> Vec<f64> {
    let everyday = design.groups.iter().map(|group| sizes.of(*group));
    everyday.chain(extra.forms.iter().map(|of| sizes.of(Group::Form(*of)))).collect()
}

/// Weighted sum over the cells of products, all columns in the order y, P, L, H, F.
pub(super) struct Products {
    /// `[y, base]ᵀ W [y, base]`.
    pub(super) base: DMatrix<f64>,
    /// `[y, base]ᵀ W E`.
    pub(super) with: DMatrix<f64>,
    /// `Eᵀ W E`.
    pub(super) own: DMatrix<f64>,
}

impl Products {
    fn new(design: &JointDesign, extra: &Extra, sizes: &JointSizes) -> (Products, f64) {
        let count = 1 + design.base.ncols();
        let more = extra.transposed.nrows();
        let mut base = Packed::zeros(count);
        let mut sum = Products {
            base: DMatrix::zeros(0, 0),
            with: DMatrix::zeros(count, more),
            own: DMatrix::zeros(more, more),
        };
        let mut log_weights = 0.0;
        for (k, cell) in design.cells.iter().enumerate() {
            let variance = variance(cell, sizes, extra.laws[k]);
            let weight = 1.0 / variance;
            log_weights -= 0.5 * cell.rows.len() as f64 * variance.ln();
            base.add(weight, &design.grams[k]);
            if let Some((with, own)) = extra.products(k) {
                sum.with.zip_apply(with, |to, x| *to += weight * x);
                sum.own.zip_apply(own, |to, x| *to += weight * x);
            }
        }
        sum.base = base.whole();
        (sum, log_weights)
    }
}

impl Reduced {
    /// The same beside `effects` columns of effects that do not reach the joint; `first` is the number of
    /// the difference and the parameters.
    pub(super) fn beside(&self, first: usize, effects: usize) -> Reduced {
        let mut global = DMatrix::zeros(first + effects, first + effects);
        let own = self.global.view((0, 0), (first, first));
        global.view_mut((0, 0), (first, first)).copy_from(&own);
        let mut solved = DMatrix::zeros(self.solved.nrows(), first + effects);
        solved.columns_mut(0, first).copy_from(&self.solved.columns(0, first));
        Reduced { global, solved, sizes: self.sizes.clone(), factor: self.factor.clone(), ..*self }
    }

    /// Marginalises the everyday errors of a joint; `None` if the products are no numbers.
    pub(super) fn new(
        design: &JointDesign,
        parameters: usize,
        extra: &Extra,
        sizes: &JointSizes,
    ) -> Option<Reduced> {
        let (sum, log_weights) = Products::new(design, extra, sizes);
        let first = 1 + parameters;
        let everyday = design.groups.len();
        let (h, f) = (extra.effects, extra.forms.len());
        let local = everyday + f;
        let scale = local_sizes(design, extra, sizes);
        // Places among [y, base | E] of the local columns and of the global ones.
        let mut inner = DMatrix::zeros(local, local);
        inner
            .view_mut((0, 0), (everyday, everyday))
            .copy_from(&sum.base.view((first, first), (everyday, everyday)));
        if f > 0 {
            let across = sum.with.view((first, h), (everyday, f));
            inner.view_mut((0, everyday), (everyday, f)).copy_from(&across);
            inner.view_mut((everyday, 0), (f, everyday)).tr_copy_from(&across);
            inner.view_mut((everyday, everyday), (f, f)).copy_from(&sum.own.view((h, h), (f, f)));
        }
        for (k, of) in scale.iter().enumerate() {
            inner.row_mut(k).scale_mut(*of);
        }
        for (k, of) in scale.iter().enumerate() {
            inner.column_mut(k).scale_mut(*of);
            inner[(k, k)] += 1.0;
        }
        let global = first + h;
        let mut across = DMatrix::zeros(local, global);
        across
            .view_mut((0, 0), (everyday, first))
            .copy_from(&sum.base.view((first, 0), (everyday, first)));
        across
            .view_mut((0, first), (everyday, h))
            .copy_from(&sum.with.view((first, 0), (everyday, h)));
        if f > 0 {
            across
                .view_mut((everyday, 0), (f, first))
                .tr_copy_from(&sum.with.view((0, h), (first, f)));
            across.view_mut((everyday, first), (f, h)).tr_copy_from(&sum.own.view((0, h), (h, f)));
        }
        for (k, of) in scale.iter().enumerate() {
            across.row_mut(k).scale_mut(*of);
        }
        let mut all = DMatrix::zeros(global, global);
        all.view_mut((0, 0), (first, first)).copy_from(&sum.base.view((0, 0), (first, first)));
        all.view_mut((0, first), (first, h)).copy_from(&sum.with.view((0, 0), (first, h)));
        all.view_mut((first, 0), (h, first)).tr_copy_from(&sum.with.view((0, 0), (first, h)));
        all.view_mut((first, first), (h, h)).copy_from(&sum.own.view((0, 0), (h, h)));
        let factor = Factor::new(inner)?;
        let solved = factor.solve(&across);
        all -= across.transpose() * &solved;
        let log_det = factor.log_det();
        Some(Reduced { global: all, log_det, log_weights, factor, solved, sizes: scale })
    }
}

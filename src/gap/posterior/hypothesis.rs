//! A set of effects with the forms of their laws.

use nalgebra::DMatrix;

use crate::gap::data::Record;
use crate::gap::design::{Design, PieceRows};

/// A piece of an effect with functions for the form of its law.
#[derive(Clone)]
pub(in crate::gap) struct Member {
    /// The piece.
    pub piece: PieceRows,
    /// By joint, the rows of functions of its form, of unit size.
    pub forms: Vec<(usize, DMatrix<f64>)>,
}

/// A set of effects.
#[derive(Clone, Default)]
pub(in crate::gap) struct Hypothesis {
    /// Pieces.
    pub members: Vec<Member>,
}

#[derive(Clone)]
/// Products of a joint's columns with the additional columns of a hypothesis, by cell.
pub(super) struct Extra {
    /// Columns of effects, then of forms, transposed.
    pub(super) transposed: DMatrix<f64>,
    /// Number of columns of effects.
    pub(super) effects: usize,
    /// For each column of a form, the number of its member.
    pub(super) forms: Vec<usize>,
    /// Mean square of the laws in a row of each cell \[N²m²\].
    pub(super) laws: Vec<f64>,
    /// `[y, base]ᵀ E` by cell; none where the hypothesis does not reach the joint.
    with_base: Vec<DMatrix<f64>>,
    /// `Eᵀ E` by cell.
    pub(super) own: Vec<DMatrix<f64>>,
}

impl Extra {
    /// `[y, base]ᵀ E` and `Eᵀ E` of a cell; `None` where the hypothesis does not reach the joint.
    pub(super) fn products(&self, cell: usize) -> Option<(&DMatrix<f64>, &DMatrix<f64>)> {
        Some((self.with_base.get(cell)?, self.own.get(cell)?))
    }
}

impl Member {
    /// A piece with its form.
    #[must_use]
    pub(in crate::gap) fn new(design: &Design, records: &[Record<'_>], piece: PieceRows) -> Member {
        let forms = piece.forms(design, records);
        Member { piece, forms }
    }

    /// A piece as it is written, which is not right just after reversals.
    #[must_use]
    pub(in crate::gap) fn as_written(
        design: &Design,
        records: &[Record<'_>],
        piece: PieceRows,
    ) -> Member {
        let forms = piece.forms_after_reversals(design, records);
        Member { piece, forms }
    }
}

impl Hypothesis {
    /// Number of columns of effects.
    #[must_use]
    pub(in crate::gap) fn columns(&self) -> usize {
        self.members.iter().map(|member| member.piece.prior.len()).sum()
    }

    /// Whether it changes the torque of a joint.
    #[must_use]
    pub(super) fn reaches(&self, joint: usize) -> bool {
        self.members.iter().any(|member| member.reaches(joint))
    }

    /// The additional columns of a joint.
    pub(super) fn extra(&self, design: &Design, joint: usize) -> Extra {
        let of = &design.joints[joint];
        let height = of.y.len();
        let effects = self.columns();
        let mut forms = Vec::new();
        for (number, member) in self.members.iter().enumerate() {
            if let Some((_, rows)) = member.forms.iter().find(|(at, _)| *at == joint) {
                forms.extend(vec![number; rows.ncols()]);
            }
        }
        let mut columns = DMatrix::zeros(height, effects + forms.len());
        let (mut from, mut form_from) = (0, effects);
        for member in &self.members {
            let count = member.piece.prior.len();
            if let Some((_, rows)) = member.piece.rows.iter().find(|(at, _)| *at == joint) {
                columns.columns_mut(from, count).copy_from(rows);
            }
            from += count;
            if let Some((_, rows)) = member.forms.iter().find(|(at, _)| *at == joint) {
                // Functions of unit size are in shares of the torque.
                columns.columns_mut(form_from, rows.ncols()).copy_from(&(rows * of.torque));
                form_from += rows.ncols();
            }
        }
        let transposed_extra = columns.transpose();
        let (mut with_base, mut own) = (Vec::new(), Vec::new());
        let cells = if self.reaches(joint) { &of.cells[..] } else { &[] };
        for cell in cells {
            let (from, count) = (cell.rows.start, cell.rows.len());
            let rows = columns.rows(from, count);
            let mut with = DMatrix::zeros(1 + of.base.ncols(), columns.ncols());
            with.row_mut(0).copy_from(&(of.y.rows(from, count).transpose() * rows));
            let transposed = of.transposed.columns(from, count);
            with.rows_mut(1, of.base.ncols()).copy_from(&(transposed * rows));
            with_base.push(with);
            own.push(transposed_extra.columns(from, count) * rows);
        }
        Extra {
            laws: vec![0.0; of.cells.len()],
            transposed: transposed_extra,
            effects,
            forms,
            with_base,
            own,
        }
    }
}

//! Pieces of effects in motions that nobody has logged yet.

use super::piece::{PieceRows, link_pieces, piece_at};
use super::problem::Design;
use crate::arm::effects::{Acts, Nature};
use crate::gap::data::Record;

impl PieceRows {
    /// The same effect with the same columns in the records of another design; `None` where it does not
    /// come again there, or has other columns.
    #[must_use]
    pub(in crate::gap) fn on(&self, design: &Design, records: &[Record<'_>]) -> Option<PieceRows> {
        let there = match (self.effect.nature, self.effect.acts) {
            (_, Acts::InWindow) => return None,
            (Nature::Parameters, _) => {
                link_pieces(design, self.effect).into_iter().find(|of| of.joint == self.joint)?
            }
            _ => piece_at(design, records, self),
        };
        (there.prior.len() == self.prior.len() && there.own == self.own).then_some(there)
    }

    /// The effect without its rows.
    #[must_use]
    pub(in crate::gap) fn without_rows(mut self) -> PieceRows {
        self.rows = Vec::new();
        self
    }
}

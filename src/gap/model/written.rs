//! The model that predicts best: neither everyday errors nor other forms of laws are written, so that
//! its numbers stand in for them.

use super::fitted::Fitted;
use super::improved::Improved;
use crate::arm::effects::Effect;
use crate::arm::robot::Model;
use crate::gap::data::Record;
use crate::gap::design::{Design, Parameters, PieceRows};
use crate::gap::posterior::fitted_as_written;

/// The model with pieces of effects, fitted to logs; effects that do not come again in other logs take
/// part in the fit alone.
#[must_use]
pub(in crate::gap) fn written(
    model: &Model,
    (design, records): (&Design, &[Record<'_>]),
    pieces: Vec<PieceRows>,
    comes_again: impl Fn(&Effect) -> bool,
) -> Improved {
    let mut pieces = pieces;
    let Some(mut fit) = fitted_as_written(design, records, pieces.clone(), None) else {
        return Improved::same(model);
    };
    // Parameters shared the torques of a load that was moved to the nearest body.
    let mut is_moved = false;
    for (piece, of) in pieces.iter_mut().zip(Fitted::of_fit(&fit)) {
        if of.effect.is_load() {
            piece.hold(&of.coordinates);
            is_moved = true;
        }
    }
    if is_moved && let Some(again) = fitted_as_written(design, records, pieces, Some(&fit)) {
        fit = again;
    }
    let Parameters { mixing, sizes, .. } = &design.parameters;
    let change = mixing * fit.mean.rows(0, mixing.ncols());
    let mut effects = Fitted::of_fit(&fit);
    effects.retain(|of| comes_again(of.effect));
    Improved::new(model, [&change, sizes], [&Fitted::brought(&fit), &effects])
}

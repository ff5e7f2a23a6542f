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
    let Some(fit) = fitted_as_written(design, records, pieces, None) else {
        return Improved::same(model);
    };
    let Parameters { mixing, sizes, .. } = &design.parameters;
    let change = mixing * fit.mean.rows(0, mixing.ncols());
    let mut effects = Fitted::of_fit(&fit);
    effects.retain(|of| comes_again(of.effect));
    Improved::new(model, [&change, sizes], [&Fitted::brought(&fit), &effects])
}

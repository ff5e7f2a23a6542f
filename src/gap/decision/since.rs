//! Whether an effect came after the baseline.

use rayon::prelude::*;

use super::found::{Found, may_be_in_baseline};
use super::search::Search;
use super::window::Windows;
use crate::arm::effects::Acts;
use crate::gap::data::Record;
use crate::gap::design::PieceRows;
use crate::gap::posterior::Gains;

/// Evidence that effect `number` of a set came after the baseline \[nats\]: against its being in the baseline
/// as well, or, where it acts once, against what acts in the best window of the baseline. `None` without a
/// baseline, and for what cannot be in it.
pub(super) fn since_baseline(
    search: &Search<'_>,
    none: &Found,
    found: &Found,
    number: usize,
) -> Option<f64> {
    let of = &found.effects[number];
    if !search.has_baseline() {
        return None;
    }
    if of.effect.acts == Acts::InWindow && !search.records.first()?.motion.closed {
        let without =
            if found.effects.len() > 1 { search.without(none, found, number)?.score } else { 0.0 };
        return Some(found.score - without - in_baseline(search, found, number));
    }
    if !may_be_in_baseline(of.effect) {
        return None;
    }
    let mut effects = found.effects.clone();
    for piece in &mut effects[number].pieces {
        let of_baseline = piece.clone().of_baseline();
        *piece = of_baseline.reshaped(search.design, search.logs(true), &piece.shape, true);
    }
    Some(found.score - search.with(none, effects)?.score)
}

/// What the best windows of the baseline would gain with the effect `number` of a set at its joints, less
/// their costs \[nats\].
fn in_baseline(search: &Search<'_>, found: &Found, number: usize) -> f64 {
    let of = &found.effects[number];
    let swapped: Vec<Record<'_>> = search.records.iter().map(Record::swapped).collect();
    let gains = Gains::new(search.design, &found.fit);
    let of_piece = |piece: &PieceRows| {
        let joint = piece.joint.unwrap_or(0);
        let windows = Windows::new(search.design, &swapped, of.effect, joint)?;
        let best = windows.best(&swapped, search.design, &gains).into_iter();
        let net = best.map(|of| gains.of(&of, f64::INFINITY) - search.cost_of(&of));
        net.max_by(f64::total_cmp)
    };
    let all = of.pieces.par_iter().filter_map(of_piece);
    all.filter(|net| *net > 0.0).sum::<f64>() - search.design.tunables.effect_cost
}

//! Whether an effect came after the baseline.

use super::found::Found;
use super::search::Search;
use crate::arm::effects::{Acts, Nature};
use crate::gap::data::{Record, RecordKind};

/// The records with those of the baseline as if they were of today; `None` without a baseline.
pub(super) fn all_as_now<'a>(search: &Search<'a>) -> Option<Vec<Record<'a>>> {
    let has_baseline = search.records.iter().any(|record| record.kind == RecordKind::Before);
    has_baseline.then(|| search.records.iter().map(Record::as_now).collect())
}

/// Evidence that effect `number` of a set is in the logs of today alone, against its being in the
/// baseline as well \[nats\]. `all` are the records as [`all_as_now`] has them. `None` for parameters, which
/// the baseline has as well, and for what acts at times, which are others in the baseline.
pub(super) fn since_baseline(
    search: &Search<'_>,
    none: &Found,
    found: &Found,
    number: usize,
    all: &[Record<'_>],
) -> Option<f64> {
    let effect = found.effects[number].effect;
    if effect.nature == Nature::Parameters || matches!(effect.acts, Acts::InWindow | Acts::OverTime)
    {
        return None;
    }
    let mut effects = found.effects.clone();
    for piece in &mut effects[number].pieces {
        *piece = piece.reshaped(search.design, all, &piece.shape, true);
    }
    Some(found.score - search.with(none, effects)?.score)
}

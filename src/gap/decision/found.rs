//! Sets of effects that a search looks at.

use crate::arm::effects::{Acts, Effect, Nature};
use crate::gap::data::{Record, RecordKind};
use crate::gap::design::PieceRows;
use crate::gap::posterior::Fit;

/// Pieces of one effect.
#[derive(Clone)]
pub(in crate::gap) struct Candidate {
    /// The effect.
    pub effect: &'static Effect,
    /// Its pieces.
    pub pieces: Vec<PieceRows>,
    /// Prior cost \[nats\].
    pub cost: f64,
    /// Whether it is no larger than what any robot has, other values of parameters, or in the baseline,
    /// too: it takes no place of a finding.
    pub is_everyday: bool,
}

impl Candidate {
    /// Whether the baseline has it, too.
    pub(in crate::gap) fn in_baseline(&self) -> bool {
        self.pieces.iter().any(|piece| piece.in_baseline)
    }
}

/// A set of effects.
#[derive(Clone)]
pub(in crate::gap) struct Found {
    /// The effects.
    pub effects: Vec<Candidate>,
    /// The fit with them.
    pub fit: Fit,
    /// Logarithm of the odds against no effect.
    pub score: f64,
}

impl Found {
    /// Number of effects that are findings.
    pub(super) fn places(&self) -> usize {
        self.effects.iter().filter(|of| !of.is_everyday).count()
    }

    /// The effects that the baseline has, too.
    pub(in crate::gap) fn in_baseline(&self) -> impl Iterator<Item = &Candidate> {
        self.effects.iter().filter(|of| of.in_baseline())
    }

    pub(super) fn tried(&self) -> Tried {
        let new = self.effects.iter().filter(|of| !of.in_baseline());
        Tried { ids: new.map(|of| of.effect.id).collect(), score: self.score }
    }
}

/// A set that was fitted: ids of its effects that the baseline does not have, and the logarithm of the odds against no effect.
pub(in crate::gap) struct Tried {
    /// Ids.
    pub ids: Vec<&'static str>,
    /// Odds \[nats\].
    pub score: f64,
}

/// What a search found.
pub(in crate::gap) struct Searched {
    /// The fit without effects.
    pub none: Found,
    /// The best set.
    pub best: Found,
    /// All sets that were fitted.
    pub tried: Vec<Tried>,
    /// The best ones of each size.
    pub near: Vec<Found>,
}

/// The records with those of the baseline as if they were of today; `None` without a baseline.
pub(super) fn all_as_now<'a>(records: &[Record<'a>]) -> Option<Vec<Record<'a>>> {
    let has_baseline = records.iter().any(|record| record.kind == RecordKind::Before);
    has_baseline.then(|| records.iter().map(Record::as_now).collect())
}

/// Whether the baseline may have an effect, too. It has the same parameters anyway, and what acts at times
/// acts at others there.
pub(super) fn may_be_in_baseline(effect: &Effect) -> bool {
    effect.nature != Nature::Parameters && !matches!(effect.acts, Acts::InWindow | Acts::OverTime)
}

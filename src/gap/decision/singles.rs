//! Effects that a search looks at next: at single joints, then at all joints at which they explain something.

use super::found::{Candidate, Found};
use super::search::Search;
use crate::gap::design::PieceRows;
use crate::gap::posterior::Gains;

/// Effects at all their joints that are looked at in each round, and those that the baseline has, too.
const FULL: usize = 6;
const OF_ROBOT: usize = 2;

impl Search<'_> {
    /// For each effect that is not in the set its best shape at each joint, those alone that may explain
    /// something \[nats\]; those first that the baseline has, too.
    pub(super) fn singles(
        &self,
        pieces: Vec<PieceRows>,
        gains: &Gains<'_>,
        set: &[Candidate],
    ) -> [Vec<(f64, PieceRows)>; 2] {
        let all = gains.of_all(&pieces, f64::INFINITY);
        let is_there = |piece: &PieceRows| {
            let id = piece.effect.id;
            let brings =
                |other: &PieceRows| other.joint == piece.joint && other.effect.brings.contains(&id);
            // More joints of the robot may have what others have.
            let has = |of: &Candidate| {
                let mut pieces = of.pieces.iter();
                of.effect.id == id
                    && (!of.in_baseline() || pieces.any(|other| other.joint == piece.joint))
            };
            let mut alike = set.iter().filter(|of| of.in_baseline() == piece.in_baseline);
            alike.any(|of| has(of) || of.pieces.iter().any(brings))
        };
        let mut best: Vec<(f64, PieceRows)> = Vec::new();
        for (piece, gain) in pieces.into_iter().zip(all) {
            let net = gain - self.cost_of(&piece);
            if net <= 0.0 || is_there(&piece) {
                continue;
            }
            let key = |of: &PieceRows| (of.effect.id, of.joint, of.in_baseline);
            let is_like = |of: &PieceRows| key(of) == key(&piece);
            match best.iter_mut().find(|(_, of)| is_like(of)) {
                Some(known) if net > known.0 => *known = (net, piece),
                Some(_) => {}
                None => best.push((net, piece)),
            }
        }
        best.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (of_robot, new) = best.into_iter().partition(|(_, piece)| piece.in_baseline);
        [of_robot, new]
    }

    /// An effect with its pieces.
    pub(super) fn candidate(&self, pieces: Vec<PieceRows>) -> Option<Candidate> {
        let effect = pieces.first()?.effect;
        let costs = pieces.iter().map(|piece| self.cost_of(piece));
        let cost = self.design.tunables.effect_cost + costs.sum::<f64>();
        Some(Candidate { effect, cost, pieces, is_everyday: false })
    }

    /// The effects that explain most where the baseline has them, too, from their pieces.
    pub(super) fn of_robot(&self, pieces: Vec<(f64, PieceRows)>) -> Vec<Candidate> {
        let mut by_effect: Vec<(f64, Vec<PieceRows>)> = Vec::new();
        for (net, piece) in pieces {
            let id = piece.effect.id;
            match by_effect.iter_mut().find(|(_, known)| known[0].effect.id == id) {
                Some((sum, known)) => {
                    *sum += net;
                    known.push(piece);
                }
                None => by_effect.push((net, vec![piece])),
            }
        }
        by_effect.sort_by(|a, b| b.0.total_cmp(&a.0));
        let best = by_effect.into_iter().take(OF_ROBOT);
        best.filter_map(|(_, pieces)| self.candidate(pieces)).collect()
    }

    /// The best effects at all joints at which they explain something, from sets with one piece more than
    /// `found`; where that is one joint, with its set.
    pub(super) fn joined(
        &self,
        found: &Found,
        singles: Vec<Found>,
    ) -> Vec<(Candidate, Option<Found>)> {
        let effect_cost = self.design.tunables.effect_cost;
        let gain = |of: &Found| of.score - found.score + effect_cost;
        let mut by_effect: Vec<(&'static str, Vec<Found>)> = Vec::new();
        for of in singles.into_iter().filter(|of| gain(of) > 0.0) {
            let Some(id) = of.effects.last().map(|last| last.effect.id) else { continue };
            match by_effect.iter_mut().find(|(known, _)| *known == id) {
                Some((_, all)) => all.push(of),
                None => by_effect.push((id, vec![of])),
            }
        }
        let of_effect = |(_, all): (&str, Vec<Found>)| {
            let score: f64 = all.iter().map(gain).sum();
            let pieces = all.iter().filter_map(|of| of.effects.last()).flat_map(|of| &of.pieces);
            let candidate = self.candidate(pieces.cloned().collect())?;
            let single = if all.len() == 1 { all.into_iter().next() } else { None };
            Some((score, (candidate, single)))
        };
        let mut all: Vec<_> = by_effect.into_iter().filter_map(of_effect).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.truncate(FULL);
        all.into_iter().map(|(_, of)| of).collect()
    }
}

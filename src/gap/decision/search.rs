//! The search for the most probable set of effects.

use crate::arm::effects::Effect;
use rayon::prelude::*;

use super::shape::{moves, refined};
use super::window::windows;
use crate::gap::design::{Design, Group, PieceRows, Whole};
use crate::gap::posterior::{Fit, Gains, Hypothesis, Member, Sizes, fitted, usual};
use crate::gap::record::Record;

/// Families that are fitted in full in each round.
const FULL: usize = 6;
/// Steps of the sizes: of a first fit, and of a fit with an effect.
const FIRST: usize = 10;
const ROUNDS: usize = 4;
/// Sets whose shapes are refined in each round.
const REFINED: usize = 4;

/// Pieces of one effect.
#[derive(Clone)]
pub struct Candidate {
    /// The effect.
    pub effect: &'static Effect,
    /// Its pieces.
    pub pieces: Vec<PieceRows>,
    /// Prior cost \[nats\].
    pub cost: f64,
}

/// A set of effects.
pub struct Found {
    /// The effects.
    pub effects: Vec<Candidate>,
    /// The fit with them.
    pub fit: Fit,
    /// Logarithm of the odds against no effect.
    pub score: f64,
}

/// A search.
pub struct Search<'a> {
    /// Records.
    pub records: &'a [Record<'a>],
    /// Design.
    pub design: &'a Design,
    /// Pieces that may be found.
    pub pieces: &'a [PieceRows],
    /// Effects that act in windows.
    pub whole: &'a [Whole],
}

impl Search<'_> {
    /// The fit without effects.
    #[must_use]
    pub fn none(&self) -> Option<Found> {
        let fit = fitted(self.design, Hypothesis::default(), usual(self.design), FIRST, false)?;
        Some(Found { effects: Vec::new(), score: 0.0, fit })
    }

    /// For each effect that is not in the set, its best joints and shapes beside it.
    #[must_use]
    pub fn candidates(
        &self,
        pieces: &[PieceRows],
        gains: &[[f64; 2]],
        set: &[Candidate],
    ) -> Vec<(f64, Candidate)> {
        let mut all: Vec<(f64, Candidate)> = Vec::new();
        let mut ids: Vec<&'static str> = Vec::new();
        for piece in pieces {
            if !ids.contains(&piece.effect.id) {
                ids.push(piece.effect.id);
            }
        }
        for id in ids.into_iter().filter(|id| set.iter().all(|of| of.effect.id != *id)) {
            // By joint: the gain less the cost, the cost, the piece.
            let mut best: Vec<(Option<usize>, [f64; 2], &PieceRows)> = Vec::new();
            let brought = |piece: &PieceRows| {
                let of_joint = |other: &PieceRows| {
                    other.joint == piece.joint && other.effect.brings.contains(&id)
                };
                set.iter().flat_map(|of| &of.pieces).any(of_joint)
            };
            for (piece, [gain, of_brought]) in
                pieces.iter().zip(gains).filter(|(p, _)| p.effect.id == id)
            {
                if brought(piece) {
                    continue;
                }
                let cost = self.design.tunables.joint_cost
                    + (piece.choices.max(1) as f64).ln()
                    + of_brought;
                let net = gain - cost;
                match best.iter_mut().find(|(joint, ..)| *joint == piece.joint) {
                    Some(known) if net > known.1[0] => (known.1, known.2) = ([net, cost], piece),
                    Some(_) => {}
                    None => best.push((piece.joint, [net, cost], piece)),
                }
            }
            best.sort_by(|a, b| b.1[0].total_cmp(&a.1[0]));
            let wanted = |(k, of): &(usize, &(Option<usize>, [f64; 2], &PieceRows))| {
                *k == 0 || of.1[0] > 0.0
            };
            let chosen: Vec<_> =
                best.iter().enumerate().filter(wanted).map(|(_, of)| of).collect();
            let Some(first) = chosen.first() else { continue };
            let effect_cost = self.design.tunables.effect_cost;
            let score = chosen.iter().map(|of| of.1[0]).sum::<f64>() - effect_cost;
            let cost = effect_cost + chosen.iter().map(|of| of.1[1]).sum::<f64>();
            let pieces = chosen.iter().map(|of| of.2.clone()).collect();
            all.push((score, Candidate { effect: first.2.effect, pieces, cost }));
        }
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all
    }

    /// The fit with a set of effects, from sizes.
    #[must_use]
    pub fn with(&self, base: &Found, effects: Vec<Candidate>, sizes: Sizes) -> Option<Found> {
        let pieces = effects.iter().flat_map(|of| of.pieces.iter().cloned());
        let members = pieces.map(|piece| Member::new(self.records, piece, &self.design.tunables)).collect();
        let fit = fitted(self.design, Hypothesis { members }, sizes, ROUNDS, true)?;
        let cost: f64 = effects.iter().map(|of| of.cost).sum();
        let score = fit.log_evidence - base.fit.log_evidence - cost;
        Some(Found { effects, fit, score })
    }

    /// The best sets with one effect more than `found`, best first.
    #[must_use]
    pub fn next(&self, none: &Found, found: &Found) -> Vec<Found> {
        let t = std::time::Instant::now();
        let usual_sizes = usual(self.design);
        let plain = fitted(self.design, found.fit.hypothesis.clone(), usual_sizes, 0, true);
        let mut lists: Vec<(Vec<PieceRows>, Vec<[f64; 2]>)> = Vec::new();
        for fit in std::iter::once(&found.fit).chain(plain.iter()) {
            let low = Gains::up_to(self.design, fit, 24);
            let more: Vec<PieceRows> = self
                .whole
                .par_iter()
                .flat_map_iter(|whole| windows(self.records, self.design, fit, &low, whole))
                .collect();
            let all = Gains::new(self.design, fit);
            let mut gains = all.of_all(self.pieces);
            gains.extend(all.of_all(&more));
            lists.push((self.pieces.iter().cloned().chain(more).collect(), gains));
        }
        let t1 = t.elapsed().as_secs_f64();
        let mut wanted: Vec<Candidate> = Vec::new();
        for (pieces, gains) in &lists {
            for (_, candidate) in
                self.candidates(pieces, gains, &found.effects).into_iter().take(FULL)
            {
                let is_known = |of: &Candidate| {
                    of.effect.id == candidate.effect.id
                        && of.pieces.len() == candidate.pieces.len()
                        && of.pieces.iter().zip(&candidate.pieces).all(|(a, b)| {
                            a.joint == b.joint && a.shape == b.shape
                        })
                };
                if !wanted.iter().any(is_known) {
                    wanted.push(candidate);
                }
            }
        }
        let sizes = none.fit.sizes.clone();
        let mut all: Vec<Found> = wanted
            .into_iter()
            .filter_map(|candidate| {
                let mut effects = found.effects.clone();
                effects.push(candidate);
                self.with(none, effects, sizes.clone())
            })
            .collect();
        all.sort_by(|a, b| b.score.total_cmp(&a.score));
        let t2 = t.elapsed().as_secs_f64();
        let n = all.len();
        let rest = all.split_off(all.len().min(REFINED));
        let mut all: Vec<Found> =
            all.into_iter().map(|of| self.refined(none, found, of)).chain(rest).collect();
        all.sort_by(|a, b| b.score.total_cmp(&a.score));
        all
    }

    /// The same set with the best shapes of its last effect.
    fn refined(&self, none: &Found, found: &Found, of: Found) -> Found {
        let Some(last) = of.effects.last() else { return of };
        let without =
            fitted(self.design, found.fit.hypothesis.clone(), without_forms(&of, found), 0, true);
        let Some(without) = without else { return of };
        let refine = |piece: &PieceRows| {
            let moves = moves(piece.effect, self.records, piece);
            let reshape = |of: &PieceRows, shape: &[f64]| of.reshaped(self.records, shape);
            refined(self.design, &without, piece, &moves, &reshape)
        };
        let pieces: Vec<PieceRows> = last.pieces.iter().map(refine).collect();
        if pieces.iter().zip(&last.pieces).all(|(a, b)| a.shape == b.shape) {
            return of;
        }
        let mut effects = of.effects.clone();
        if let Some(last) = effects.last_mut() {
            last.pieces = pieces;
        }
        match self.with(none, effects, none.fit.sizes.clone()) {
            Some(better) if better.score > of.score => better,
            _ => of,
        }
    }
}

/// The sizes of a set without the forms of the effects that it has more than another one.
fn without_forms(of: &Found, than: &Found) -> Sizes {
    let count = than.fit.hypothesis.members.len();
    let mut sizes = of.fit.sizes.clone();
    for joint in &mut sizes {
        joint.groups.retain(|(group, _)| !matches!(group, Group::Form(k) if *k >= count));
    }
    sizes
}

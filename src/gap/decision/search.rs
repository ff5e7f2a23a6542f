//! The search for the most probable set of effects.

use crate::arm::effects::{Acts, Effect, Nature, Scope, Subject};
use rayon::prelude::*;

use super::found::{Candidate, Found, Searched, all_as_now, may_be_in_baseline};
use super::shape::{lowest, moves, refined};
use super::waves::Waves;
use super::window::Windows;
use crate::gap::data::Record;
use crate::gap::design::{Design, Group, PieceRows, link_pieces, piece_rows};
use crate::gap::model::Fitted;
use crate::gap::posterior::{
    Fit, Gains, Hypothesis, Member, Sizes, Start, TAIL, fitted, fitted_as_written, halfway, usual,
};

/// Effects at single joints that are looked at in each round.
const SINGLES: usize = 60;
/// Effects that are found together at most, as many that the baseline has, too, and those of everyday size
/// beside them.
const MOST: usize = 3;
const MOST_EVERYDAY: usize = 3;
/// Rounds in which effects are added at most.
const ROUNDS_AT_MOST: usize = 2 * MOST + 3;
/// Steps of the sizes, least and most: of a first fit, of a first look at a set, of a fit with a set.
const FIRST: [usize; 2] = [10, 40];
const LOOK: [usize; 2] = [3, 12];
const STEPS: [usize; 2] = [6, 24];
/// A fit at given sizes.
const NO_STEPS: [usize; 2] = [0, 0];
/// Deviations by which a parameter may be beyond what is possible.
pub(super) const BEYOND: f64 = 2.0;
/// Times that shapes are looked for beside what they bring along.
const ROUNDS: usize = 2;
/// Sets whose shapes are refined in each round.
const REFINED: usize = 4;

/// A search.
pub(in crate::gap) struct Search<'a> {
    /// Records.
    pub records: &'a [Record<'a>],
    /// Design.
    pub design: &'a Design,
    /// Pieces that may be found.
    pieces: Vec<PieceRows>,
    /// Effects that act in windows.
    windows: Vec<Windows>,
    /// Effects that are waves.
    waves: Vec<Waves>,
    /// With a baseline, the records as if those of the baseline were of today.
    as_now: Option<Vec<Record<'a>>>,
}

impl<'a> Search<'a> {
    /// A search for effects.
    #[must_use]
    pub(in crate::gap) fn new(
        records: &'a [Record<'a>],
        design: &'a Design,
        effects: &[&'static Effect],
    ) -> Search<'a> {
        let mut pieces = piece_rows(design, records, effects);
        let parameters = effects
            .iter()
            .find(|of| of.nature == Nature::Parameters && of.subject == Subject::Body);
        pieces.extend(parameters.into_iter().flat_map(|of| link_pieces(design, of)));
        let n = design.joints.len();
        let windows = effects.iter().filter(|of| of.acts == Acts::InWindow).flat_map(|of| {
            let count = if of.scope == Scope::Robot { 1 } else { n };
            (0..count).filter_map(|joint| Windows::new(design, records, of, joint))
        });
        let waves = effects.iter().flat_map(|of| {
            let joints = (of.joints)(n).into_iter();
            joints.filter_map(|joint| Waves::new(records, of, joint))
        });
        let (windows, waves) = (windows.collect(), waves.collect());
        let as_now = all_as_now(records);
        if let Some(all) = &as_now {
            let lasting: Vec<&'static Effect> =
                effects.iter().copied().filter(|of| may_be_in_baseline(of)).collect();
            let own = piece_rows(design, all, &lasting).into_iter();
            pieces.extend(own.map(PieceRows::of_baseline));
        }
        Search { records, design, pieces, windows, waves, as_now }
    }

    /// Whether there is a baseline.
    pub(super) fn has_baseline(&self) -> bool {
        self.as_now.is_some()
    }

    /// The records to which an effect adds something, as they are now: all of them where the baseline has
    /// it, too.
    pub(super) fn logs(&self, in_baseline: bool) -> &[Record<'a>] {
        self.as_now.as_deref().filter(|_| in_baseline).unwrap_or(self.records)
    }
}

impl Search<'_> {
    /// The fit without effects.
    #[must_use]
    pub(in crate::gap) fn none_of(design: &Design) -> Option<Found> {
        let fit = fitted(design, Hypothesis::default(), Start::at(usual(design)), FIRST)?;
        Some(Found { effects: Vec::new(), score: 0.0, fit })
    }

    /// The fit with a set of effects.
    #[must_use]
    pub(in crate::gap) fn with(&self, none: &Found, effects: Vec<Candidate>) -> Option<Found> {
        self.fit([none, none], effects, STEPS)
    }

    /// The fit with a set of effects near another one, with so many steps of the sizes.
    fn fit(
        &self,
        [none, near]: [&Found; 2],
        effects: Vec<Candidate>,
        steps: [usize; 2],
    ) -> Option<Found> {
        let pieces = effects.iter().flat_map(|of| of.pieces.iter().cloned());
        let member =
            |piece: PieceRows| Member::new(self.design, self.logs(piece.in_baseline), piece);
        let hypothesis = Hypothesis { members: pieces.map(member).collect() };
        let start = Start::near(self.design, &hypothesis, [none.fit.known(), near.fit.known()]);
        let fit = fitted(self.design, hypothesis, start, steps)?;
        let cost: f64 = effects.iter().map(|of| of.cost).sum();
        let gain = fit.log_evidence - none.fit.log_evidence;
        let score = gain - gain.max(0.0) * fit.share_brought() - cost - self.beyond_usual(&fit)
            + self.beyond_usual(&none.fit);
        Some(Found { effects, fit, score })
    }

    /// What everyday errors cost that are larger than any robot's \[nats\]. A baseline shows those of
    /// this one: what is more than they are counts.
    fn beyond_usual(&self, fit: &Fit) -> f64 {
        let joints = 0..self.design.joints.len();
        let over = joints.map(|joint| {
            let share = self.left(fit, joint) / self.design.tunables.usual_error;
            0.5 * (share.ln().max(0.0) / TAIL).powi(2)
        });
        over.sum()
    }

    /// Everyday errors of a joint that the baseline does not have, of its torque.
    pub(super) fn left(&self, fit: &Fit, joint: usize) -> f64 {
        if self.has_baseline() {
            fit.changed(self.design, joint)
        } else {
            fit.everyday(self.design, joint)
        }
    }

    /// The best set, with all sets that were fitted. Effects of the size of a finding are added while the
    /// evidence grows, and so are those that explain most where the baseline has them, too; then those of
    /// everyday size, all at once: what these explain as well goes.
    #[must_use]
    pub(in crate::gap) fn best(&self, none: Found) -> Searched {
        let mut tried = vec![none.tried()];
        let mut near: Vec<Found> = Vec::new();
        let mut best = none.clone();
        for _ in 0..ROUNDS_AT_MOST {
            let mut next = self.next(&none, &best);
            tried.extend(next.iter().map(Found::tried));
            near.extend(next.iter().take(REFINED).cloned());
            next.retain(|of| of.score > best.score + self.design.tunables.least_nats);
            let is_finding = |of: &&Found| of.places() > best.places();
            let is_of_robot = |of: &&Found| of.in_baseline().count() > best.in_baseline().count();
            let first = next.iter().find(is_finding).filter(|of| of.places() <= MOST);
            let first = next.first().filter(is_of_robot).or(first).cloned();
            let more = first.or_else(|| self.with_everyday(&none, &best, &next));
            match more {
                Some(more) => best = more,
                None => break,
            }
        }
        if best.effects.len() > 1 {
            best = self.pruned(&none, best);
        }
        tried.push(best.tried());
        Searched { none, best, tried, near }
    }

    /// A set with the effects of everyday size that others have more.
    fn with_everyday(&self, none: &Found, found: &Found, others: &[Found]) -> Option<Found> {
        let mut effects = found.effects.clone();
        let is_small = |of: &&Candidate| of.is_everyday && !of.in_baseline();
        for last in others.iter().filter_map(|of| of.effects.last()).filter(is_small) {
            let key = |of: &Candidate| (of.effect.id, of.in_baseline());
            let is_known = effects.iter().any(|of| key(of) == key(last));
            if !is_known && effects.iter().filter(is_small).count() < MOST_EVERYDAY {
                effects.push(last.clone());
            }
        }
        if effects.len() == found.effects.len() {
            return None;
        }
        let all = self.pruned(none, self.fit([none, found], effects, STEPS)?);
        (all.score > found.score + self.design.tunables.least_nats).then_some(all)
    }

    /// The set without effects and joints that hardly matter.
    fn pruned(&self, none: &Found, mut found: Found) -> Found {
        let tunables = &self.design.tunables;
        let mut e = 0;
        while e < found.effects.len() {
            let less = (found.effects.len() > 1).then(|| self.without(none, &found, e)).flatten();
            if let Some(less) = less.filter(|less| less.score > found.score - tunables.least_nats) {
                found = less;
                continue;
            }
            let mut k = 0;
            while k < found.effects[e].pieces.len() && found.effects[e].pieces.len() > 1 {
                match self.without_joint(none, &found, e, k) {
                    Some(less) if less.score > found.score - tunables.joint_nats => found = less,
                    _ => k += 1,
                }
            }
            e += 1;
        }
        found
    }

    /// The set without an effect, or without its pieces at some joints.
    #[must_use]
    pub(in crate::gap) fn without_id(
        &self,
        none: &Found,
        found: &Found,
        (id, joints): (&str, &[usize]),
    ) -> Option<Found> {
        let mut effects = found.effects.clone();
        for of in effects.iter_mut().filter(|of| of.effect.id == id && !of.in_baseline()) {
            let goes = |piece: &PieceRows| {
                joints.is_empty() || piece.joint.is_some_and(|joint| joints.contains(&joint))
            };
            let gone: f64 = of.pieces.iter().filter(|of| goes(of)).map(|of| self.cost_of(of)).sum();
            of.pieces.retain(|piece| !goes(piece));
            of.cost -= gone;
        }
        effects.retain(|of| !of.pieces.is_empty());
        if effects.is_empty() {
            Some(none.clone())
        } else {
            self.fit([none, found], effects, STEPS)
        }
    }

    /// The set without one of its effects.
    #[must_use]
    pub(in crate::gap) fn without(
        &self,
        none: &Found,
        found: &Found,
        effect: usize,
    ) -> Option<Found> {
        let mut effects = found.effects.clone();
        effects.remove(effect);
        self.fit([none, found], effects, STEPS)
    }

    /// The set without one piece of one of its effects.
    #[must_use]
    pub(in crate::gap) fn without_joint(
        &self,
        none: &Found,
        found: &Found,
        effect: usize,
        piece: usize,
    ) -> Option<Found> {
        let mut effects = found.effects.clone();
        let gone = effects[effect].pieces.remove(piece);
        effects[effect].cost -= self.cost_of(&gone);
        self.fit([none, found], effects, STEPS)
    }

    /// The best sets with one effect more than `found`, best first.
    #[must_use]
    fn next(&self, none: &Found, found: &Found) -> Vec<Found> {
        let start = Start::at(halfway(&found.fit.sizes));
        let halfway = fitted(self.design, found.fit.hypothesis.clone(), start, NO_STEPS);
        let Some(halfway) = halfway else { return Vec::new() };
        let gains = Gains::new(self.design, &halfway);
        let (records, design) = (self.records, self.design);
        let windows = self.windows.par_iter();
        let windows = windows.flat_map_iter(|of| of.best(records, design, &gains));
        let waves = || self.waves.par_iter();
        let of_robot = self.as_now.par_iter().flat_map(|all| {
            let own = waves().flat_map_iter(|of| of.best(all, design, &gains));
            own.map(PieceRows::of_baseline)
        });
        let waves = waves().flat_map_iter(|of| of.best(records, design, &gains));
        let mut pieces = self.pieces.clone();
        pieces.extend(windows.chain(waves).chain(of_robot).collect::<Vec<_>>());
        let [of_robot, new] = self.singles(pieces, &gains, &found.effects);
        let look = |candidate: Candidate| {
            let mut effects = found.effects.clone();
            effects.push(candidate);
            self.possible([none, found], self.fit([none, found], effects, LOOK)?)
        };
        let single = |(_, piece): (f64, PieceRows)| {
            // What acts by itself explains nothing with a wrong shape.
            let piece = if piece.is_fixed() { self.best_shape(&gains, &piece) } else { piece };
            look(self.candidate(vec![piece])?)
        };
        let singles: Vec<Found> = new.into_par_iter().take(SINGLES).filter_map(single).collect();
        let joined = self.joined(found, singles).into_par_iter();
        let looked =
            |(candidate, single): (Candidate, Option<Found>)| single.or_else(|| look(candidate));
        let of_robot = self.of_robot(of_robot).into_par_iter().filter_map(look);
        let mut all: Vec<Found> = joined.filter_map(looked).chain(of_robot).collect();
        all.sort_by(|a, b| b.score.total_cmp(&a.score));
        let rest = all.split_off(all.len().min(REFINED));
        let refined = |of: Found| self.possible([none, found], self.refined(none, found, of));
        let mut all: Vec<Found> =
            all.into_par_iter().filter_map(refined).chain(rest.into_par_iter()).collect();
        all.sort_by(|a, b| b.score.total_cmp(&a.score));
        all
    }

    /// A piece with the best shape beside a fit.
    fn best_shape(&self, gains: &Gains<'_>, piece: &PieceRows) -> PieceRows {
        let moves = moves(piece.effect, self.records, piece);
        let (design, records) = (self.design, self.logs(piece.in_baseline));
        let reshape = |of: &PieceRows, shape: &[f64]| of.reshaped(design, records, shape, false);
        let best = refined(gains, piece, &moves, lowest(records), &reshape);
        if best.shape == piece.shape {
            piece.clone()
        } else {
            piece.reshaped(design, records, &best.shape, true)
        }
    }

    /// The set without pieces of its last effect that explain nothing or whose parameters cannot be;
    /// `None` where none is left.
    fn possible(&self, known: [&Found; 2], of: Found) -> Option<Found> {
        let mut effects = of.effects.clone();
        let last = effects.last_mut()?;
        let fitted = Fitted::of_fit(&of.fit);
        let first = fitted.len() - last.pieces.len();
        let explains = |k: &usize| {
            let nats = of.fit.evidence_of(first + k);
            nats.is_none_or(|nats| nats > self.cost_of(&last.pieces[*k]))
        };
        let all = 0..last.pieces.len();
        let can_be = all.filter(|k| fitted[first + k].beyond_bounds() <= BEYOND);
        let kept: Vec<usize> = can_be.filter(explains).collect();
        if kept.len() == last.pieces.len() {
            return Some(self.rated(of));
        }
        for (k, gone) in last.pieces.iter().enumerate() {
            last.cost -= if kept.contains(&k) { 0.0 } else { self.cost_of(gone) };
        }
        last.pieces = kept.iter().map(|k| last.pieces[*k].clone()).collect();
        let rest = !last.pieces.is_empty();
        rest.then(|| self.fit(known, effects, LOOK)).flatten().map(|of| self.rated(of))
    }

    /// The set, whose last effect takes a place where one of its pieces is of the size of a finding.
    fn rated(&self, mut of: Found) -> Found {
        let fitted = Fitted::of_fit(&of.fit);
        let Some(last) = of.effects.last_mut() else { return of };
        let least = self.design.least_everyday();
        let is_large = |member: usize| {
            of.fit.is_large(self.design, member)
                && fitted[member].over_everyday().is_none_or(|over| over >= least)
        };
        let mut members = fitted.len() - last.pieces.len()..fitted.len();
        let is_no_change = last.effect.nature == Nature::Parameters || last.in_baseline();
        last.is_everyday = is_no_change || !members.any(is_large);
        of
    }

    /// Prior cost of a piece \[nats\].
    pub(super) fn cost_of(&self, piece: &PieceRows) -> f64 {
        self.design.tunables.joint_cost + (piece.choices.max(1) as f64).ln()
    }

    /// Effects with the shapes that are best where neither everyday errors nor other forms of the laws
    /// are there to help.
    #[must_use]
    pub(in crate::gap) fn shaped_as_written(&self, effects: &[Candidate]) -> Vec<Candidate> {
        let pieces = |all: &[Candidate], but: Option<usize>| -> Vec<PieceRows> {
            let kept = all.iter().enumerate().filter(|(k, _)| Some(*k) != but);
            kept.flat_map(|(_, of)| of.pieces.iter().cloned()).collect()
        };
        let fit = |pieces: Vec<PieceRows>, near: Option<&Fit>| {
            fitted_as_written(self.design, self.records, pieces, near)
        };
        let has_moves = |piece: &PieceRows| !moves(piece.effect, self.records, piece).is_empty();
        let Some(model) = self.records.first().map(|of| of.motion.model) else { return Vec::new() };
        let mut all = effects.to_vec();
        for k in 0..all.len() {
            let first = all[..k].iter().map(|of| of.pieces.len()).sum();
            if !all[k].pieces.iter().any(has_moves) {
                continue;
            }
            for _ in 0..ROUNDS {
                let Some(with) = fit(pieces(&all, None), None) else { break };
                let Some(without) = fit(pieces(&all, Some(k)), Some(&with)) else { break };
                let gains = Gains::new(self.design, &without);
                for piece in &mut all[k].pieces {
                    *piece = self.best_shape(&gains, piece).without_tangents();
                }
                let Some(with) = fit(pieces(&all, None), Some(&with)) else { break };
                if !with.bound(all[k].pieces.iter_mut(), first, model) {
                    break;
                }
            }
        }
        all
    }

    /// The same set with the best shapes of its last effect, fitted in full.
    fn refined(&self, none: &Found, found: &Found, of: Found) -> Found {
        let Some(last) = of.effects.last() else { return of };
        let sizes = Start::at(without_forms(&of, found));
        let without = fitted(self.design, found.fit.hypothesis.clone(), sizes, NO_STEPS);
        let Some(without) = without else { return of };
        let gains = Gains::new(self.design, &without);
        let pieces: Vec<PieceRows> =
            last.pieces.iter().map(|piece| self.best_shape(&gains, piece)).collect();
        let mut effects = of.effects.clone();
        if let Some(last) = effects.last_mut() {
            last.pieces = pieces;
        }
        match self.fit([none, found], effects, STEPS) {
            Some(better) if better.score > of.score => better,
            _ => self.fit([none, found], of.effects.clone(), STEPS).unwrap_or(of),
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

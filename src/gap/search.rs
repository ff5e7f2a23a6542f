//! Which effects explain a difference.

use std::collections::BTreeSet;

use rayon::prelude::*;

use crate::arm::effects::Response;

use super::chosen::{Chosen, Found};
use super::column::Owner;
use super::evidence::{Evidence, Given};
use super::hypothesis::{Family, families};
use super::late::Late;
use super::nuisance::Trust;
use super::record::Record;
use super::table::Table;

/// What naming an effect costs, and each joint of it.
const FAMILY: f64 = 3.0;
const JOINT: f64 = 1.2;
/// Effects, and what is left of them without what makes them special.
const PLAINER: [(&str, &str); 7] = [
    ("brake_drag", "friction_level"),
    ("link_parameters", "payload"),
    ("cable", "torque_offset"),
    ("gravity_spring", "torque_offset"),
    ("nonlinear_viscous", "friction_level"),
    ("stribeck", "friction_level"),
    ("gear_efficiency", "load_friction"),
];
/// What an effect has to bring at another joint, of what it brings at the first one, in a log that
/// does not tell its noise: real robots have a little of all effects.
const OF_FIRST_JOINT: f64 = 0.3;
/// What another effect has to bring.
const WORTH: f64 = 3.0;
/// Effects at most.
const MOST: usize = 6;
/// Exchanges at most.
const EXCHANGES: usize = 2;
/// Effects of a quick search at most.
const QUICK: usize = 2;

/// A log that does not repeat and is shorter says nothing of temperatures \[s\].
const WARMS: f64 = 120.0;
/// A search.
pub struct Search<'a, 'm> {
    /// The logs.
    pub records: &'a [Record<'m>],
    /// How much the model's parameters are believed.
    pub trust: Trust,
    /// Share of its torques to which the model is right.
    pub error: f64,
    /// What the torques of each joint go through.
    pub(super) channels: Vec<Response>,
    /// What they go through as an effect, if it is one.
    pub late: Option<Late>,
    /// Families that stay, though functions do all that they do.
    pub(super) kept: Vec<usize>,
    /// Whether some log does not tell its noise.
    pub(super) open: bool,
    /// Pieces whose windows have been brought to their best ends.
    pub(super) sharp: BTreeSet<usize>,
    /// Families at joints whose parameters came out as they cannot be.
    pub(super) impossible: Vec<(usize, Option<usize>)>,
    /// Ids that are not looked for.
    pub banned: Vec<&'static str>,
    /// What may explain the difference.
    pub table: Table,
    /// Its families.
    pub families: Vec<Family>,
    /// How well it does.
    pub evidence: Evidence,
}

impl<'a, 'm> Search<'a, 'm> {
    /// A search in a table of these records.
    #[must_use]
    pub fn new(
        records: &'a [Record<'m>],
        table: Table,
        trust: Trust,
        error: f64,
    ) -> Search<'a, 'm> {
        let evidence = table.evidence(error);
        let open = records.iter().any(|record| record.repetitions < 2);
        let lasts =
            records.iter().filter_map(|of| of.motion.t.last()).fold(0.0, |a: f64, b| a.max(*b));
        Search {
            records,
            trust,
            error,
            channels: vec![
                Response::default();
                records.first().map_or(0, |record| record.motion.model.dof)
            ],
            late: None,
            kept: Vec::new(),
            sharp: BTreeSet::new(),
            impossible: Vec::new(),
            open,
            banned: if open && lasts < WARMS { vec!["warm_up"] } else { Vec::new() },
            families: families(&table),
            table,
            evidence,
        }
    }

    pub(super) fn dof(&self) -> usize {
        self.channels.len()
    }

    /// Puts all that is computed behind channels.
    pub(super) fn set_channels(&mut self, channels: &[Response]) {
        self.channels = channels.to_vec();
        self.table.through_all(self.records, channels);
        self.weigh();
    }

    /// Weighs everything anew.
    pub(super) fn weigh(&mut self) {
        self.table.changed.clear();
        self.evidence = self.table.evidence(self.error);
    }

    /// The same where only shapes have changed.
    pub(super) fn weigh_changed(&mut self) {
        let all: Vec<usize> = (0..self.table.means.len()).collect();
        let changed = std::mem::take(&mut self.table.changed).into_iter().collect();
        self.evidence.replace(&self.table.products_of(self.error, &all, changed));
    }

    /// Takes the model for right to this share of its torques.
    pub(super) fn set_error(&mut self, error: f64) {
        self.error = error;
        self.weigh();
    }

    /// Takes the error of the model with which the measurement is most probable, effects that a
    /// quick search finds being there; the logarithm of that probability.
    pub fn choose_error(&mut self, errors: &[f64]) -> f64 {
        let mut best: Option<(f64, f64)> = None;
        for error in errors {
            self.set_error(*error);
            let total = self.evidence.null + self.quick().score;
            if best.is_some_and(|(most, _)| total < most) {
                // Beyond the most probable one it only gets worse.
                break;
            }
            best = Some((total, *error));
        }
        let Some((total, error)) = best else { return f64::NEG_INFINITY };
        self.set_error(error);
        total
    }

    /// Takes the error with which the measurement is most probable with a set; whether that is a
    /// smaller one.
    pub(super) fn lower_error(&mut self, found: &mut Found, errors: &[f64]) -> bool {
        let before = self.error;
        let mut best = (self.evidence.null + found.score, before);
        for error in errors.iter().copied().filter(|error| *error < before) {
            self.set_error(error);
            let total = self.evidence.null + self.score(&found.chosen);
            if total > best.0 {
                best = (total, error);
            }
        }
        if self.error != best.1 {
            self.set_error(best.1);
        }
        found.score = self.score(&found.chosen);
        best.1 < before
    }

    /// The best set of effects at the shapes that are tried.
    fn quick(&self) -> Found {
        let mut found = Found { chosen: Vec::new(), score: 0.0 };
        while found.chosen.len() < QUICK {
            match self.next(&found) {
                Some(next) if next.score > found.score + WORTH => found = next,
                _ => break,
            }
        }
        found
    }

    /// Numbers of the families that are looked for.
    pub(super) fn wanted(&self) -> Vec<usize> {
        let is_wanted = |of: &usize| !self.banned.contains(&self.families[*of].owner.id());
        (0..self.families.len()).filter(is_wanted).collect()
    }

    /// The best set with one family more.
    pub(super) fn next(&self, found: &Found) -> Option<Found> {
        let given = self.given(&found.chosen);
        self.wanted()
            .into_par_iter()
            .filter(|family| found.chosen.iter().all(|of| of.family != *family))
            .filter_map(|family| self.with(&given, &found.chosen, family))
            .max_by(|a, b| a.score.total_cmp(&b.score))
    }

    /// The evidence when a set is there.
    #[must_use]
    pub fn given(&self, set: &[Chosen]) -> Given {
        self.evidence.given(&self.columns(set))
    }

    /// The best set of effects: found one after another, unless some pair or an exchange of one
    /// member explains more.
    pub fn run(&mut self) -> Found {
        self.impossible.clear();
        let mut found = self.run_from(Found { chosen: Vec::new(), score: 0.0 });
        for _ in 0..EXCHANGES {
            let better = [self.best_pair(), self.exchanged(&found)].into_iter().flatten();
            let best = better.max_by(|a, b| a.score.total_cmp(&b.score));
            let Some(mut other) = best.filter(|of| of.score > found.score + WORTH) else { break };
            let before = self.evidence.null + found.score;
            self.settle(&mut other);
            other = self.run_from(other);
            if self.evidence.null + other.score <= before {
                // Shapes and variances are the other one's now.
                self.settle(&mut found);
                break;
            }
            found = other;
        }
        found
    }

    /// The best of all pairs of families, at the shapes as they are.
    fn best_pair(&self) -> Option<Found> {
        let (none, wanted) = (self.given(&[]), self.wanted());
        let best = |a: &Found, b: &Found| a.score.total_cmp(&b.score);
        let singles = wanted.par_iter().filter_map(|first| self.with(&none, &[], *first));
        singles
            .filter_map(|single| {
                let given = self.given(&single.chosen);
                // Pairs count once: with a family that comes later.
                let later =
                    wanted.iter().filter(|of| single.chosen.iter().all(|own| own.family < **of));
                later.filter_map(|second| self.with(&given, &single.chosen, *second)).max_by(best)
            })
            .max_by(best)
    }

    /// The best set in which another family has the place of one.
    fn exchanged(&self, found: &Found) -> Option<Found> {
        (0..found.chosen.len())
            .filter_map(|place| {
                let mut rest = found.chosen.clone();
                rest.remove(place);
                let score = self.score(&rest);
                self.next(&Found { chosen: rest, score })
            })
            .max_by(|a, b| a.score.total_cmp(&b.score))
    }

    /// The best set of effects that one after another leads to. Each is brought to its best shape
    /// before the next one is looked for: what a coarse shape leaves is no other effect.
    pub fn run_from(&mut self, mut found: Found) -> Found {
        while found.chosen.len() < MOST {
            match self.next(&found) {
                Some(next) if next.score > found.score + WORTH => found = next,
                _ => break,
            }
            found = self.without_needless(found);
            self.settle(&mut found);
            found = self.without_impossible(found);
        }
        found
    }

    /// What is late and shapes become the best ones, then what they leave the variance of a log that
    /// tells none.
    pub(super) fn settle(&mut self, found: &mut Found) {
        self.tune(&self.columns(&found.chosen));
        self.refine(found, 0);
        if self.is_open() {
            self.match_excess(&found.chosen);
            found.score = self.score(&found.chosen);
        }
    }

    /// Shapes of what was found, from one member on, become the best ones.
    pub(super) fn refine(&mut self, found: &mut Found, from: usize) {
        let pieces: Vec<usize> =
            found.chosen[from..].iter().flat_map(|of| of.pieces.clone()).collect();
        self.sharpen(&found.chosen, &pieces);
        self.bring_to_best(&found.chosen, &pieces);
        if !self.table.changed.is_empty() {
            self.weigh_changed();
        }
        found.score = self.score(&found.chosen);
    }

    /// The set `chosen` with another family, whose joints and shapes are chosen one after
    /// another; `given` is the evidence when the set is there.
    #[must_use]
    pub fn with(&self, given: &Given, chosen: &[Chosen], family: usize) -> Option<Found> {
        let before = self.cost(chosen);
        let mut best: Option<f64> = None;
        let mut pieces: Vec<usize> = Vec::new();
        let mut first: Option<f64> = None;
        loop {
            let mut next: Option<(f64, usize)> = None;
            for (joint, all) in &self.families[family].joints {
                let taken = |piece: &usize| self.table.pieces[*piece].joint == *joint;
                if pieces.iter().any(taken) || self.impossible.contains(&(family, *joint)) {
                    continue;
                }
                for piece in all {
                    let mut more = pieces.clone();
                    more.push(*piece);
                    let own = [Chosen { family, pieces: more }];
                    let score = given.gain(&self.columns(&own)) - before - self.cost(&own);
                    if next.is_none_or(|(most, _)| score > most) {
                        next = Some((score, *piece));
                    }
                }
            }
            let Some((score, piece)) = next else { break };
            let first = *first.get_or_insert(score - given.gain(&[]) + before);
            let least = if self.open { OF_FIRST_JOINT * first } else { 0.0 };
            if best.is_some_and(|best| score - best <= least) {
                break;
            }
            pieces.push(piece);
            best = Some(score);
        }
        let mut set = chosen.to_vec();
        set.push(Chosen { family, pieces });
        best.map(|score| Found { chosen: set, score })
    }

    /// Puts plainer effects in the place of those that explain hardly more.
    pub fn simplify(&mut self, found: &mut Found, hardly: f64) {
        // The order changes with each.
        for _ in 0..PLAINER.len() {
            if !self.simplified(found, hardly) {
                return;
            }
        }
    }

    /// The same of one effect; whether there was one.
    fn simplified(&mut self, found: &mut Found, hardly: f64) -> bool {
        for place in 0..found.chosen.len() {
            let id = self.families[found.chosen[place].family].owner.id();
            let Some((_, plainer)) = PLAINER.iter().find(|(of, _)| *of == id) else { continue };
            let family = self.families.iter().position(|family| family.owner.id() == *plainer);
            let taken = found.chosen.iter().any(|of| Some(of.family) == family);
            let Some(family) = family.filter(|_| !taken) else { continue };
            let mut rest = found.chosen.clone();
            rest.remove(place);
            let given = self.given(&rest);
            if let Some(other) = self.with(&given, &rest, family)
                && other.score > found.score - hardly
            {
                *found = other;
                self.refine(found, 0);
                return true;
            }
        }
        false
    }

    /// Families that later ones made needless are taken out.
    fn without_needless(&self, mut found: Found) -> Found {
        while found.chosen.len() > 1 {
            let less = (0..found.chosen.len())
                .filter(|k| !self.kept.contains(&found.chosen[*k].family))
                .map(|k| {
                    let mut set = found.chosen.clone();
                    set.remove(k);
                    let score = self.score(&set);
                    Found { chosen: set, score }
                })
                .max_by(|a, b| a.score.total_cmp(&b.score));
            match less {
                Some(less) if less.score > found.score - WORTH => found = less,
                _ => break,
            }
        }
        found
    }

    /// Logarithm of the odds of a set against no effect.
    #[must_use]
    pub fn score(&self, set: &[Chosen]) -> f64 {
        self.evidence.gain(&self.columns(set)) - self.cost(set)
    }

    /// What naming a set costs.
    fn cost(&self, set: &[Chosen]) -> f64 {
        let mut cost = 0.0;
        for chosen in set {
            cost += FAMILY + JOINT * chosen.pieces.len() as f64;
            for piece in &chosen.pieces {
                cost += (self.table.pieces[*piece].choices.max(1) as f64).ln();
            }
        }
        cost
    }

    /// The columns of a set, those that effects bring among them.
    #[must_use]
    pub fn columns(&self, set: &[Chosen]) -> Vec<usize> {
        let mut columns: Vec<usize> = Vec::new();
        for piece in set.iter().flat_map(|chosen| &chosen.pieces) {
            let piece = &self.table.pieces[*piece];
            columns.extend(piece.columns.clone());
            let Owner::Effect(effect) = piece.owner else { continue };
            for brought in self.table.pieces.iter().filter(|other| {
                effect.brings.contains(&other.owner.id()) && other.joint == piece.joint
            }) {
                columns.extend(brought.columns.clone());
            }
        }
        columns.sort_unstable();
        columns.dedup();
        columns
    }
}

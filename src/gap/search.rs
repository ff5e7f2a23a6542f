//! Which effects explain a difference.

use rayon::prelude::*;

use super::channel::Channel;
use super::column::Owner;
use super::evidence::Evidence;
use super::hypothesis::{Family, families};
use super::nuisance::{Nuisance, Trust};
use super::polish::polish;
use super::record::Record;
use super::table::{Table, nuisances};

/// What naming an effect costs, and each joint of it.
const FAMILY: f64 = 3.0;
const JOINT: f64 = 1.2;
/// What another effect has to bring.
const WORTH: f64 = 3.0;
/// Effects at most.
const MOST: usize = 4;

/// A chosen family with its pieces.
#[derive(Clone)]
pub struct Chosen {
    /// Number of the family.
    pub family: usize,
    /// Its pieces.
    pub pieces: Vec<usize>,
}

/// Effects that were found.
#[derive(Clone)]
pub struct Found {
    /// In the order in which they were found.
    pub chosen: Vec<Chosen>,
    /// Logarithm of the odds against no effect.
    pub score: f64,
}

/// A search.
pub struct Search<'a, 'm> {
    /// The logs.
    pub records: &'a [Record<'m>],
    /// How much the model's parameters are believed.
    pub trust: Trust,
    /// Share of its torques to which the model is right.
    pub error: f64,
    /// What all torques go through, as far as it was found.
    pub channel: Channel,
    /// The parameters' columns of each record.
    pub(super) nuisances: Vec<Nuisance>,
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
        Search {
            records,
            trust,
            error,
            channel: Channel::default(),
            nuisances: nuisances(records, trust),
            families: families(&table),
            table,
            evidence,
        }
    }

    /// Takes the error of the model with which the measurement is most probable, effects that a
    /// quick search finds being there.
    pub fn choose_error(&mut self, errors: &[f64]) {
        let mut best: Option<(f64, f64)> = None;
        for error in errors {
            self.error = *error;
            self.evidence = self.table.evidence(*error);
            let total = self.evidence.null + self.quick().score;
            if best.is_none_or(|(most, _)| total > most) {
                best = Some((total, *error));
            }
        }
        if let Some((_, error)) = best {
            self.error = error;
            self.evidence = self.table.evidence(error);
        }
    }

    /// The best set of effects at the shapes that are tried.
    fn quick(&self) -> Found {
        let mut found = Found { chosen: Vec::new(), score: 0.0 };
        while found.chosen.len() < MOST {
            match self.next(&found) {
                Some(next) if next.score > found.score + WORTH => found = next,
                _ => break,
            }
        }
        found
    }

    /// The best set with one family more.
    fn next(&self, found: &Found) -> Option<Found> {
        (0..self.families.len())
            .into_par_iter()
            .filter(|family| found.chosen.iter().all(|of| of.family != *family))
            .filter_map(|family| self.with(&found.chosen, family))
            .max_by(|a, b| a.score.total_cmp(&b.score))
    }

    /// The best set of effects, found one after another. Each is brought to its best shape
    /// before the next one is looked for: what a coarse shape leaves is no other effect.
    pub fn run(&mut self) -> Found {
        let mut found = Found { chosen: Vec::new(), score: 0.0 };
        while found.chosen.len() < MOST {
            match self.next(&found) {
                Some(next) if next.score > found.score + WORTH => found = next,
                _ => break,
            }
            found = self.without_needless(found);
            self.refine(&mut found);
        }
        found
    }

    /// Shapes of what was found become the best ones.
    fn refine(&mut self, found: &mut Found) {
        let pieces: Vec<usize> = found.chosen.iter().flat_map(|of| of.pieces.clone()).collect();
        let Some(polished) = polish(self, &pieces) else { return };
        for (number, piece) in pieces.iter().zip(polished.pieces) {
            self.table.replace(*number, piece, self.records);
        }
        self.channel = polished.channel;
        self.table.through(&self.channel);
        self.evidence = self.table.evidence(self.error);
        found.score = self.score(&found.chosen);
    }

    /// The set with another family, whose joints and shapes are chosen one after another.
    #[must_use]
    pub fn with(&self, chosen: &[Chosen], family: usize) -> Option<Found> {
        let mut best: Option<Found> = None;
        let mut pieces: Vec<usize> = Vec::new();
        loop {
            let mut next: Option<(f64, usize)> = None;
            for (joint, all) in &self.families[family].joints {
                let taken = |piece: &usize| self.table.pieces[*piece].joint == *joint;
                if pieces.iter().any(|piece| taken(piece)) {
                    continue;
                }
                for piece in all {
                    let mut more = pieces.clone();
                    more.push(*piece);
                    let mut set = chosen.to_vec();
                    set.push(Chosen { family, pieces: more });
                    let score = self.score(&set);
                    if next.is_none_or(|(most, _)| score > most) {
                        next = Some((score, *piece));
                    }
                }
            }
            let Some((score, piece)) = next else { break };
            if best.as_ref().is_some_and(|best| score <= best.score) {
                break;
            }
            pieces.push(piece);
            let mut set = chosen.to_vec();
            set.push(Chosen { family, pieces: pieces.clone() });
            best = Some(Found { chosen: set, score });
        }
        best
    }

    /// Families that later ones made needless are taken out.
    fn without_needless(&self, mut found: Found) -> Found {
        while found.chosen.len() > 1 {
            let less = (0..found.chosen.len())
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
        let mut cost = 0.0;
        for chosen in set {
            cost += FAMILY + JOINT * chosen.pieces.len() as f64;
            for piece in &chosen.pieces {
                cost += (self.table.pieces[*piece].choices.max(1) as f64).ln();
            }
        }
        self.evidence.gain(&self.columns(set)) - cost
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

//! Which effects explain a difference.

use super::column::Owner;
use super::evidence::Evidence;
use super::hypothesis::{Family, families};
use super::table::Table;

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
pub struct Search<'a> {
    /// What may explain the difference.
    pub table: &'a Table,
    /// Its families.
    pub families: Vec<Family>,
    /// How well it does.
    pub evidence: &'a Evidence,
}

/// The best set of effects.
#[must_use]
pub fn search<'a>(table: &'a Table, evidence: &'a Evidence) -> (Search<'a>, Found) {
    let search = Search { table, families: families(table), evidence };
    let mut found = Found { chosen: Vec::new(), score: 0.0 };
    while found.chosen.len() < MOST {
        let next = (0..search.families.len())
            .filter(|family| found.chosen.iter().all(|chosen| chosen.family != *family))
            .filter_map(|family| search.with(&found.chosen, family))
            .max_by(|a, b| a.score.total_cmp(&b.score));
        match next {
            Some(next) if next.score > found.score + WORTH => found = next,
            _ => break,
        }
        found = search.without_needless(found);
    }
    (search, found)
}

impl Search<'_> {
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

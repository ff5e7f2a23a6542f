//! Effects that act for a part of each repetition.

use crate::arm::effects::{Effect, find};

use super::chosen::{Chosen, Found};
use super::column::{Owner, Piece, columns_at};
use super::effect_ids::GATED;
use super::record::Record;
use super::search::Search;

/// Parts of a repetition at which windows begin and end.
const PARTS: usize = 20;
/// Lengths of windows, in parts.
const LENGTHS: [usize; 6] = [1, 2, 3, 4, 5, 7];
/// First steps of a window, in parts: of one that was found so and of one that is sharp already.
const BLUNT: f64 = 0.5;
const SHARP: f64 = 0.0625;
/// The finest step of a window, in parts and in rows.
const FINEST: f64 = 0.02;
const OF_ROW: f64 = 0.25;

/// Nats that a step has to bring.
const LEAST: f64 = 0.01;

/// An effect whose force may grow, the longest rise and twice the first step of that.
const CONTACT: &str = "contact";
const MOST_RISE: f64 = 0.5;
const OF_RISE: f64 = 0.4;

/// Windows from which others are looked for.
const STARTS: usize = 4;

/// Pieces with windows of a brake's drag at some joints and of a contact.
pub(super) fn gated(
    effects: &[&'static Effect],
    records: &[Record<'_>],
    joints: &[usize],
) -> Vec<Piece> {
    let Some(first) = records.first() else { return Vec::new() };
    let motion = &first.motion;
    let period = if motion.closed { motion.step() * motion.rows() as f64 } else { 0.0 };
    let lasts = motion.step() * motion.rows() as f64;
    let part = lasts / PARTS as f64;
    let mut wanted: Vec<(&'static Effect, Option<usize>)> = Vec::new();
    let may = |id: &str| find(id).filter(|of| effects.iter().any(|other| other.id == of.id));
    if let Some(effect) = may("brake_drag") {
        wanted.extend(joints.iter().map(|joint| (effect, Some(*joint))));
    }
    wanted.extend(may("contact").map(|effect| (effect, None)));
    let mut pieces = Vec::new();
    for (effect, joint) in wanted {
        let at = joint.unwrap_or(0);
        let scale = motion.scale(at);
        for begin in 0..PARTS {
            for length in LENGTHS.into_iter().filter(|length| begin + length <= PARTS) {
                let window = [part * begin as f64, part * (begin + length) as f64, period];
                let mut shape: Vec<f64> = effect
                    .coordinates
                    .iter()
                    .map(|coordinate| (coordinate.usual)(&scale))
                    .collect();
                let from = shape.len() - window.len();
                shape[from..].copy_from_slice(&window);
                let columns = columns_at(effect, records, at, &shape);
                let choices = PARTS * LENGTHS.len();
                pieces.push(Piece { owner: Owner::Effect(effect), joint, shape, choices, columns });
            }
        }
    }
    pieces
}

/// Whether windows share no more than half of the shorter one.
fn are_apart([a, b]: [f64; 2], [c, d]: [f64; 2]) -> bool {
    b.min(d) - a.max(c) <= 0.5 * (b - a).min(d - c)
}

impl Search<'_, '_> {
    /// The best set of effects, from the one with a window that explains most by itself where nothing
    /// else does: what a coarse window leaves must not hide it.
    pub fn run_gated(&mut self, errors: &[f64]) -> Found {
        let has_window = |of: &usize| GATED.contains(&self.families[*of].owner.id());
        let families: Vec<usize> = self.wanted().into_iter().filter(has_window).collect();
        // High frequencies tell where a window ends, once it ends nearly there; low ones lead to it.
        self.table.limit(PARTS);
        self.weigh();
        let given = self.given(&[]);
        let mut coarse: Vec<Found> = Vec::new();
        for family in families {
            let starts = self.starts(family);
            if starts.is_empty() {
                coarse.extend(self.with(&given, &[], family));
            }
            coarse.extend(starts);
        }
        let mut highest = PARTS;
        while highest < self.table.bins() {
            self.table.limit(highest);
            for found in &coarse {
                let pieces: Vec<usize> = found.chosen[0].pieces.clone();
                self.sharpen(&found.chosen, &pieces);
            }
            highest *= 2;
        }
        self.table.limit(usize::MAX);
        self.weigh();
        let mut best = self.next(&Found { chosen: Vec::new(), score: 0.0 });
        let mut is_gated = false;
        for mut found in coarse {
            self.refine(&mut found, 0);
            if best.as_ref().is_none_or(|best| found.score > best.score) {
                (best, is_gated) = (Some(found), true);
            }
        }
        match best.filter(|_| is_gated) {
            Some(mut found) => {
                self.lower_error(&mut found, errors);
                self.run_from(found)
            }
            None => self.run(),
        }
    }

    /// The best windows of the robot in a family that are apart: from another one than the best of
    /// those that are tried a better one may be reached.
    fn starts(&self, family: usize) -> Vec<Found> {
        let of_robot = self.families[family].joints.iter().filter(|(joint, _)| joint.is_none());
        let alone = |piece: &usize| {
            let chosen = vec![Chosen { family, pieces: vec![*piece] }];
            Found { score: self.score(&chosen), chosen }
        };
        let mut all: Vec<Found> = of_robot.flat_map(|(_, pieces)| pieces).map(alone).collect();
        all.sort_by(|a, b| b.score.total_cmp(&a.score));
        let window = |found: &Found| {
            let shape = &self.table.pieces[found.chosen[0].pieces[0]].shape;
            [shape[shape.len() - 3], shape[shape.len() - 2]]
        };
        let mut apart: Vec<Found> = Vec::new();
        for found in all {
            let is_apart = apart.iter().all(|other| are_apart(window(&found), window(other)));
            if is_apart && apart.len() < STARTS {
                apart.push(found);
            }
        }
        apart
    }

    /// Moves the ends of windows of some pieces of a set as long as it helps.
    pub(super) fn sharpen(&mut self, set: &[Chosen], pieces: &[usize]) {
        let columns = self.columns(set);
        let all: Vec<usize> = (0..columns.len()).collect();
        for piece in pieces.iter().copied() {
            if self.is_coupling(piece) {
                self.couple(set, piece);
                continue;
            }
            let placed = &self.table.pieces[piece];
            let Owner::Effect(effect) = placed.owner else { continue };
            let count = placed.shape.len();
            let has_window =
                GATED.contains(&effect.id) && placed.shape[count - 2] > placed.shape[count - 3];
            if !has_window {
                continue;
            }
            let mut best = placed.shape.clone();
            let own = placed.columns.clone();
            let own: Vec<usize> =
                all.iter().copied().filter(|k| own.contains(&columns[*k])).collect();
            let mut evidence = self.table.evidence_of(self.error, &columns);
            let mut most = evidence.gain(&all);
            let lasts = self
                .records
                .first()
                .map_or(0.0, |record| record.motion.step() * record.motion.rows() as f64);
            let part = lasts / PARTS as f64;
            let (start, end) = (count - 3, count - 2);
            let mut alone = vec![vec![(start, part)], vec![(end, part)]];
            let mut together =
                vec![vec![(start, part), (end, part)], vec![(start, part), (end, -part)]];
            if effect.id == CONTACT {
                let rise = count - 4;
                alone.push(vec![(rise, OF_RISE)]);
                together.push(vec![(rise, OF_RISE), (start, -part), (end, part)]);
            }
            together.extend(alone.clone());
            let is_sharp = self.sharp.contains(&piece);
            let first = if is_sharp { SHARP } else { BLUNT };
            // A row more or less inside of a window is seen.
            let row = OF_ROW * self.records.first().map_or(0.0, |of| of.motion.step()) / part;
            let finest = FINEST.min(row);
            let mut gain_of = |shape: &[f64]| {
                if shape[end] - shape[start] < FINEST * part {
                    return f64::NEG_INFINITY;
                }
                self.reshape(&[(piece, shape.to_vec())]);
                let products = self.table.products_of(self.error, &columns, own.clone());
                evidence.replace(&products);
                evidence.gain(&all)
            };
            let mut reaches = Some(first);
            while let Some(first) = reaches.take() {
                // Ends alone lead far; together they leave where one end alone is no better.
                for ways in [&alone, &together] {
                    let mut reach = first;
                    while reach > finest {
                        let mut improved = false;
                        let steps = ways.iter().flat_map(|way| [(way, -reach), (way, reach)]);
                        for (way, step) in steps {
                            let mut shape = best.clone();
                            for (of, unit) in way {
                                shape[*of] += step * unit;
                            }
                            if effect.id == CONTACT {
                                shape[count - 4] = shape[count - 4].clamp(0.0, MOST_RISE);
                            }
                            let gain = gain_of(&shape);
                            if gain > most + LEAST {
                                (most, best, improved) = (gain, shape, true);
                            }
                        }
                        if !improved {
                            reach *= 0.5;
                        }
                    }
                }
                // Where another end is better there may be none between.
                let far = if is_sharp { 0 } else { (1.0 / BLUNT) as usize * PARTS };
                for of in [end, start] {
                    let from = best.clone();
                    for step in 0..far {
                        let mut shape = from.clone();
                        shape[of] = (step + of - start) as f64 * BLUNT * part;
                        let gain = gain_of(&shape);
                        if gain > most + LEAST {
                            (most, best, reaches) = (gain, shape, Some(BLUNT));
                        }
                    }
                }
            }
            self.reshape(&[(piece, best)]);
            self.sharp.insert(piece);
        }
    }
}

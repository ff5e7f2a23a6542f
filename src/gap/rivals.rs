//! Explanations that are left, and how well a further motion would tell them apart.
//!
//! Where explanation a is true, a motion tells it from b by ½ |Δ|² nats: Δ is the difference of their
//! torques in deviations, with all that parameters, everyday errors and b's own factors may take of it
//! taken off (T-optimality: A. Atkinson, V. Fedorov, Biometrika 62, 1975).

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::data::{Record, RecordKind};
use super::decision::{Found, Search};
use super::design::{Design, Group, PieceRows};
use super::posterior::{Gains, Hypothesis, Member, Sizes, Start, fitted};
use super::trust::Trust;
use super::tunables::Tunables;
use crate::arm::dynamics::Load;
use crate::arm::effects::Effect;
use crate::arm::robot::{MAX_DOF, Model};

/// Explanations that are told apart at most, none of the effects among them.
const MOST: usize = 4;

/// An explanation.
#[derive(Clone)]
pub struct Rival {
    /// Its effects with their joints, from 0; no joint: of the robot. Without effects: everyday errors.
    pub effects: Vec<(&'static Effect, Vec<usize>)>,
    /// Logarithm of the odds against no effect, by the logs so far.
    pub score: f64,
    pieces: Vec<PieceRows>,
    /// Factors of the columns of the pieces.
    factors: Vec<DVector<f64>>,
    /// Everyday errors as they are with it: what one explains another one calls an error.
    sizes: Sizes,
}

/// Explanations that are left.
#[derive(Clone)]
pub struct Rivals {
    /// The most probable one first.
    pub all: Vec<Rival>,
    believed: Model,
    /// Laws go by its torques.
    refit: Model,
    trust: Trust,
    tunables: Tunables,
    /// Variance of a row of one repetition, by joint \[N²m²\].
    noise: Vec<f64>,
}

/// How well a motion tells explanations apart.
#[derive(Clone, Debug, Default)]
pub struct Separation {
    /// By explanation that is true, by one that it is told from \[nats\].
    pub nats: Vec<Vec<f64>>,
    /// The joint at which their torques differ most, from 0, and by how much, rms \[Nm\].
    pub most: Vec<Vec<(usize, f64)>>,
}

impl Separation {
    /// Nats by which two explanations are told apart: whichever is true, one has to be the plainer one.
    #[must_use]
    pub fn between(&self, a: usize, b: usize) -> f64 {
        self.nats[a][b].max(self.nats[b][a])
    }

    /// One for all pairs, in nats: those that are hardly told apart count.
    #[must_use]
    pub fn worth(&self) -> f64 {
        let count = self.nats.len();
        let pairs = (0..count).flat_map(|a| (0..a).map(move |b| (a, b)));
        -pairs.map(|(a, b)| (-self.between(a, b)).exp()).sum::<f64>().max(f64::MIN_POSITIVE).ln()
    }

    /// The explanation that is hardest to tell from one.
    #[must_use]
    pub fn nearest(&self, a: usize) -> Option<usize> {
        let others = (0..self.nats.len()).filter(|b| *b != a);
        others.min_by(|b, c| self.between(a, *b).total_cmp(&self.between(a, *c)))
    }
}

impl Rivals {
    /// The best sets of effects of a search, and none.
    pub(super) fn new(
        [believed, refit]: [&Model; 2],
        search: &Search<'_>,
        (none, mut near): (&Found, Vec<Found>),
        trust: Trust,
    ) -> Rivals {
        near.retain(|of| of.score > 0.0);
        near.sort_by(|a, b| b.score.total_cmp(&a.score));
        // What hardly gains by another effect is the plainer one, which comes first.
        let least = search.design.tunables.least_nats;
        let rated: Vec<Rival> = near.iter().map(Rival::new).collect();
        let is_plain = |of: &&Rival| {
            !rated.iter().any(|other| other.is_part_of(of) && other.score > of.score - least)
        };
        let mut all: Vec<Rival> = Vec::new();
        for next in rated.iter().filter(is_plain) {
            let is_known = all.iter().any(|of| of.is_like(next));
            if !is_known && all.len() + 1 < MOST {
                all.push(next.clone());
            }
        }
        all.push(Rival::new(none));
        let means = search.records.iter().filter(|record| record.kind == RecordKind::Mean);
        let noises: Vec<Vec<f64>> = means.map(Record::noise_of_one).collect();
        let mean = |joint: usize| {
            noises.iter().map(|of| of[joint]).sum::<f64>() / noises.len().max(1) as f64
        };
        Rivals {
            all,
            believed: believed.clone(),
            refit: refit.clone(),
            trust,
            tunables: search.design.tunables.clone(),
            noise: (0..believed.dof).map(mean).collect(),
        }
    }

    /// How well a motion tells them apart that is repeated so often. `states` are position, rate and
    /// acceleration of one repetition every `step` \[s\].
    #[must_use]
    pub fn separation(
        &self,
        states: &[[[f64; MAX_DOF]; 3]],
        step: f64,
        repetitions: usize,
    ) -> Separation {
        let mut record = Record::planned(&self.believed, states, step, &self.noise, repetitions);
        record.motion.carry(&self.refit);
        record.motion.torque = record.motion.torques_of(&self.refit, &Load::none());
        let records = [record];
        let design = Design::new(&records, self.trust, &self.tunables);
        let there: Vec<Acting> =
            self.all.par_iter().map(|of| Acting::new(of, &design, &records)).collect();
        let rows: Vec<Told> = there
            .par_iter()
            .enumerate()
            .map(|(number, of)| self.told_from(of, number, &there, &design, &records))
            .collect();
        // By the explanation that is taken for the true one; transposed.
        let count = rows.len();
        Separation {
            nats: (0..count).map(|a| rows.iter().map(|row| row.0[a]).collect()).collect(),
            most: (0..count).map(|a| rows.iter().map(|row| row.1[a]).collect()).collect(),
        }
    }

    /// Nats by which each explanation is told from one where it is true, and the joint that shows it.
    fn told_from(
        &self,
        one: &Acting,
        number: usize,
        there: &[Acting],
        design: &Design,
        records: &[Record<'_>],
    ) -> Told {
        let nothing = (vec![0.0; there.len()], vec![(0, 0.0); there.len()]);
        let members = one.pieces.iter().cloned();
        let members = members.map(|piece| Member::new(design, records, piece)).collect();
        let start = Start::at(self.all[number].sizes.clone());
        let fit = fitted(design, Hypothesis { members }, start, [0, 0]);
        let (Some(fit), Some(first)) = (fit, self.all.iter().find_map(|of| of.pieces.first()))
        else {
            return nothing;
        };
        let deltas: Vec<PieceRows> = there.iter().map(|of| of.less(one, first)).collect();
        let mut nats: Vec<f64> =
            Gains::new(design, &fit).squares(&deltas).into_iter().map(|x| 0.5 * x).collect();
        nats[number] = 0.0;
        let height = records.first().map_or(1, |record| record.motion.rows()) as f64;
        let most = |delta: &PieceRows| {
            let share =
                |rows: &DMatrix<f64>, joint: usize| rows.norm() / design.joints[joint].torque;
            let largest =
                delta.rows.iter().max_by(|(i, a), (k, b)| share(a, *i).total_cmp(&share(b, *k)));
            largest.map_or((0, 0.0), |(joint, rows)| (*joint, rows.norm() / height.sqrt()))
        };
        (nats, deltas.iter().map(most).collect())
    }
}

impl Rival {
    fn new(of: &Found) -> Rival {
        let pieces: Vec<&PieceRows> = of.effects.iter().flat_map(|of| &of.pieces).collect();
        let mut from = of.fit.mean.len() - of.fit.hypothesis.columns();
        let factors = pieces.iter().map(|piece| {
            let own = of.fit.mean.rows(from, piece.prior.len()).into_owned();
            from += piece.prior.len();
            own
        });
        let mut sizes = of.fit.sizes.clone();
        for joint in &mut sizes {
            joint.groups.retain(|(group, _)| !matches!(group, Group::Form(_)));
        }
        Rival {
            sizes,
            factors: factors.collect(),
            effects: of
                .effects
                .iter()
                .filter(|of| !of.in_baseline())
                .map(|of| (of.effect, of.pieces.iter().filter_map(|of| of.joint).collect()))
                .collect(),
            score: of.score,
            pieces: pieces.into_iter().map(|piece| piece.clone().without_rows()).collect(),
        }
    }

    /// Whether another one has its effects and more.
    fn is_part_of(&self, other: &Rival) -> bool {
        let has = |id: &str| other.effects.iter().any(|(effect, _)| effect.id == id);
        self.effects.len() < other.effects.len()
            && self.effects.iter().all(|(effect, _)| has(effect.id))
    }

    /// Whether another one has the same effects.
    fn is_like(&self, other: &Rival) -> bool {
        let has = |id: &str| other.effects.iter().any(|(effect, _)| effect.id == id);
        self.effects.len() == other.effects.len()
            && self.effects.iter().all(|(effect, _)| has(effect.id))
    }
}

/// By explanation: nats, and the joint that shows most with its torque, rms \[Nm\].
type Told = (Vec<f64>, Vec<(usize, f64)>);

/// An explanation in a motion.
struct Acting {
    pieces: Vec<PieceRows>,
    /// Rows of its torques by joint.
    torque: Vec<DVector<f64>>,
}

impl Acting {
    fn new(of: &Rival, design: &Design, records: &[Record<'_>]) -> Acting {
        let mut torque: Vec<DVector<f64>> =
            design.joints.iter().map(|joint| DVector::zeros(joint.y.len())).collect();
        let mut pieces = Vec::new();
        for (piece, factors) in of.pieces.iter().zip(&of.factors) {
            let Some(piece) = piece.on(design, records) else { continue };
            for (joint, rows) in &piece.rows {
                torque[*joint] += rows * factors;
            }
            pieces.push(piece);
        }
        Acting { pieces, torque }
    }

    /// The difference of its torques to those of another one, as a column; `like` names an effect.
    fn less(&self, other: &Acting, like: &PieceRows) -> PieceRows {
        let rows = self.torque.iter().zip(&other.torque).enumerate();
        let rows = rows.map(|(joint, (a, b))| (joint, DMatrix::from_columns(&[a - b])));
        PieceRows {
            own: 1,
            prior: vec![(0.0, 1.0)],
            rows: rows.filter(|(_, rows)| rows.norm() > 0.0).collect(),
            brought: Vec::new(),
            ..like.clone()
        }
    }
}

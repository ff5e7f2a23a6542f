//! The error budget: what the gap of the model as it was is made of.
//!
//! Squares of the gap in the held-out data: what changed parameters and each effect take off (the
//! mean over all orders in which they may come: L. Shapley, A value for n-person games, 1953), what
//! nothing takes off, and noise. They add up.

use crate::arm::robot::Model;
use crate::gap::data::{REST, Record, RecordKind};
use crate::gap::model::Improved;

use super::attribution::{MOST, PARAMETERS, Subsets, brought};
use super::heldout::{beside_no_jump, predicted};

/// Root mean squares of one joint, or of all \[Nm\].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Budget {
    /// Joint, from 0; `None`: all, each in units of its measured torque \[1\].
    pub joint: Option<usize>,
    /// The gap of the model as it was, noise included.
    pub model: f64,
    /// What changed parameters take off.
    pub parameters: f64,
    /// What each effect takes off.
    pub effects: Vec<(&'static str, f64)>,
    /// What is left beyond noise.
    pub unexplained: f64,
    /// Noise.
    pub noise: f64,
}

/// Mean squares of a joint.
struct Squares {
    measured: f64,
    noise: f64,
    /// Missed by the models of all subsets.
    missed: Vec<f64>,
}

/// The budget of each joint, then of all.
#[must_use]
pub(in crate::gap) fn budget(
    records: &[Record<'_>],
    nominal: &Model,
    [refit, improved]: [&Improved; 2],
    ids: &[&'static str],
) -> Vec<Budget> {
    let mut players: Vec<&'static str> = ids.iter().copied().take(MOST).collect();
    players.push(PARAMETERS);
    let subsets = Subsets { nominal, refit, improved, players: &players };
    let models: Vec<Model> = (0..1 << players.len()).map(|set| subsets.of(set)).collect();
    let squares = squares(records, &models);
    let mut all: Vec<Budget> =
        squares.iter().enumerate().map(|(joint, of)| of.budget(Some(joint), &players)).collect();
    let used: Vec<&Squares> = squares.iter().filter(|of| of.measured > 0.0).collect();
    let mean = |of: &dyn Fn(&Squares) -> f64| {
        used.iter().map(|joint| of(joint) / joint.measured).sum::<f64>() / used.len().max(1) as f64
    };
    let whole = Squares {
        measured: 1.0,
        noise: mean(&|of| of.noise),
        missed: (0..models.len()).map(|set| mean(&|of| of.missed[set])).collect(),
    };
    all.push(whole.budget(None, &players));
    all
}

impl Squares {
    fn budget(&self, joint: Option<usize>, players: &[&'static str]) -> Budget {
        let sums: Vec<Vec<f64>> = self.missed.iter().map(|missed| vec![-missed]).collect();
        let taken = brought(&sums, players.len());
        // What makes the model worse at a joint takes nothing off: the others share what is.
        let positive: Vec<f64> = taken.iter().map(|of| of[0].max(0.0)).collect();
        let [model, left] =
            [self.missed.first(), self.missed.last()].map(|of| of.copied().unwrap_or(0.0));
        let off = (model - left).max(0.0);
        let scale = off / positive.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let rms = |player: usize| (positive[player] * scale).sqrt();
        let count = players.len() - 1;
        let rest = (model - off).max(0.0);
        let noise = self.noise.min(rest);
        Budget {
            joint,
            model: model.sqrt(),
            parameters: rms(count),
            effects: (0..count).map(|player| (players[player], rms(player))).collect(),
            unexplained: (rest - noise).sqrt(),
            noise: noise.sqrt(),
        }
    }
}

/// Mean squares by joint at the instants at which it moves.
fn squares(records: &[Record<'_>], models: &[Model]) -> Vec<Squares> {
    let n = models.first().map_or(0, |model| model.dof);
    let empty = || Squares { measured: 0.0, noise: 0.0, missed: vec![0.0; models.len()] };
    let mut sums: Vec<Squares> = (0..n).map(|_| empty()).collect();
    let mut counts = vec![0.0_f64; n];
    for record in records.iter().filter(|record| record.kind == RecordKind::Mean) {
        let is_known = beside_no_jump(record);
        let said: Vec<Vec<Vec<f64>>> =
            models.iter().map(|model| predicted(record, model)).collect();
        for (joint, (sum, count)) in sums.iter_mut().zip(&mut counts).enumerate() {
            let moves = |row: &usize| record.motion.qd[joint][*row].abs() > REST;
            for row in (0..record.motion.rows()).filter(|row| is_known[*row]).filter(moves) {
                let measured = record.measured[joint][row];
                *count += 1.0;
                sum.measured += measured * measured;
                sum.noise += record.scatter[joint][row];
                for (missed, said) in sum.missed.iter_mut().zip(&said) {
                    *missed += (measured - said[joint][row]).powi(2);
                }
            }
        }
    }
    for (sum, count) in sums.iter_mut().zip(counts) {
        let count = count.max(1.0);
        sum.measured /= count;
        sum.noise /= count;
        sum.missed.iter_mut().for_each(|missed| *missed /= count);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_add_up() {
        let of = Squares { measured: 100.0, noise: 0.04, missed: vec![9.0, 4.0, 6.0, 1.0] };
        let budget = of.budget(Some(0), &["a", PARAMETERS]);
        let effects: f64 = budget.effects.iter().map(|(_, x)| x * x).sum();
        let sum =
            effects + budget.parameters.powi(2) + budget.unexplained.powi(2) + budget.noise.powi(2);
        assert!((sum - 9.0).abs() < 1e-12 && (budget.model - 3.0).abs() < 1e-12);
        // Alone it takes off 5, behind the other one 5.
        assert!((effects - 5.0).abs() < 1e-12);
    }

    #[test]
    fn what_makes_worse_takes_nothing_off() {
        let of = Squares { measured: 100.0, noise: 0.0, missed: vec![4.0, 5.0, 1.0, 2.0] };
        let budget = of.budget(None, &["a", PARAMETERS]);
        assert!(budget.effects[0].1 == 0.0 && (budget.parameters.powi(2) - 2.0).abs() < 1e-12);
        assert!((budget.unexplained.powi(2) - 2.0).abs() < 1e-12);
    }
}

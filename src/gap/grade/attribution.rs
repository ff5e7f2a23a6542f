//! Whose the gap is: what each effect takes away of it, joint by joint and regime by regime.

use crate::arm::effects::{Effect, find};
use crate::arm::robot::Model;

use super::bins::{QUANTITIES, Quantity};
use super::heldout::predicted;
use super::pieces::{Pieces, difference};
use crate::gap::data::{Record, RecordKind};
use crate::gap::model::Improved;

/// Changed parameters of the model, as a player beside the effects.
pub const PARAMETERS: &str = "parameters";
/// Effects whose orders are all gone through.
pub(super) const MOST: usize = 5;

/// A joint's instants in a piece of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Joint, from 0.
    pub joint: usize,
    /// What the piece is of.
    pub quantity: Quantity,
    /// Its ends, SI.
    pub ends: [f64; 2],
    /// Share of the nominal model's squared gap that lies here; a quantity's cells add up to 1
    /// over all joints, each of which counts in units of its measured torque.
    pub gap: f64,
    /// How much of the squared gap each player takes away here, in the same unit; below 0 where it
    /// makes the model worse.
    pub taken: Vec<f64>,
}

impl Cell {
    /// In words.
    #[must_use]
    pub fn regime(&self) -> String {
        regime(self.quantity, self.ends)
    }
}

/// A piece of a quantity in words.
pub(super) fn regime(quantity: Quantity, [low, high]: [f64; 2]) -> String {
    format!("{} {low:.2} to {high:.2} {}", quantity.name(), quantity.unit())
}

/// The squared gap, shared out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attribution {
    /// What takes it away: effects by id, and [`PARAMETERS`].
    pub players: Vec<&'static str>,
    /// Where.
    pub cells: Vec<Cell>,
}

impl Attribution {
    /// Sums over the pieces of one quantity: what lies at a joint and what each player takes away.
    #[must_use]
    pub fn of_joint(&self, joint: usize) -> (f64, Vec<f64>) {
        let mut sum = (0.0, vec![0.0; self.players.len()]);
        let time = |cell: &&Cell| cell.joint == joint && cell.quantity == Quantity::Time;
        for cell in self.cells.iter().filter(time) {
            sum.0 += cell.gap;
            sum.1.iter_mut().zip(&cell.taken).for_each(|(sum, x)| *sum += x);
        }
        sum
    }
}

/// Shares out the squared gap of `nominal` in `records` over the effects `ids` of `improved` and
/// its other parameters: for each player the mean, over all orders in which they may be added,
/// of what it takes away when it comes (Shapley 1953). The shares add up to what all take away
/// together. Effects of the log (offsets, gains) act as one; of more than five effects none is
/// told.
#[must_use]
pub fn attribution(
    records: &[Record<'_>],
    nominal: &Model,
    [refit, improved]: [&Improved; 2],
    ids: &[&'static str],
) -> Attribution {
    let mut players: Vec<&'static str> = Vec::new();
    for id in ids {
        if !players.contains(id) {
            players.push(id);
        }
    }
    if players.len() > MOST {
        return Attribution::default();
    }
    players.push(PARAMETERS);
    let records: Vec<&Record<'_>> =
        records.iter().filter(|record| record.kind == RecordKind::Mean).collect();
    let pieces = Pieces::new(&records, nominal.dof);
    let models = Subsets { nominal, refit, improved, players: &players };
    let gap = |set: usize| {
        let model = models.of(set);
        pieces.squares(|record| difference(&record.measured, &predicted(record, &model)))
    };
    let gaps: Vec<Vec<f64>> = (0..1 << players.len()).map(gap).collect();
    let whole = (gaps[0].iter().sum::<f64>() / QUANTITIES.len() as f64).max(f64::MIN_POSITIVE);
    let brought = brought(&gaps, players.len());
    let cells = pieces.places.iter().enumerate().map(|(k, (joint, quantity, ends))| Cell {
        joint: *joint,
        quantity: *quantity,
        ends: *ends,
        gap: gaps[0][k] / whole,
        taken: brought.iter().map(|of| -of[k] / whole).collect(),
    });
    Attribution { cells: cells.collect(), players: players.clone() }
}

/// What each of `count` players brings to each of some sums, of which `sums` has the values for
/// every set of players: the mean over all orders in which they may come (Shapley 1953).
pub(super) fn brought(sums: &[Vec<f64>], count: usize) -> Vec<Vec<f64>> {
    let of = |player: usize| -> Vec<f64> {
        let without = || (0..sums.len()).filter(move |set| set & 1 << player == 0);
        let added = |set: usize, k: usize| sums[set | 1 << player][k] - sums[set][k];
        let mean = |k: usize| without().map(|set| weight(set, count) * added(set, k)).sum();
        (0..sums[0].len()).map(mean).collect()
    };
    (0..count).map(of).collect()
}

/// Share of the orders of `count` players in which just those of `set` come before one that is
/// not of it.
fn weight(set: usize, count: usize) -> f64 {
    let before = set.count_ones() as usize;
    let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
    factorial(before) * factorial(count - before - 1) / factorial(count)
}

/// Models with some of what was found.
pub(super) struct Subsets<'a> {
    pub(super) nominal: &'a Model,
    pub(super) refit: &'a Improved,
    pub(super) improved: &'a Improved,
    pub(super) players: &'a [&'static str],
}

impl Subsets<'_> {
    /// That with the players whose bits are set.
    pub(super) fn of(&self, set: usize) -> Model {
        let has = |player: usize| set & 1 << player != 0;
        let chosen: Vec<&str> = (0..self.players.len())
            .filter(|player| has(*player))
            .map(|player| self.players[player])
            .collect();
        let (nominal, improved) = (self.nominal, &self.improved.written);
        let mut model = if chosen.contains(&PARAMETERS) { improved } else { nominal }.clone();
        model.effects.clone_from(&self.nominal.effects);
        for given in &improved.effects {
            let id = given.id.as_str();
            let is_parameter = !self.players.contains(&id) && chosen.contains(&PARAMETERS);
            if is_parameter || chosen.contains(&id) {
                model.effects.retain(|of| of.id != given.id);
                model.effects.push(given.clone());
            }
        }
        let is_of_sensors = |id: &&str| find(id).is_some_and(Effect::is_of_sensors);
        let of_log = |ids: &[&str]| ids.iter().any(is_of_sensors);
        let with_parameters = chosen.contains(&PARAMETERS);
        model.sensors = if of_log(&chosen) || with_parameters && !of_log(self.players) {
            improved.sensors.clone()
        } else if with_parameters {
            self.refit.written.sensors.clone()
        } else {
            nominal.sensors.clone()
        };
        Improved::of(model).applied
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_counted() {
        for count in 1..=4 {
            let sum: f64 =
                (0..1 << count).filter(|set| set & 1 == 0).map(|set| weight(set, count)).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{count}: {sum}");
        }
    }
}

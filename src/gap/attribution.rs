//! Whose the gap is: what each effect takes away of it, joint by joint and regime by regime.

use crate::robot::Model;

use super::bins::{QUANTITIES, Quantity, ends, piece};
use super::heldout::predicted;
use super::improved::{Improved, OF_LOG};
use super::record::{Record, RecordKind};

/// Changed parameters of the model, as a player beside the effects.
pub const PARAMETERS: &str = "parameters";
/// Pieces of each quantity.
const PIECES: usize = 3;
/// Effects whose orders are all gone through.
const MOST: usize = 5;

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
        let ([low, high], quantity) = (self.ends, self.quantity);
        format!("{} {low:.2} to {high:.2} {}", quantity.name(), quantity.unit())
    }
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
    let gaps: Vec<Vec<f64>> =
        (0..1 << players.len()).map(|set| pieces.squares(&models.of(set))).collect();
    let whole: f64 = gaps[0].iter().sum::<f64>() / QUANTITIES.len() as f64;
    let cells = pieces.places.iter().enumerate().map(|(k, (joint, quantity, ends))| Cell {
        joint: *joint,
        quantity: *quantity,
        ends: *ends,
        gap: gaps[0][k] / whole.max(f64::MIN_POSITIVE),
        taken: (0..players.len())
            .map(|player| {
                let taken = |set: usize| gaps[set][k] - gaps[set | 1 << player][k];
                let without = (0..gaps.len()).filter(|set| set & 1 << player == 0);
                let sum: f64 = without.map(|set| weight(set, players.len()) * taken(set)).sum();
                sum / whole.max(f64::MIN_POSITIVE)
            })
            .collect(),
    });
    Attribution { cells: cells.collect(), players: players.clone() }
}

/// Share of the orders of `count` players in which just those of `set` come before one that is
/// not of it.
fn weight(set: usize, count: usize) -> f64 {
    let before = set.count_ones() as usize;
    let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
    factorial(before) * factorial(count - before - 1) / factorial(count)
}

/// Models with some of what was found.
struct Subsets<'a> {
    nominal: &'a Model,
    refit: &'a Improved,
    improved: &'a Improved,
    players: &'a [&'static str],
}

impl Subsets<'_> {
    fn of(&self, set: usize) -> Model {
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
        let of_log = |ids: &[&str]| ids.iter().any(|id| OF_LOG.contains(id));
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

/// The instants at which joints move, in pieces.
struct Pieces<'a> {
    records: &'a [&'a Record<'a>],
    /// One over the sum of squares of each joint's measured torque \[1/(N²m²)\].
    scale: Vec<f64>,
    places: Vec<(usize, Quantity, [f64; 2])>,
    /// By joint and quantity.
    ends: Vec<Vec<Vec<f64>>>,
}

impl<'a> Pieces<'a> {
    fn new(records: &'a [&'a Record<'a>], dof: usize) -> Pieces<'a> {
        let rows = |joint: usize| {
            records.iter().flat_map(move |record| {
                let moves = move |row: &usize| record.moves(joint, *row);
                (0..record.motion.len()).filter(moves).map(move |row| (*record, row))
            })
        };
        let mut pieces =
            Pieces { records, scale: Vec::new(), places: Vec::new(), ends: Vec::new() };
        for joint in 0..dof {
            let squares: f64 =
                rows(joint).map(|(record, row)| record.measured[joint][row].powi(2)).sum();
            pieces.scale.push(if squares > 0.0 { 1.0 / squares } else { 0.0 });
            let mut of_joint = Vec::new();
            for quantity in QUANTITIES {
                let values = rows(joint).map(|(record, row)| quantity.at(record, joint, row));
                let ends = ends(values.collect(), PIECES);
                let each = ends.windows(2).map(|ends| (joint, quantity, [ends[0], ends[1]]));
                pieces.places.extend(each);
                of_joint.push(ends);
            }
            pieces.ends.push(of_joint);
        }
        pieces
    }

    /// Squares of what a model misses, place by place, in units of the torques.
    fn squares(&self, model: &Model) -> Vec<f64> {
        let mut sums = vec![0.0; self.places.len()];
        for record in self.records {
            let said = predicted(record, model);
            let mut first = 0;
            for (joint, of_joint) in self.ends.iter().enumerate() {
                for (quantity, ends) in QUANTITIES.iter().zip(of_joint) {
                    for row in 0..record.motion.len() {
                        if record.moves(joint, row) {
                            let missed = record.measured[joint][row] - said[joint][row];
                            let at = piece(ends, quantity.at(record, joint, row));
                            sums[first + at] += self.scale[joint] * missed * missed;
                        }
                    }
                    first += ends.len().saturating_sub(1);
                }
            }
        }
        sums
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

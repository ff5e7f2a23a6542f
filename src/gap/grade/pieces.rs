//! Where and when joints move: the instants of records in pieces.

use super::bins::{QUANTITIES, Quantity, ends, piece};
use crate::gap::data::Record;

/// Pieces of each quantity.
const PIECES: usize = 3;

/// The instants at which joints move, in pieces of each quantity.
pub(super) struct Pieces<'a> {
    records: &'a [&'a Record<'a>],
    /// One over the sum of squares of each joint's measured torque \[1/(N²m²)\].
    scale: Vec<f64>,
    /// Joint, quantity and ends of each piece.
    pub(super) places: Vec<(usize, Quantity, [f64; 2])>,
    /// By joint and quantity.
    ends: Vec<Vec<Vec<f64>>>,
}

impl<'a> Pieces<'a> {
    /// Those of a robot with `dof` joints.
    pub(super) fn new(records: &'a [&'a Record<'a>], dof: usize) -> Pieces<'a> {
        let rows = |joint: usize| {
            records.iter().flat_map(move |record| {
                let moves = move |row: &usize| record.moves(joint, *row);
                (0..record.motion.rows()).filter(moves).map(move |row| (*record, row))
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

    /// Squares of torques of each record, by joint and row, place by place, in units of what was
    /// measured at the joint.
    pub(super) fn squares(&self, torques: impl Fn(&Record<'_>) -> Vec<Vec<f64>>) -> Vec<f64> {
        let mut sums = vec![0.0; self.places.len()];
        for record in self.records {
            let torques = torques(record);
            let mut first = 0;
            for (joint, of_joint) in self.ends.iter().enumerate() {
                for (quantity, ends) in QUANTITIES.iter().zip(of_joint) {
                    for (row, torque) in torques[joint].iter().enumerate() {
                        if record.moves(joint, row) {
                            let at = piece(ends, quantity.at(record, joint, row));
                            sums[first + at] += self.scale[joint] * torque * torque;
                        }
                    }
                    first += ends.len().saturating_sub(1);
                }
            }
        }
        sums
    }
}

/// The difference of torques, by joint and row.
pub(super) fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let of = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| a - b).collect();
    a.iter().zip(b).map(of).collect()
}

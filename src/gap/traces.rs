//! What a page shows of a diagnosis: measured torques, what models miss, shapes of effects.

use crate::robot::{Given, Model};

use super::bins::{QUANTITIES, Quantity, ends, piece};
use super::diagnosis::{Estimated, Said};
use super::heldout::predicted;
use super::improved::Improved;
use super::record::{Record, RecordKind};

/// Points of a mean over a quantity.
const POINTS: usize = 24;

/// Torques of a log by joint and instant; not a number where a joint rests.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// Times since the motion began \[s\].
    pub t: Vec<f64>,
    /// Measured \[Nm\].
    pub measured: Vec<Vec<f64>>,
    /// Measured less said, by model and joint \[Nm\].
    pub missed: Vec<Vec<Vec<f64>>>,
}

/// A mean over a quantity: middle of each piece, mean, half of the band of 95 %.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Over what.
    pub quantity: Quantity,
    /// Middle of the piece, mean, half of the band; SI.
    pub points: Vec<[f64; 3]>,
}

/// What an effect adds to the torque of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The effect's id.
    pub id: &'static str,
    /// Joint, from 0.
    pub joint: usize,
    /// Its torque over what tells most of it \[Nm\].
    pub profile: Profile,
}

/// What models miss of the longest record of a mean motion.
#[must_use]
pub fn trace(records: &[Record<'_>], models: &[&Model]) -> Option<Trace> {
    let means = records.iter().filter(|record| record.kind == RecordKind::Mean);
    let record = means.max_by_key(|record| record.motion.len())?;
    let n = record.measured.len();
    let of = |values: &dyn Fn(usize, usize) -> f64| -> Vec<Vec<f64>> {
        let at = |joint: usize, row: usize| {
            if record.moves(joint, row) { values(joint, row) } else { f64::NAN }
        };
        (0..n).map(|joint| (0..record.motion.len()).map(|row| at(joint, row)).collect()).collect()
    };
    let missed = models.iter().map(|model| {
        let said = predicted(record, model);
        of(&|joint, row| record.measured[joint][row] - said[joint][row])
    });
    Some(Trace {
        t: record.motion.t.clone(),
        missed: missed.collect(),
        measured: of(&|joint, row| record.measured[joint][row]),
    })
}

/// Means of what a model misses at a joint, over a quantity; the band is that of the mean of
/// independent instants.
#[must_use]
pub fn profile(records: &[Record<'_>], model: &Model, joint: usize, quantity: Quantity) -> Profile {
    let samples = samples(records, joint, quantity, &|record| {
        let said = predicted(record, model);
        record.measured[joint].iter().zip(&said[joint]).map(|(a, b)| a - b).collect()
    });
    Profile { quantity, points: binned(&samples).0 }
}

/// The torque that an effect adds at each of its joints, over the quantity that tells most of it,
/// with what the deviations of its parameters make of it. None of effects that are numbers of the
/// log (offsets, gains).
#[must_use]
pub fn shapes(records: &[Record<'_>], improved: &Improved, said: &Said) -> Vec<Shape> {
    let id = said.effect.id;
    let mut without = improved.written.clone();
    without.effects.retain(|given| given.id != id);
    if without.effects.len() == improved.written.effects.len() {
        return Vec::new();
    }
    let without = Improved::of(without).applied;
    let others: Vec<Model> =
        said.parameters.iter().filter_map(|of| moved(improved, said, of)).collect();
    let joints =
        if said.joints.is_empty() { (0..without.dof).collect() } else { said.joints.clone() };
    let added = |joint: usize, quantity: Quantity, [with, bare]: [&Model; 2]| {
        samples(records, joint, quantity, &|record| {
            let [a, b] = [predicted(record, with), predicted(record, bare)];
            a[joint].iter().zip(&b[joint]).map(|(a, b)| a - b).collect()
        })
    };
    joints
        .into_iter()
        .filter_map(|joint| {
            let told = QUANTITIES.map(|quantity| {
                let (points, left) = binned(&added(joint, quantity, [&improved.applied, &without]));
                (Profile { quantity, points }, left)
            });
            let (mut profile, _) = told.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
            let mut squares = vec![0.0; profile.points.len()];
            for other in &others {
                let moved = added(joint, profile.quantity, [other, &improved.applied]);
                for (sum, point) in squares.iter_mut().zip(binned(&moved).0) {
                    *sum += point[1] * point[1];
                }
            }
            for (point, square) in profile.points.iter_mut().zip(squares) {
                point[2] = INTERVAL * f64::sqrt(square);
            }
            profile.points.iter().any(|point| point[1] != 0.0).then_some(Shape {
                id,
                joint,
                profile,
            })
        })
        .collect()
}

/// Deviations to each side that hold 95 %.
const INTERVAL: f64 = 1.96;

/// The model with a parameter of an effect moved by its deviation.
fn moved(improved: &Improved, said: &Said, of: &Estimated) -> Option<Model> {
    let mut written = improved.written.clone();
    let given = written.effects.iter_mut().find(|given| given.id == said.effect.id)?;
    let (name, joint) = match of.name.rsplit_once("_j") {
        Some((name, joint)) if given.values.iter().any(|(known, _)| known == name) => {
            (name, joint.parse::<usize>().ok()?.checked_sub(1))
        }
        _ => (of.name.as_str(), said.joints.first().copied()),
    };
    let (_, value) = given.values.iter_mut().find(|(known, _)| known == name)?;
    match value {
        Given::Robot(value) => *value += of.sd,
        Given::Joints(values) => *values.get_mut(joint?)? += of.sd,
    }
    Some(Improved::of(written).applied)
}

/// Pairs of a quantity and a value at the instants at which a joint moves.
fn samples(
    records: &[Record<'_>],
    joint: usize,
    quantity: Quantity,
    values: &dyn Fn(&Record<'_>) -> Vec<f64>,
) -> Vec<[f64; 2]> {
    let mut all = Vec::new();
    for record in records.iter().filter(|record| record.kind == RecordKind::Mean) {
        for (row, value) in values(record).into_iter().enumerate() {
            if record.moves(joint, row) {
                all.push([quantity.at(record, joint, row), value]);
            }
        }
    }
    all
}

/// Means over pieces, and the squares that they leave.
fn binned(samples: &[[f64; 2]]) -> (Vec<[f64; 3]>, f64) {
    let ends = ends(samples.iter().map(|sample| sample[0]).collect(), POINTS);
    let mut sums = vec![[0.0; 4]; ends.len().saturating_sub(1)];
    for [x, y] in samples {
        if let Some(sum) = sums.get_mut(piece(&ends, *x)) {
            for (sum, more) in sum.iter_mut().zip([1.0, *x, *y, y * y]) {
                *sum += more;
            }
        }
    }
    let mut left = 0.0;
    let points = sums
        .iter()
        .filter(|sum| sum[0] > 0.0)
        .map(|[count, x, y, squares]| {
            let mean = y / count;
            let over = (squares - y * mean).max(0.0);
            left += over;
            [x / count, mean, INTERVAL * (over / count / count).sqrt()]
        })
        .collect();
    (points, left)
}

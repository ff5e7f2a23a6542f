//! What a page shows of a diagnosis: measured torques, what models miss, shapes of effects.

use crate::arm::robot::{Given, Model};

use super::bins::{QUANTITIES, Quantity, ends, piece};
use super::heldout::predicted;
use super::pieces::difference;
use crate::gap::data::{Record, RecordKind};
use crate::gap::decision::{Estimated, Finding};
use crate::gap::model::Improved;

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

/// Torques at the instants of records, by record, joint and row \[Nm\].
pub type Torques = Vec<Vec<Vec<f64>>>;

/// What a model misses in records: measured less said.
#[must_use]
pub fn missed(records: &[Record<'_>], model: &Model) -> Torques {
    let of = |record: &Record<'_>| difference(&record.measured, &predicted(record, model));
    records.iter().map(of).collect()
}

/// What models miss of the longest record of a mean motion.
#[must_use]
pub fn trace(records: &[Record<'_>], missed: &[Torques]) -> Option<Trace> {
    let means = records.iter().enumerate().filter(|(_, of)| of.kind == RecordKind::Mean);
    let (number, record) = means.max_by_key(|(_, record)| record.motion.rows())?;
    let shown = |torques: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let at = |joint: usize, (row, x): (usize, &f64)| {
            if record.moves(joint, row) { *x } else { f64::NAN }
        };
        let of = |(joint, series): (usize, &Vec<f64>)| {
            series.iter().enumerate().map(|of| at(joint, of)).collect()
        };
        torques.iter().enumerate().map(of).collect()
    };
    Some(Trace {
        t: record.motion.t.clone(),
        measured: shown(&record.measured),
        missed: missed.iter().map(|of| shown(&of[number])).collect(),
    })
}

/// Means of torques of a joint over a quantity; the band is that of the mean of independent
/// instants.
#[must_use]
pub fn profile(
    records: &[Record<'_>],
    torques: &Torques,
    joint: usize,
    quantity: Quantity,
) -> Profile {
    Profile { quantity, points: binned(&samples(records, torques, joint, quantity)).0 }
}

/// The torque that an effect adds at each of its joints, over the quantity that tells most of it,
/// with what the deviations of its parameters make of it. None of effects that are numbers of the
/// log (offsets, gains).
#[must_use]
pub fn shapes(records: &[Record<'_>], improved: &Improved, said: &Finding) -> Vec<Shape> {
    let id = said.effect.id;
    let mut without = improved.written.clone();
    without.effects.retain(|given| given.id != id);
    if without.effects.len() == improved.written.effects.len() {
        return Vec::new();
    }
    let without = Improved::of(without).applied;
    let between = |with: &Model, bare: &Model| -> Torques {
        let of =
            |record: &Record<'_>| difference(&predicted(record, with), &predicted(record, bare));
        records.iter().map(of).collect()
    };
    let added = between(&improved.applied, &without);
    let moved: Vec<Torques> = said
        .parameters
        .iter()
        .filter_map(|of| moved(improved, said, of))
        .map(|other| between(&other, &improved.applied))
        .collect();
    let joints =
        if said.joints.is_empty() { (0..without.dof).collect() } else { said.joints.clone() };
    let shape = |joint: usize| -> Option<Shape> {
        let told = QUANTITIES.map(|quantity| {
            let (points, left) = binned(&samples(records, &added, joint, quantity));
            (Profile { quantity, points }, left)
        });
        let (mut profile, _) = told.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let mut squares = vec![0.0; profile.points.len()];
        for moved in &moved {
            let (points, _) = binned(&samples(records, moved, joint, profile.quantity));
            for (sum, point) in squares.iter_mut().zip(points) {
                *sum += point[1] * point[1];
            }
        }
        for (point, square) in profile.points.iter_mut().zip(squares) {
            point[2] = INTERVAL * f64::sqrt(square);
        }
        let is_there = profile.points.iter().any(|point| point[1] != 0.0);
        is_there.then_some(Shape { id, joint, profile })
    };
    joints.into_iter().filter_map(shape).collect()
}

/// Deviations to each side that hold 95 %.
const INTERVAL: f64 = 1.96;

/// The model with a parameter of an effect moved by its deviation.
fn moved(improved: &Improved, said: &Finding, of: &Estimated) -> Option<Model> {
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

/// Pairs of a quantity and a torque at the instants at which a joint moves.
fn samples(
    records: &[Record<'_>],
    torques: &Torques,
    joint: usize,
    quantity: Quantity,
) -> Vec<[f64; 2]> {
    let mut all = Vec::new();
    for (record, torques) in records.iter().zip(torques) {
        if record.kind != RecordKind::Mean {
            continue;
        }
        for (row, torque) in torques[joint].iter().enumerate() {
            if record.moves(joint, row) {
                all.push([quantity.at(record, joint, row), *torque]);
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

//! How large the gap is in data that took no part, before and after.

use crate::arm::dynamics::Load;
use crate::arm::effects::{Acts, Effect, Motion, find, of_the_whole_motion};
use crate::arm::robot::Model;

use super::interval::{Interval, growth, interval};
use crate::gap::data::{REST, Record, RecordKind};

/// Blocks into which a motion is cut for intervals: as long as what a model misses in it remembers.
const BLOCKS: usize = 5;
/// Draws of blocks.
const DRAWS: usize = 400;
/// Change of an acceleration from row to row, of its largest value, that is a jump.
const JUMP: f64 = 0.25;
/// Rows before and after a jump of which nobody can say on which side they are.
const BESIDE: usize = 2;

/// Rms torques of a joint that a model misses, less the noise \[Nm\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointGap {
    /// Of the noise of the mean of the repetitions, which is taken off.
    pub noise: f64,
    /// Of the measured torque itself.
    pub torque: f64,
    /// Missed by the nominal model.
    pub model: f64,
    /// By the model with other parameters.
    pub refit: f64,
    /// By that with the effects.
    pub refit_plus_effect: f64,
    /// Deviations over draws of blocks by which the effects let the gap grow \[1\].
    pub growth: f64,
}

/// The gap, joint by joint, and how far it shrinks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shrink {
    /// By joint.
    pub joints: Vec<JointGap>,
    /// Of refit and effects.
    pub total: Interval,
    /// Of the effects alone.
    pub by_effect: Interval,
    /// Deviations over draws of blocks by which the effects let the gap of all grow \[1\].
    pub growth: f64,
    /// By block of the motions, by joint.
    pub blocks: Vec<Vec<JointGap>>,
}

/// Sums of squares of a joint in a block: measured, missed by each of three models; noise; rows.
type Sums = [f64; 6];

/// The gap of three models in some records.
#[must_use]
pub fn shrink(records: &[Record<'_>], models: [&Model; 3]) -> Shrink {
    let n = models[0].dof;
    let mut blocks: Vec<Vec<Sums>> = Vec::new();
    for record in records.iter().filter(|record| record.kind == RecordKind::Mean) {
        let predicted = models.map(|model| predicted(record, model));
        let is_known = beside_no_jump(record);
        let rows = record.motion.rows();
        for block in 0..BLOCKS {
            let (from, to) = (rows * block / BLOCKS, rows * (block + 1) / BLOCKS);
            let used: Vec<usize> = (from..to).filter(|row| is_known[*row]).collect();
            blocks.push((0..n).map(|joint| sums(record, &predicted, joint, &used)).collect());
        }
    }
    let all: Vec<usize> = (0..blocks.len()).collect();
    let mut joints = pooled(&blocks, &all, n);
    let of = |joints: &[JointGap]| [shrunk(joints, |of| of.model), shrunk(joints, |of| of.refit)];
    let [total, by_effect] = of(&joints);
    let mut random = fastrand::Rng::with_seed(1);
    let mut drawn: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
    let mut of_joints: Vec<Vec<f64>> = vec![Vec::new(); n];
    for _ in 0..DRAWS {
        let draw: Vec<usize> =
            (0..blocks.len()).map(|_| random.usize(0..blocks.len().max(1))).collect();
        let drawn_joints = pooled(&blocks, &draw, n);
        for (to, value) in drawn.iter_mut().zip(of(&drawn_joints)) {
            to.push(value);
        }
        for (to, joint) in of_joints.iter_mut().zip(&drawn_joints) {
            to.push(shrunk(std::slice::from_ref(joint), |of| of.refit));
        }
    }
    for (joint, drawn) in joints.iter_mut().zip(&of_joints) {
        let own = shrunk(std::slice::from_ref(joint), |of| of.refit);
        joint.growth = growth(own, drawn, blocks.len());
    }
    Shrink {
        joints,
        total: interval(total, &drawn[0], blocks.len()),
        by_effect: interval(by_effect, &drawn[1], blocks.len()),
        growth: growth(by_effect, &drawn[1], blocks.len()),
        blocks: all.iter().map(|block| pooled(&blocks, &[*block], n)).collect(),
    }
}

/// The torques that a log of the record's motion would show by a model.
#[must_use]
pub fn predicted(record: &Record<'_>, model: &Model) -> Vec<Vec<f64>> {
    let of = &record.motion;
    let rest: Vec<f64> = vec![0.0; model.dof];
    let series = [of.q.clone(), of.qd.clone(), of.qdd.clone()];
    let mut sum = vec![vec![0.0; of.rows()]; model.dof];
    // Only warming up differs from repetition to repetition.
    let at = |later: f64| {
        let t = of.t.iter().map(|t| t + later).collect();
        let motion = Motion::new(model, t, series.clone(), &rest, of.closed);
        let mut torques = motion.torques_of(model, &Load::none());
        for (to, added) in torques.iter_mut().zip(of_the_whole_motion(&motion)) {
            to.iter_mut().zip(added).for_each(|(to, x)| *to += x);
        }
        torques
    };
    let is_over_time = |of: &&Effect| of.acts == Acts::OverTime;
    let listed = model.effects.iter().filter_map(|of| find(&of.id));
    let warms = listed.filter(is_over_time).count() > 0;
    let times = if warms { record.times.clone() } else { vec![(0.0, 1.0)] };
    for (later, weight) in times {
        for (sum, torque) in sum.iter_mut().zip(at(later)) {
            sum.iter_mut().zip(torque).for_each(|(sum, x)| *sum += weight * x);
        }
    }
    sum
}

/// Rows of repeated positions beside which no joint's acceleration jumps: where it does, they do
/// not tell it, and torques belong to either side.
#[must_use]
pub fn beside_no_jump(record: &Record<'_>) -> Vec<bool> {
    let count = record.motion.rows();
    let mut is_known = vec![true; count];
    if !record.motion.closed {
        return is_known;
    }
    for x in &record.motion.qdd {
        let largest = x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for row in 0..count {
            let next = (row + 1) % count;
            if (x[next] - x[row]).abs() > JUMP * largest {
                for other in 0..2 * BESIDE {
                    is_known[(row + count + 1 + other - BESIDE) % count] = false;
                }
            }
        }
    }
    is_known
}

fn sums(record: &Record<'_>, predicted: &[Vec<Vec<f64>>; 3], joint: usize, rows: &[usize]) -> Sums {
    let mut sums = [0.0; 6];
    for row in rows.iter().copied() {
        if record.motion.qd[joint][row].abs() <= REST {
            continue;
        }
        let measured = record.measured[joint][row];
        sums[0] += measured * measured;
        for (k, of) in predicted.iter().enumerate() {
            sums[1 + k] += (measured - of[joint][row]).powi(2);
        }
        sums[4] += record.scatter[joint][row];
        sums[5] += 1.0;
    }
    sums
}

fn pooled(blocks: &[Vec<Sums>], chosen: &[usize], n: usize) -> Vec<JointGap> {
    (0..n)
        .map(|joint| {
            let mut sum = [0.0; 6];
            for block in chosen {
                for (sum, x) in sum.iter_mut().zip(blocks[*block][joint]) {
                    *sum += x;
                }
            }
            let rows = sum[5].max(1.0);
            let rms = |k: usize| ((sum[k] - sum[4]) / rows).max(0.0).sqrt();
            JointGap {
                noise: (sum[4] / rows).sqrt(),
                torque: (sum[0] / rows).sqrt(),
                model: rms(1),
                refit: rms(2),
                refit_plus_effect: rms(3),
                growth: 0.0,
            }
        })
        .collect()
}

/// By how much the gap is smaller after than before; joints count alike after division by their
/// torques.
fn shrunk(joints: &[JointGap], before: impl Fn(&JointGap) -> f64) -> f64 {
    let (mut first, mut last) = (0.0, 0.0);
    for joint in joints.iter().filter(|joint| joint.torque > 0.0) {
        first += (before(joint) / joint.torque).powi(2);
        last += (joint.refit_plus_effect / joint.torque).powi(2);
    }
    if first > 0.0 { 1.0 - (last / first).sqrt() } else { 0.0 }
}

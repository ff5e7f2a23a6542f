//! How large an effect is in the logs.

use crate::arm::effects::Effect;
use crate::arm::robot::MAX_DOF;

use super::fitted::Fitted;
use super::record::{Record, RecordKind};
use super::search::Search;

/// Friction that fades by less of itself is any robot's: it differs from hour to hour.
const FADES: f64 = 0.1;
/// Ripple that any motor may have, of the noise.
const BELOW_NOISE: f64 = 0.25;

/// Whether a joint rubs clearly more when the logs begin than when they end.
pub(super) fn fades(search: &Search<'_, '_>, of: &Fitted) -> bool {
    let (Some(joint), Some(record)) = (of.joint, search.records.first()) else { return false };
    let scale = record.motion.scale(joint);
    let [first, last] = times(search);
    // What would fade later is not seen.
    let left = |t: f64| (-t / of.parameters[2].max(1e-9)).exp();
    let seen = left(first) - left(last);
    let [coulomb, viscous] =
        [of.parameters[0] / scale.coulomb, of.parameters[1] / scale.viscous].map(|x| x * seen);
    coulomb.max(viscous) > FADES && coulomb + viscous > 0.0
}

/// Times of the first and the last repetition, by the clock of the logs \[s\].
fn times(search: &Search<'_, '_>) -> [f64; 2] {
    // A baseline has its own clock.
    let now = search.records.iter().filter(|record| record.kind != RecordKind::Before);
    let times = now.flat_map(|record| record.times.iter().map(|(t, _)| *t));
    times.fold([f64::INFINITY, f64::NEG_INFINITY], |[first, last], t| [first.min(t), last.max(t)])
}

/// Ripple of a joint that nobody asks for \[Nm\].
pub(super) fn noise(search: &Search<'_, '_>, joint: Option<usize>) -> f64 {
    let of = |record: &Record<'_>| {
        let variance = record.variance[joint.unwrap_or(0)];
        variance * if record.kind == RecordKind::Drift { 1.0 } else { record.repetitions as f64 }
    };
    BELOW_NOISE * search.records.iter().map(of).fold(0.0, f64::max).sqrt()
}

/// The largest share that an effect has in the torques of a joint.
pub(super) fn size(search: &Search<'_, '_>, effect: &Effect, fitted: &[&Fitted]) -> f64 {
    let [squares, all, _] = squares(search, effect, fitted);
    squares.iter().zip(&all).map(|(x, all)| (x / all.max(1e-12)).sqrt()).fold(0.0, f64::max)
}

/// The largest rms of an effect at a joint, over what is missed there.
pub(super) fn beside_missed(search: &Search<'_, '_>, effect: &Effect, fitted: &[&Fitted]) -> f64 {
    let [squares, _, rows] = squares(search, effect, fitted);
    (0..search.dof())
        .map(|joint| {
            (squares[joint] / rows[joint].max(1.0)).sqrt() / search.missed(joint).max(1e-12)
        })
        .fold(0.0, f64::max)
}

/// By joint, sums of squares of an effect and of the torques, and the number of rows.
fn squares(search: &Search<'_, '_>, effect: &Effect, fitted: &[&Fitted]) -> [Vec<f64>; 3] {
    let mut sums = [vec![0.0; MAX_DOF], vec![0.0; MAX_DOF], vec![0.0; MAX_DOF]];
    let mean = |record: &&Record<'_>| record.kind == RecordKind::Mean;
    for record in search.records.iter().filter(mean) {
        let motion = &record.motion;
        for of in fitted {
            let joint = of
                .joint
                .unwrap_or_else(|| (effect.joints)(motion.model.dof).first().copied().unwrap_or(0));
            for (to, series) in shown(search, effect, record, joint, &of.coordinates) {
                sums[0][to] += series.iter().map(|x| x * x).sum::<f64>();
            }
        }
        for joint in 0..motion.model.dof {
            sums[1][joint] += record.measured[joint].iter().map(|x| x * x).sum::<f64>();
            sums[2][joint] += motion.rows() as f64;
        }
    }
    sums
}

/// The largest share of the torque of an effect's joints that the model misses.
pub(super) fn missed(search: &Search<'_, '_>, fitted: &[&Fitted]) -> f64 {
    let (mut squares, mut all) = (vec![0.0; MAX_DOF], vec![1e-12; MAX_DOF]);
    for record in search.records.iter().filter(|record| record.kind == RecordKind::Mean) {
        for joint in 0..record.motion.model.dof {
            for (x, y) in record.measured[joint].iter().zip(&record.motion.torque[joint]) {
                squares[joint] += (x - y).powi(2);
                all[joint] += x * x;
            }
        }
    }
    let asked = |joint: &usize| {
        fitted.iter().all(|of| {
            of.joint.is_none_or(|own| own == *joint || own == 5 && *joint == 4) || fitted.len() > 1
        })
    };
    (0..MAX_DOF).filter(asked).map(|joint| (squares[joint] / all[joint]).sqrt()).fold(0.0, f64::max)
}

/// What an effect adds to a motion; of what fades, only what has faded over all logs counts.
fn shown(
    search: &Search<'_, '_>,
    effect: &Effect,
    record: &Record<'_>,
    joint: usize,
    coordinates: &[f64],
) -> Vec<(usize, Vec<f64>)> {
    if effect.id != "warm_up" {
        return effect.added(&record.motion, joint, coordinates);
    }
    let [first, last] = times(search);
    let at = |later: f64| {
        let mut moved = record.motion.clone();
        moved.t.iter_mut().for_each(|t| *t += later);
        effect.added(&moved, joint, coordinates)
    };
    at(first)
        .into_iter()
        .zip(at(last))
        .map(|((joint, a), (_, b))| (joint, a.iter().zip(&b).map(|(a, b)| a - b).collect()))
        .collect()
}

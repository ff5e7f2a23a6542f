//! Orders of ripple that a joint's torques may have.

use crate::arm::effects::{Effect, Role};

use super::column::{Owner, Piece, columns_at};
use super::record::{Record, RecordKind};

/// Least and largest order that is looked for.
const ORDERS: [f64; 2] = [5.0, 600.0];
/// Step of the orders, over the one at which waves of neighbours part over the range.
const STEP: f64 = 0.25;
/// The best orders, each so far from the others, become pieces.
const BEST: usize = 3;
/// Neighbours over which the slow part is averaged.
const SLOW: usize = 6;
/// Waves have to be sampled so often per turn \[rad between rows\].
const FASTEST: f64 = 2.5;

/// Pieces of ripple at a joint: the orders of its motor, and those that the difference has.
pub(super) fn ripples(effect: &'static Effect, records: &[Record<'_>], joint: usize) -> Vec<Piece> {
    let Some(first) = records.first() else { return Vec::new() };
    let scale = first.motion.scale(joint);
    let usual = |k: usize| (effect.coordinates[k].usual)(&scale);
    let (found, looked) = found(records, joint, scale.rate * scale.step);
    let mut orders: Vec<(f64, usize)> = match effect.coordinates[2].role {
        Role::Choice(values) => {
            let values = values(&scale);
            let count = values.len();
            values.into_iter().map(|order| (order, count)).collect()
        }
        Role::Linear | Role::Shape(_) => Vec::new(),
    };
    orders.extend(found.into_iter().map(|order| (order, looked)));
    orders
        .into_iter()
        .map(|(order, choices)| {
            let shape = vec![usual(0), usual(1), order];
            let columns = columns_at(effect, records, joint, &shape);
            Piece { owner: Owner::Effect(effect), joint: Some(joint), shape, choices, columns }
        })
        .collect()
}

/// The orders whose waves the fast part of the difference has most of, and how many were
/// looked at.
fn found(records: &[Record<'_>], joint: usize, turned: f64) -> (Vec<f64>, usize) {
    let mut rows: Vec<(f64, f64)> = Vec::new();
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for record in records.iter().filter(|record| record.kind == RecordKind::Mean) {
        let motion = &record.motion;
        let n = motion.rows();
        let missed: Vec<f64> = record.measured[joint]
            .iter()
            .zip(&motion.torque[joint])
            .map(|(measured, torque)| measured - torque)
            .collect();
        let still = |i: usize| record.window[joint][i] == 0.0;
        for i in SLOW..n.saturating_sub(SLOW) {
            let around = i - SLOW..=i + SLOW;
            // A friction that turns is no wave.
            if around.clone().any(still) {
                continue;
            }
            let mean = missed[around].iter().sum::<f64>() / (2 * SLOW + 1) as f64;
            let q = motion.q[joint][i];
            (low, high) = (low.min(q), high.max(q));
            rows.push((q, missed[i] - mean));
        }
    }
    let range = high - low;
    let most = ORDERS[1].min(FASTEST / turned.max(1e-9));
    if rows.is_empty() || range <= 0.0 || most <= ORDERS[0] {
        return (Vec::new(), 1);
    }
    let step = STEP * std::f64::consts::TAU / range;
    let step = step.max((most - ORDERS[0]) / 4000.0);
    let count = ((most - ORDERS[0]) / step) as usize + 1;
    let power = |order: f64| {
        let (mut c, mut s) = (0.0, 0.0);
        for (q, x) in &rows {
            let (sin, cos) = (order * q).sin_cos();
            c += x * cos;
            s += x * sin;
        }
        c * c + s * s
    };
    let mut powers: Vec<(f64, f64)> =
        (0..count).map(|k| ORDERS[0] + step * k as f64).map(|k| (power(k), k)).collect();
    powers.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut best: Vec<f64> = Vec::new();
    for (_, order) in powers {
        if best.len() == BEST {
            break;
        }
        if best.iter().all(|other| (other - order).abs() > 3.0 * step) {
            best.push(finer(order, step, &power));
        }
    }
    (best, count)
}

/// The best order nearby.
fn finer(order: f64, step: f64, power: &dyn Fn(f64) -> f64) -> f64 {
    let (mut best, mut reach) = (order, 0.5 * step);
    for _ in 0..6 {
        let tried = [best - reach, best, best + reach];
        best = tried.into_iter().max_by(|a, b| power(*a).total_cmp(&power(*b))).unwrap_or(best);
        reach *= 0.5;
    }
    best
}

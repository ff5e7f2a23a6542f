//! Torques that are a multiple of the model's at every joint: another unit, another robot.

use super::record::{Record, RecordKind};
use crate::gap::trust::Trust;

/// Correlation with the model's torque from which on a joint's factor is one.
const LIKE: f64 = 0.9;
/// How far the factors of the joints may be apart, of their median.
const APART: f64 = 0.25;

/// How many times the model's torques the measured ones are, where it is the same at all joints
/// and farther from once than the model's masses may be: no effect can be told then.
#[must_use]
pub fn common_factor(records: &[Record<'_>], trust: Trust) -> Option<f64> {
    let believed = match trust {
        Trust::Commissioned => 1.25,
        Trust::Cad => 1.8,
        Trust::Unknown => return None,
    };
    let dof = records.first().map_or(0, |record| record.motion.model.dof);
    let mut factors = Vec::new();
    for joint in 0..dof {
        let (mut product, mut model, mut measured) = (0.0, 0.0, 0.0);
        for record in records.iter().filter(|record| record.kind == RecordKind::Mean) {
            for (x, y) in record.measured[joint].iter().zip(&record.motion.torque[joint]) {
                product += x * y;
                measured += x * x;
                model += y * y;
            }
        }
        if measured <= 0.0 || model <= 0.0 || product / (measured * model).sqrt() < LIKE {
            return None;
        }
        factors.push(product / model);
    }
    factors.sort_by(f64::total_cmp);
    let median = *factors.get(factors.len() / 2)?;
    let same = factors.iter().all(|factor| (factor / median - 1.0).abs() < APART);
    let far = !(1.0 / believed..believed).contains(&median);
    (factors.len() > 1 && same && far).then_some(median)
}

//! Position limits, with those that hold under a condition.

use crate::arm::robot::Model;

use super::error::LimitViolation;

/// By how much rounding may carry an angle over its limit \[rad\]: where the arm is stretched,
/// its angles have half the digits.
const ROUNDING: f64 = 1e-7;

/// Whether every joint angle of `q` \[rad\] is inside its range.
///
/// # Errors
/// The first joint that is not.
pub fn limits_ok(model: &Model, q: &[f64]) -> Result<(), LimitViolation> {
    for (joint, &value) in q.iter().enumerate() {
        let range = model.limits.position_at(q, joint);
        if !(range[0] - ROUNDING..=range[1] + ROUNDING).contains(&value) {
            return Err(LimitViolation { joint, value, range });
        }
    }
    Ok(())
}

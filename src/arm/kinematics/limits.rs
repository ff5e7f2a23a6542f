//! Position limits, including conditional ones.

use crate::arm::robot::Model;

use super::error::LimitViolation;

/// Accepted excess of an angle over its limit \[rad\]: angles of a stretched arm have only half of
/// the digits.
const ROUNDING: f64 = 1e-7;

/// Checks that all joint angles `q` \[rad\] are within their ranges.
///
/// # Errors
/// The first joint outside its range.
pub fn limits_ok(model: &Model, q: &[f64]) -> Result<(), LimitViolation> {
    for (joint, &value) in q.iter().enumerate() {
        let range = model.limits.position_at(q, joint);
        if !(range[0] - ROUNDING..=range[1] + ROUNDING).contains(&value) {
            return Err(LimitViolation { joint, value, range });
        }
    }
    Ok(())
}

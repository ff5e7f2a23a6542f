//! Known constants of the motion planner.

use super::error::RobotError;
use super::fields::{Accepts, Fields};

/// Times of the planner \[s\].
const PLANNER_TIME: Accepts =
    Accepts::Between(0.0, 10.0, "0 or more and at most 10, in s (not milliseconds)");

/// Constants of the motion planner; `None` without a source.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Controller {
    /// Compensated friction of each motor \[Nm, motor side\].
    pub friction_level: Option<Vec<f64>>,
    /// Rise time of the acceleration: window of the moving average of the planned motion \[s\].
    pub ramp_s: Option<f64>,
    /// Share of that average in the middle half of the window; the rest is spread over all of it.
    pub ramp_core: Option<f64>,
    /// Share of the window by which a motion ends early; below 0.4, otherwise the end would need a
    /// larger acceleration than the rest.
    pub closing: Option<f64>,
    /// Time at a stop point before the next movement, included in waits \[s\].
    pub settling_s: Option<f64>,
    /// Period of the path interpolator \[s\].
    pub interpolation_s: Option<f64>,
}

impl Controller {
    pub(super) fn read(fields: &mut Fields, dof: usize) -> Result<Controller, RobotError> {
        Ok(Controller {
            friction_level: fields.per_joint("friction_level", dof, Accepts::NonNegative)?,
            ramp_s: fields.number("ramp_s", PLANNER_TIME)?,
            ramp_core: fields.number("ramp_core", Accepts::Share)?,
            closing: fields.number("closing", Accepts::Share)?,
            settling_s: fields.number("settling_s", PLANNER_TIME)?,
            interpolation_s: fields.number("interpolation_s", Accepts::Positive)?,
        })
    }
}

//! What is known of the controller's motion planner.

use super::error::RobotError;
use super::fields::{Accepts, Fields};
use super::provenance::Origin;

/// Times of the planner \[s\].
const PLANNER_TIME: Accepts =
    Accepts::Between(0.0, 10.0, "0 or more and at most 10, in s (not milliseconds)");

/// Figures of the motion planner; `None` where no source gives them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Controller {
    /// Friction that the controller compensates at each motor \[Nm\]; motor side.
    pub friction_level: Option<Vec<f64>>,
    /// Time in which the acceleration rises from 0 to its largest: the joints follow the average
    /// of the planned motion over this time \[s\].
    pub ramp_s: Option<f64>,
    /// Share of that average that lies in the middle half of the time, besides what is spread all
    /// over.
    pub ramp_core: Option<f64>,
    /// Share of the ramp time by which a motion ends before the average is complete; below 0.4,
    /// or the end would need more acceleration than the rest.
    pub closing: Option<f64>,
    /// Time at a stop point until the next movement starts; waits take it too \[s\].
    pub settling_s: Option<f64>,
    /// Period of the path interpolator \[s\].
    pub interpolation_s: Option<f64>,
}

impl Controller {
    pub(super) fn read(
        mut fields: Fields,
        dof: usize,
        origins: &mut Vec<Origin>,
    ) -> Result<Controller, RobotError> {
        let controller = Controller {
            friction_level: fields.per_joint("friction_level", dof, Accepts::NonNegative)?,
            ramp_s: fields.number("ramp_s", PLANNER_TIME)?,
            ramp_core: fields.number("ramp_core", Accepts::Share)?,
            closing: fields.number("closing", Accepts::Share)?,
            settling_s: fields.number("settling_s", PLANNER_TIME)?,
            interpolation_s: fields.number("interpolation_s", Accepts::Positive)?,
        };
        origins.extend(fields.finish()?);
        Ok(controller)
    }
}

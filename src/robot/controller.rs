//! What is known of the controller's motion planner.

use super::error::RobotError;
use super::fields::{Accepts, Fields};
use super::provenance::Origin;

/// Figures of the motion planner; `None` where no source gives them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Controller {
    /// Friction that the controller compensates at each motor \[Nm\]; motor side.
    pub friction_level: Option<Vec<f64>>,
    /// Time in which the acceleration rises from 0 to its largest \[s\].
    pub ramp_s: Option<f64>,
    /// Time at a stop point until the robot counts as settled \[s\].
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
            ramp_s: fields.number("ramp_s", Accepts::NonNegative)?,
            settling_s: fields.number("settling_s", Accepts::NonNegative)?,
            interpolation_s: fields.number("interpolation_s", Accepts::Positive)?,
        };
        origins.extend(fields.finish()?);
        Ok(controller)
    }
}

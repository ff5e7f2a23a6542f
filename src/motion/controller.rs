//! Constants of the controller's motion planner.

use crate::ir::movement::Settings;
use crate::robot::Model;

/// Time in which the acceleration builds up where the robot's file has none, s.
///
/// Measured: `RobotStudio` run of an IRB6640, `MoveL` of 500 mm at vmax.
const RAMP_S: f64 = 0.10;

/// Figures of the planner under the settings in force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planning {
    /// Time in which the acceleration builds up, s.
    pub ramp_s: f64,
    /// Time at a stop point until the program goes on, s.
    pub settling_s: f64,
    /// Share of the accelerations that is used.
    pub acceleration: f64,
}

impl Planning {
    /// From the robot's figures and `AccSet`.
    pub fn new(model: &Model, settings: &Settings) -> Planning {
        let ramp = model.controller.ramp_s.unwrap_or(RAMP_S);
        Planning {
            // AccSet's ramp is the rate of change of the acceleration.
            ramp_s: super::sampling::tune()[6]/0.1 * ramp * settings.acceleration / settings.ramp,
            settling_s: model.controller.settling_s.unwrap_or(0.0),
            acceleration: settings.acceleration,
        }
    }
}

//! Constants of the controller's motion planner under the settings in force.

use crate::ir::movement::Settings;
use crate::robot::Model;

/// Window of the average where the robot's file has none, s. Runs of an IRC5 with an IRB6640: the
/// speed changes by Δv with the acceleration Δv/0.1 s at v300 to v1000; a window of 0.1 s also
/// gives the least error of the joints over the runs that constants were chosen by.
const RAMP_S: f64 = 0.10;
/// Share of the average that lies in the middle half of the window instead of all over it. Same
/// runs, by the closest approach to corners passed at 1 m/s and more.
const CORE: f64 = 0.16;
/// Share of the window by which a motion ends early. Same runs: their durations, from the start of
/// the first command to standstill, are 0.03 to 0.04 s shorter than the averaged motion.
const CLOSING: f64 = 1.0 / 3.0;
/// Period of the interpolator where the robot's file has none, s. Published configurations:
/// `std_servo_queue_time` of 0.193536 s is 48 periods.
const INTERPOLATION_S: f64 = 0.004_032;

/// Figures of the planner under the settings in force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planning {
    /// How the joints are averaged.
    pub average: Average,
    /// Time between the end of a movement at a stop point and the start of the next, s.
    pub settling_s: f64,
    /// Share of the accelerations that is used.
    pub acceleration: f64,
}

/// The moving average that limits the jerk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Average {
    /// Its length, s: the time in which the acceleration builds up.
    pub window: f64,
    /// Share of it that lies in its middle half, besides what is spread all over.
    pub core: f64,
    /// Time by which a motion ends before the average is complete, s.
    pub closing: f64,
}

impl Planning {
    /// From the robot's figures and `AccSet`.
    pub fn new(model: &Model, settings: &Settings) -> Planning {
        let controller = &model.controller;
        // AccSet's ramp is the rate of change of the acceleration.
        let window = controller.ramp_s.unwrap_or(RAMP_S) / settings.ramp;
        let closing = window * controller.closing.unwrap_or(CLOSING);
        Planning {
            average: Average { window, core: controller.ramp_core.unwrap_or(CORE), closing },
            // The runs stop as long as if every average were complete.
            settling_s: controller.settling_s.unwrap_or(closing),
            acceleration: settings.acceleration,
        }
    }
}

/// Period of the interpolator, s.
pub fn interpolation_s(model: &Model) -> f64 {
    model.controller.interpolation_s.unwrap_or(INTERPOLATION_S)
}

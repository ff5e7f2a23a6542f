//! Constants of the motion planner under the current settings.

use crate::arm::robot::Model;
use crate::rapid::ir::movement::Settings;
use crate::retime::path::joint_path::Joints;

/// Default window of the average, s. Runs of an IRC5 with an IRB6640: at v300 to v1000 the speed
/// changes by Δv with the acceleration Δv/0.1 s; a window of 0.1 s also gives the least joint error
/// over the runs that the constants were fitted to.
const RAMP_S: f64 = 0.10;
/// Default share of the average in the middle half of the window. Same runs: closest approach to
/// corners passed at 1 m/s and more.
const CORE: f64 = 0.16;
/// Default share of the window by which a motion ends early. Same runs: from the start of the first
/// command to standstill they are 0.03 to 0.04 s shorter than the averaged motion.
const CLOSING: f64 = 0.33;
/// Default period of the interpolator, s. Published configurations: `std_servo_queue_time` of
/// 0.193536 s is 48 periods.
const INTERPOLATION_S: f64 = 0.004_032;

/// Time to the largest speed of each joint without accelerations in the robot file, s: from
/// measured accelerations and data sheet speeds of an IRB6640-180/2.55.
const TO_FULL_SPEED_S: Joints = [0.34, 0.36, 0.17, 0.08, 0.07, 0.07];

/// Constants of the planner under the current settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planning {
    /// Average of the joint angles.
    pub average: Average,
    /// Time between the end of a movement at a stop point and the start of the next, s.
    pub settling_s: f64,
}

/// The moving average that limits the jerk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Average {
    /// Length, s: the rise time of the acceleration.
    pub window: f64,
    /// Share in the middle half; the rest is spread over the whole window.
    pub core: f64,
    /// Time by which a motion ends before the average is complete, s.
    pub closing: f64,
}

impl Planning {
    /// From the robot file and `AccSet`.
    pub fn new(model: &Model, settings: &Settings) -> Planning {
        let controller = &model.controller;
        // The ramp of AccSet is the rate of change of the acceleration; the fine-point ramp is
        // applied to the whole movement.
        let ramp = settings.ramp.min(settings.fine_point_ramp);
        let window = controller.ramp_s.unwrap_or(RAMP_S) / ramp;
        let closing = window * controller.closing.unwrap_or(CLOSING);
        Planning {
            average: Average { window, core: controller.ramp_core.unwrap_or(CORE), closing },
            // In the logged runs the stop lasts as long as after a complete average.
            settling_s: controller.settling_s.unwrap_or(closing),
        }
    }

    /// The same with a complete average and a shorter rest after it.
    #[must_use]
    pub fn complete(self) -> Planning {
        let Planning { average, settling_s } = self;
        let settling_s = (settling_s - average.closing).max(0.0);
        Planning { average: Average { closing: 0.0, ..average }, settling_s }
    }
}

/// Joint limits of the planner.
#[derive(Clone, Debug)]
pub struct MotionLimits {
    /// rad/s².
    pub acceleration: Joints,
    /// Nm, infinite if the robot has no dynamics.
    pub torque: Joints,
}

/// The limits of the robot; without accelerations in its file they follow from [`TO_FULL_SPEED_S`].
pub fn motion_limits(model: &Model) -> MotionLimits {
    let acceleration = if let Some(list) = &model.limits.acceleration {
        joint_limits(Some(list))
    } else {
        let speed = joint_limits(model.limits.velocity.as_ref());
        std::array::from_fn(|j| speed[j] / TO_FULL_SPEED_S[j])
    };
    MotionLimits { acceleration, torque: joint_limits(model.torque_bounds()) }
}

/// One limit per joint, infinite where the list has none.
pub fn joint_limits(list: Option<&Vec<f64>>) -> Joints {
    let limit = |j: usize| list.and_then(|list| list.get(j)).copied();
    std::array::from_fn(|j| limit(j).unwrap_or(f64::INFINITY))
}

/// Assumptions of a simulation for missing figures of the robot file.
pub fn assumed(model: &Model) -> Option<String> {
    model.limits.acceleration.is_none().then(|| {
        format!(
            "joint accelerations of {}: each joint gets to its speed in the time that an \
             IRB6640-180/2.55 takes",
            model.name
        )
    })
}

/// Period of the interpolator, s.
pub fn interpolation_s(model: &Model) -> f64 {
    model.controller.interpolation_s.unwrap_or(INTERPOLATION_S)
}

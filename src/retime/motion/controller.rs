//! Constants of the controller's motion planner under the settings in force.

use crate::arm::robot::Model;
use crate::rapid::ir::movement::Settings;
use crate::retime::path::joint_path::Joints;

/// Window of the average where the robot's file states none, s. Runs of an IRC5 with an IRB6640: the
/// speed changes by Δv with the acceleration Δv/0.1 s at v300 to v1000; a window of 0.1 s also
/// gives the least error of the joints over the runs that constants were chosen by.
const RAMP_S: f64 = 0.10;
/// Share of the average that lies in the middle half of the window instead of all over it. Same
/// runs, by the closest approach to corners passed at 1 m/s and more.
const CORE: f64 = 0.16;
/// Share of the window by which a motion ends early. Same runs: their durations, from the start of
/// the first command to standstill, are 0.03 to 0.04 s shorter than the averaged motion.
const CLOSING: f64 = 0.33;
/// Period of the interpolator where the robot's file has none, s. Published configurations:
/// `std_servo_queue_time` of 0.193536 s is 48 periods.
const INTERPOLATION_S: f64 = 0.004_032;

/// Time in which each joint reaches its largest speed where the robot's file has no accelerations,
/// s: that of an IRB6640-180/2.55, from its measured accelerations and the speeds of its data sheet.
const TO_FULL_SPEED_S: Joints = [0.34, 0.36, 0.17, 0.08, 0.07, 0.07];

/// Constants of the planner under the settings in force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planning {
    /// How the joints are averaged.
    pub average: Average,
    /// Time between the end of a movement at a stop point and the start of the next, s.
    pub settling_s: f64,
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
        // AccSet's ramp is the rate of change of the acceleration; that of stop points is taken
        // for the whole way to one.
        let ramp = settings.ramp.min(settings.fine_point_ramp);
        let window = controller.ramp_s.unwrap_or(RAMP_S) / ramp;
        let closing = window * controller.closing.unwrap_or(CLOSING);
        Planning {
            average: Average { window, core: controller.ramp_core.unwrap_or(CORE), closing },
            // The runs stop as long as if every average were complete.
            settling_s: controller.settling_s.unwrap_or(closing),
        }
    }

    /// The same with the average carried out to its end, and a shorter rest behind it.
    #[must_use]
    pub fn complete(self) -> Planning {
        let Planning { average, settling_s } = self;
        let settling_s = (settling_s - average.closing).max(0.0);
        Planning { average: Average { closing: 0.0, ..average }, settling_s }
    }
}

/// Limits of the joints under the settings in force.
#[derive(Clone, Debug)]
pub struct MotionLimits {
    /// rad/s².
    pub acceleration: Joints,
    /// Nm, infinite where the robot has no dynamics.
    pub torque: Joints,
}

/// The limits of the robot with a share of its accelerations. Where its file has none they follow
/// from [`TO_FULL_SPEED_S`].
pub fn motion_limits(model: &Model, share: f64) -> MotionLimits {
    let list = |values: &Option<Vec<f64>>, factor: f64| -> Joints {
        std::array::from_fn(|j| {
            values.as_ref().and_then(|v| v.get(j)).map_or(f64::INFINITY, |x| x * factor)
        })
    };
    let acceleration = if model.limits.acceleration.is_some() {
        list(&model.limits.acceleration, share)
    } else {
        let speed = list(&model.limits.velocity, share);
        std::array::from_fn(|j| speed[j] / TO_FULL_SPEED_S[j])
    };
    let torque = list(&model.torque_bounds().cloned(), 1.0);
    MotionLimits { acceleration, torque }
}

/// What a simulation assumes about the robot where its file has no figures.
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

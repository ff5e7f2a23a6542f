//! Configurations, which select one of the solutions of a pose.
//!
//! `cf1`, `cf4`, `cf6` are the quarter turns of axes 1, 4, 6 (0: 0 to 90°, −1: −90° to 0, …). `cfx`
//! is a bit pattern: 4 for a wrist centre behind axis 1, 2 for one behind the lower arm, 1 for a
//! negative axis 5.

use std::f64::consts::FRAC_PI_2;
use std::fmt;

use nalgebra::Vector3;

use crate::arm::robot::{Coupling, Model};

use super::fk::Frames;

/// A configuration of a six-axis robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Conf {
    /// Quarter turn of axis 1.
    pub cf1: i32,
    /// Quarter turn of axis 4.
    pub cf4: i32,
    /// Quarter turn of axis 6.
    pub cf6: i32,
    /// Shoulder, elbow and wrist, 0 to 7; not used by parallelogram robots.
    pub cfx: i32,
}

impl fmt::Display for Conf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{},{},{},{}]", self.cf1, self.cf4, self.cf6, self.cfx)
    }
}

/// The configuration of the joint angles `q` \[rad\]; `cfx` is 0 for parallelogram robots.
#[must_use]
pub fn conf_of(model: &Model, q: &[f64; 6]) -> Conf {
    let cfx = match model.kinematics.coupling {
        Coupling::None => Shape::at(model, q).cfx(q),
        Coupling::Parallelogram => 0,
    };
    Conf { cf1: quarter(q[0]), cf4: quarter(q[3]), cf6: quarter(q[5]), cfx }
}

/// The quarter turn of an angle \[rad\].
fn quarter(angle: f64) -> i32 {
    (angle / FRAC_PI_2).floor() as i32
}

/// Position of the wrist centre in the plane of the arm.
pub(super) struct Shape {
    /// Distance in front of axis 1 \[m\].
    pub(super) reach: f64,
    /// Angle about axis 3 from the upper arm to the line from elbow to wrist centre \[rad\].
    pub(super) elbow: f64,
}

impl Shape {
    pub(super) fn at(model: &Model, q: &[f64; 6]) -> Shape {
        let frames = Frames::at(model, q);
        let geometry = &model.kinematics;
        let offset = geometry.offset_wrist.as_ref();
        let arm = geometry.opw.as_ref().or(offset.map(|offset| &offset.arm));
        // If the wrist axes do not meet: the intersection of axes 4 and 5, otherwise axis 5.
        let along = offset
            .map_or(0.0, |offset| offset.crossing.translation.vector.dot(&geometry.joints[4].axis));
        let wrist = match &geometry.opw {
            Some(opw) => {
                let flange = frames.flange(model);
                flange.translation.vector - flange.rotation * Vector3::z() * opw.c4
            }
            None => frames.origin[4] + frames.axis[4] * along,
        };
        let signs = arm.map_or([1.0; 6], |opw| opw.signs);
        let up = frames.axis[0] * signs[0];
        let across = frames.axis[2] * signs[2];
        let upper_arm = frames.origin[2] - frames.origin[1];
        let forearm = wrist - frames.origin[2];
        let [a, b] = [upper_arm, forearm].map(|v| v - across * v.dot(&across));
        Shape {
            reach: wrist.dot(&across.cross(&up)),
            elbow: across.dot(&a.cross(&b)).atan2(a.dot(&b)),
        }
    }

    fn cfx(&self, q: &[f64; 6]) -> i32 {
        let behind_axis_1 = self.reach < 0.0;
        let behind_lower_arm = self.elbow.sin() < 0.0;
        4 * i32::from(behind_axis_1) + 2 * i32::from(behind_lower_arm) + i32::from(q[4] < 0.0)
    }
}

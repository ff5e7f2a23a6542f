//! Configurations: which of the solutions of a pose is meant.
//!
//! `cf1`, `cf4`, `cf6` are the quarter turns of axes 1, 4, 6 (0: 0 to 90°, −1:
//! −90° to 0, …). `cfx` is a bit pattern: 4 where the wrist centre is behind
//! axis 1, 2 where it is behind the lower arm, 1 where axis 5 is negative.

use std::f64::consts::FRAC_PI_2;
use std::fmt;

use crate::robot::{Coupling, Model, Opw};

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

/// The configuration of the joint angles `q` \[rad\]. Without OPW kinematics,
/// and for parallelogram robots, `cfx` is 0.
#[must_use]
pub fn conf_of(model: &Model, q: &[f64; 6]) -> Conf {
    let cfx = match &model.kinematics.opw {
        Some(opw) if model.kinematics.coupling == Coupling::None => cfx(model, opw, q),
        _ => 0,
    };
    Conf { cf1: quarter(q[0]), cf4: quarter(q[3]), cf6: quarter(q[5]), cfx }
}

/// The quarter turn that an angle \[rad\] lies in.
pub(super) fn quarter(angle: f64) -> i32 {
    (angle / FRAC_PI_2).floor() as i32
}

/// The elbow's angle: from the upper arm to the line from elbow to wrist
/// centre, about axis 3 \[rad\].
pub(super) fn elbow_angle(model: &Model, opw: &Opw, q: &[f64; 6]) -> f64 {
    let serial = model.kinematics.to_serial(q);
    opw.signs[2] * serial[2] - opw.offsets[2] + opw.a2.atan2(opw.c3)
}

fn cfx(model: &Model, opw: &Opw, q: &[f64; 6]) -> i32 {
    let frames = Frames::at(model, q);
    // The wrist centre's abscissa in the plane of the arm.
    let (sin, cos) = (opw.signs[0] * q[0] - opw.offsets[0]).sin_cos();
    let wrist = frames.origin[3];
    let behind_axis_1 = wrist.x * cos + wrist.y * sin < 0.0;
    let behind_lower_arm = elbow_angle(model, opw, q).sin() < 0.0;
    4 * i32::from(behind_axis_1) + 2 * i32::from(behind_lower_arm) + i32::from(q[4] < 0.0)
}

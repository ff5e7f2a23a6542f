//! The end of a line or arc whose target has no configuration.

use super::build::{MAX_PIECE, measure};
use super::joint_path::Joints;
use super::leg::Leg;
use crate::arm::kinematics::ik_near;
use crate::arm::robot::Model;

/// Joint angles at the end of a Cartesian leg (rad), from the nearest inverse solutions in steps
/// along the leg; `None` if a pose on it has no solution.
pub fn arrival(model: &Model, leg: &Leg) -> Option<Joints> {
    let curve = measure(model, leg, 0, &leg.start).ok()?.curve?;
    let steps = (curve.length() / MAX_PIECE).ceil().max(1.0) as usize;
    let mut q = leg.start;
    for i in 1..=steps {
        let pose = curve.eval(curve.length() * i as f64 / steps as f64).pose;
        q = ik_near(model, &leg.tool.flange(&pose), &q).ok()?;
    }
    Some(q)
}

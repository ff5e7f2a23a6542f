//! All branches of the inverse kinematics, in closed form or numerically.

use nalgebra::Isometry3;

use crate::arm::robot::Model;

use super::closed_form::{Branch, closed, is_finite};
use super::conf::Shape;
use super::error::IkError;
use super::{numeric, offset_wrist};

/// All solutions of the pose, each angle in (−π, π], without regard to position limits. An OPW arm
/// has at most eight, with joint 4 at zero in a wrist singularity; another arm at most sixteen,
/// found numerically: one near a singularity may be missed.
///
/// # Errors
/// The pose is out of reach or not finite, or the robot does not have six joints.
pub fn ik_all(model: &Model, pose: &Isometry3<f64>) -> Result<Vec<[f64; 6]>, IkError> {
    Ok(branches(model, pose, 0.0)?.iter().map(|branch| branch.q).collect())
}

/// The branches of [`ik_all`]; never empty. `q1` \[rad\] is the angle of joint 1 for a wrist centre
/// on its axis, where any angle is a solution.
pub(super) fn branches(
    model: &Model,
    pose: &Isometry3<f64>,
    q1: f64,
) -> Result<Vec<Branch>, IkError> {
    if model.dof != 6 {
        return Err(IkError::NoInverse { robot: model.name.clone() });
    }
    if !is_finite(pose) {
        return Err(IkError::NotFinite);
    }
    match &model.kinematics.opw {
        Some(opw) => closed(model, opw, pose, q1),
        None => searched(model, pose),
    }
}

fn searched(model: &Model, pose: &Isometry3<f64>) -> Result<Vec<Branch>, IkError> {
    let found = match &model.kinematics.offset_wrist {
        Some(wrist) => offset_wrist::solutions(model, wrist, pose),
        None => numeric::solutions(model, pose),
    };
    if found.is_empty() {
        return Err(IkError::NotFound { robot: model.name.clone() });
    }
    let branch = |q: [f64; 6]| {
        let shape = Shape::at(model, &q);
        Branch { q, back: shape.reach < 0.0, elbow: shape.elbow, locked: None }
    };
    Ok(found.into_iter().map(branch).collect())
}

//! All branches of the inverse kinematics, in closed form or searched.

use nalgebra::Isometry3;

use crate::arm::robot::Model;

use super::closed_form::{Branch, closed, is_finite};
use super::conf::Shape;
use super::error::IkError;
use super::{numeric, offset_wrist};

/// All solutions of the pose, each angle in (−π, π]; position limits are not looked
/// at. Of an OPW arm at most eight, where joint 4 is at its zero in a wrist
/// singularity; of another arm at most sixteen, which are searched: one next to a
/// singularity may be missed.
///
/// # Errors
/// The pose is out of reach or not finite, or the robot has not six joints.
pub fn ik_all(model: &Model, pose: &Isometry3<f64>) -> Result<Vec<[f64; 6]>, IkError> {
    Ok(branches(model, pose, 0.0)?.iter().map(|branch| branch.q).collect())
}

/// The branches behind [`ik_all`]; never empty. `q1` \[rad\] is the angle of joint 1 where any
/// will do: with the wrist centre on its axis.
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

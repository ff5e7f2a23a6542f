//! Tool and payload during a movement or a wait.

use nalgebra::{Isometry3, Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::arm::dynamics::Load;
use crate::rapid::ir::movement::{LoadData, Movement, Tool};

/// Tool and payload at the flange.
pub(super) fn effective_load(movement: &Movement) -> Load {
    if let Some(total) = &movement.total_load {
        return load(total, &Isometry3::identity());
    }
    gripped(&gripping(movement), movement.settings.grip_load.as_ref())
}

/// The tool with the frame in which `GripLoad` states a load: the tool frame, or the work object
/// frame if the robot holds the work object.
pub(super) fn gripping(movement: &Movement) -> Tool {
    let tool = movement.tool.clone();
    if tool.robhold { tool } else { Tool { frame: movement.wobj.frame, ..tool } }
}

/// A tool with its `GripLoad`.
pub(super) fn gripped(tool: &Tool, grip: Option<&LoadData>) -> Load {
    let alone = load(&tool.load, &Isometry3::identity());
    match grip {
        Some(grip) => alone.with(&load(grip, &tool.frame)),
        None => alone,
    }
}

fn load(data: &LoadData, frame: &Isometry3<f64>) -> Load {
    let [w, x, y, z] = data.axes;
    let axes = frame.rotation * UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    let axes = axes.to_rotation_matrix();
    let principal = Matrix3::from_diagonal(&Vector3::from(data.inertia));
    Load {
        mass: data.mass,
        com: frame * nalgebra::Point3::from(Vector3::from(data.com)) - nalgebra::Point3::origin(),
        inertia: axes * principal * axes.transpose(),
    }
}

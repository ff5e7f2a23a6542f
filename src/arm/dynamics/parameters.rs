//! The parameters in which the torque is linear, and their names.

use nalgebra::Matrix3;

use crate::arm::robot::{Link, Model};

use super::friction::sign;
use super::load::Load;

/// Number of parameters of a rigid body.
pub const RIGID: usize = 10;
/// Number of parameters of a joint: rotor inertia, viscous and Coulomb friction, offset.
pub const JOINT: usize = 4;

/// Names of the parameters of a link, in order: mass \[kg\], first moments \[kg m\], moments about
/// the joint origin \[kg m²\].
const RIGID_NAMES: [&str; RIGID] = ["m", "mx", "my", "mz", "xx", "yy", "zz", "xy", "xz", "yz"];
/// Names of the parameters of a joint, in order: \[kg m²\], \[Nm s/rad\], \[Nm\], \[Nm\].
const JOINT_NAMES: [&str; JOINT] = ["ia", "fv", "fc", "offset"];

/// Number of parameters of a robot with `dof` joints: those of the links, then those of the joints.
#[must_use]
pub fn parameter_count(dof: usize) -> usize {
    (RIGID + JOINT) * dof
}

/// Name of the parameter `index` of a robot with `dof` joints, such as `xx3` or `fc6`.
#[must_use]
pub fn parameter_name(dof: usize, index: usize) -> String {
    let rigid = RIGID * dof;
    if index < rigid {
        format!("{}{}", RIGID_NAMES[index % RIGID], index / RIGID + 1)
    } else {
        format!("{}{}", JOINT_NAMES[(index - rigid) % JOINT], (index - rigid) / JOINT + 1)
    }
}

/// The parameters of a link.
#[must_use]
pub fn link_parameters(link: &Link) -> [f64; RIGID] {
    let (m, c) = (link.mass, &link.com);
    let about = link.inertia + (Matrix3::identity() * c.norm_squared() - c * c.transpose()) * m;
    [
        m,
        m * c.x,
        m * c.y,
        m * c.z,
        about[(0, 0)],
        about[(1, 1)],
        about[(2, 2)],
        about[(0, 1)],
        about[(0, 2)],
        about[(1, 2)],
    ]
}

/// All parameters of a robot with `load` at its flange, in the order of [`parameter_name`]; empty
/// if it has no dynamics. Offsets are 0.
#[must_use]
pub fn parameters(model: &Model, load: &Load) -> Vec<f64> {
    let Some(loaded) = load.on(model) else { return Vec::new() };
    let (_, before) = model.links.split_last().unwrap_or((&loaded, &[]));
    let mut values: Vec<f64> = before.iter().chain([&loaded]).flat_map(link_parameters).collect();
    for j in 0..model.dof {
        let rotor = model.motors.as_ref().map_or(0.0, |m| m.reflected_inertia(j));
        values.extend([rotor, model.friction.viscous[j], model.friction.coulomb[j], 0.0]);
    }
    values
}

/// Regressor entries of the joint parameters at the motor speed `qd` and acceleration `qdd`.
pub(super) fn joint_row(qd: f64, qdd: f64) -> [f64; JOINT] {
    [qdd, qd, sign(qd), 1.0]
}

//! Priors of the links before identification.

use nalgebra::{Matrix3, Matrix4, Vector3};

use super::consistent::{BODY, margin};
use crate::arm::dynamics::{Load, body_parameters, link_of, link_parameters, pseudo_inertia};
use crate::arm::robot::{Link, Model};

/// Mean density of an arm including hollow parts \[kg/m³\].
const DENSITY: f64 = 1500.0;
/// Slenderness of a link: its radius over its length.
const SLENDER: f64 = 0.25;
/// Least length of a link \[m\].
const SHORTEST: f64 = 0.1;

/// The prior pseudo-inertia of a link: that of the model if it is physically consistent, else that
/// of a bar to the next joint.
pub(super) fn prior(model: &Model, joint: usize) -> Matrix4<f64> {
    if let Some(link) = model.links.get(joint) {
        let values = link_parameters(link);
        if margin(&values) > BODY {
            return pseudo_inertia(&values);
        }
    }
    let geometry = &model.kinematics;
    let to = geometry
        .joints
        .get(joint + 1)
        .map_or(geometry.flange.translation.vector, |next| next.translation);
    pseudo_inertia(&link_parameters(&bar(to)))
}

/// The initial link of a descent.
pub(super) fn first_guess(model: &Model, joint: usize) -> Link {
    link_of(&body_parameters(&prior(model, joint)))
}

/// A round bar from the origin to a point.
fn bar(to: Vector3<f64>) -> Link {
    let length = to.norm().max(SHORTEST);
    let radius = SLENDER * length;
    let mass = DENSITY * std::f64::consts::PI * radius * radius * length;
    let across = mass * (length * length / 12.0 + radius * radius / 4.0);
    Link { mass, com: to * 0.5, inertia: Matrix3::identity() * across }
}

/// A body of 1 kg at the flange, in the last link's frame.
pub(super) fn small_body(model: &Model) -> Link {
    let com = model.kinematics.flange.translation.vector;
    Link { mass: 1.0, com, inertia: Matrix3::identity() * 1e-3 }
}

/// Transforms a body from the last link's frame to that of the flange.
pub(super) fn at_flange(model: &Model, body: &Link) -> Load {
    let to = model.kinematics.flange.inverse();
    let rotation = to.rotation.to_rotation_matrix();
    Load {
        mass: body.mass,
        com: to.transform_point(&body.com.into()).coords,
        inertia: rotation.matrix() * body.inertia * rotation.matrix().transpose(),
    }
}

//! The links of an arm from meshes of ABB robots.

use super::known::{Known, Shape};
use super::rules::Size;
use super::skeleton;
use crate::arm::robot::geometry::Geometry;
use crate::arm::robot::link::Link;
use crate::arm::robot::model::Model;

/// Homogeneous meshes have too much mass far out: for nine robot families with published masses the
/// published moment about axis 2 is 0.93 of that of the meshes.
const MESH_MASS_SHARE: f64 = 0.93;
/// Distance of a rated load from the flange \[m\].
const LOAD_DISTANCE: f64 = 0.1;

/// The links of a robot from its meshes or from its axes alone, and their source.
pub(super) fn links(known: &Known, geometry: &Geometry, size: Size) -> (Vec<Link>, String) {
    if known.links.is_empty() {
        let (shapes, foot) = skeleton::shapes(geometry, size);
        let source = "the axes, reach, payload and mass of the robot: a rule of 71 robots of ABB";
        return (with_masses(&shapes, size.mass - foot), source.to_owned());
    }
    let foot = known.foot.unwrap_or_default();
    let whose = if known.sister { "meshes of a sister" } else { "meshes" };
    let links = with_masses(&known.links, MESH_MASS_SHARE * (size.mass - foot));
    (links, format!("{whose}, evenly filled, and the mass of the robot"))
}

fn with_masses(shapes: &[Shape], moving: f64) -> Vec<Link> {
    let body = |shape: &Shape| Link {
        mass: shape.share * moving,
        com: shape.com,
        inertia: shape.gyration * (shape.share * moving),
    };
    shapes.iter().map(body).collect()
}

/// Distances of each joint and of the flange from joint 2 along the stretched arm \[m\].
fn stretched(model: &Model) -> Vec<f64> {
    let joints = &model.kinematics.joints;
    let mut at = vec![0.0; joints.len() + 1];
    for i in 2..joints.len() {
        at[i] = at[i - 1] + joints[i].translation.norm();
    }
    let last = joints.len();
    at[last] = at[last - 1] + model.kinematics.flange.translation.vector.norm();
    at
}

/// Position of the centre of mass of a link along the stretched arm from joint 2 \[m\].
fn centre(model: &Model, at: &[f64], link: usize) -> f64 {
    let joints = &model.kinematics.joints;
    let next = joints
        .get(link + 1)
        .map_or(model.kinematics.flange.translation.vector, |joint| joint.translation);
    let com = model.links[link].com;
    // Frames of a spherical wrist coincide; the preceding link has the same direction.
    let way = if next.norm() > SHORT { next } else { joints[link].translation };
    let along = if way.norm() > SHORT { com.dot(&way) / way.norm() } else { com.norm() };
    at[link] + along
}

/// Shorter vectors have no direction \[m\].
const SHORT: f64 = 1e-3;

/// First moment of mass about axis 2 of the stretched arm with a level upper arm \[kg m\].
pub(super) fn stretched_moment(model: &Model) -> f64 {
    let at = stretched(model);
    (1..model.dof).map(|i| model.links[i].mass * centre(model, &at, i)).sum()
}

/// Inertia about each joint of the stretched arm with its rated load, without rotors \[kg m²\].
pub(super) fn rated_inertia(model: &Model, payload: f64) -> Vec<f64> {
    let at = stretched(model);
    let end = at[model.dof] + LOAD_DISTANCE;
    let inertia = |j: usize| {
        let from = at[j];
        let own: f64 = (j..model.dof)
            .map(|i| {
                let link = &model.links[i];
                let lever = centre(model, &at, i) - from;
                // The first and third wrist axes have no lever.
                let lever = if along_the_arm(j, model.dof) { 0.0 } else { lever };
                link.mass * lever * lever + 0.5 * link.inertia.trace()
            })
            .sum();
        let lever = if along_the_arm(j, model.dof) { LOAD_DISTANCE } else { end - from };
        own + payload * lever * lever
    };
    (0..model.dof).map(inertia).collect()
}

/// Whether the axis of a joint is along the stretched arm: the first and third of a wrist.
fn along_the_arm(joint: usize, dof: usize) -> bool {
    joint + 3 == dof || joint + 1 == dof
}

//! Mass matrix by the composite rigid body algorithm.
//!
//! R. Featherstone, "Rigid Body Dynamics Algorithms", 2008, chapter 6, in the base frame:
//! `M_ik = S_i · Y_k S_k` for i ≤ k, with `Y_k` the inertia of all bodies from k on.

use nalgebra::{Matrix3, Vector3};

use crate::arm::robot::Model;

use super::data::Data;
use super::joint_matrix::{self, JointMatrix};
use super::load::Load;
use super::motor_side::add_rotors;
use super::rnea::links;
use super::spatial::{Inertia, Motion};

/// M(q) \[kg m²\] at `q` \[rad\] with `load` at the flange, including rotors. Zero if the robot has
/// no dynamics.
pub fn crba(model: &Model, data: &mut Data, load: &Load, q: &[f64]) -> JointMatrix {
    let mut mass = JointMatrix::zeros();
    let Some(loaded) = load.on(model) else { return mass };
    let angles = model.kinematics.to_serial(q);
    let n = links(model);
    let mut rotation = Matrix3::identity();
    let mut origin = Vector3::zeros();
    for i in 0..n {
        let joint = &model.kinematics.joints[i];
        let link = if i + 1 == n { &loaded } else { &model.links[i] };
        origin += rotation * joint.translation;
        rotation *= joint.rotation_at(angles[i]);
        let z = rotation * joint.axis.into_inner();
        data.axis[i] = Motion { angular: z, linear: origin.cross(&z) };
        let about_com = rotation * link.inertia * rotation.transpose();
        data.inertia[i] = Inertia::of_body(link.mass, &(origin + rotation * link.com), &about_com);
    }
    for k in (0..n).rev() {
        if k + 1 < n {
            data.inertia[k] += data.inertia[k + 1];
        }
        let momentum = data.inertia[k].times(&data.axis[k]);
        for i in 0..=k {
            let m = data.axis[i].dot(&momentum);
            mass[(i, k)] = m;
            mass[(k, i)] = m;
        }
    }
    let mut mass = joint_matrix::from_serial(model, mass);
    add_rotors(model, &mut mass);
    mass
}

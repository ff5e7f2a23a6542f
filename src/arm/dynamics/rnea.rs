//! Inverse dynamics by the recursive Newton-Euler algorithm.
//!
//! R. Featherstone, "Rigid Body Dynamics Algorithms", 2008, chapter 5, in 3-vectors, each body in
//! its joint frame.

use nalgebra::{Matrix3, Vector3};

use crate::arm::robot::{GRAVITY, Link, MAX_DOF, Model, Rotations};

use super::data::Data;
use super::load::Load;
use super::motor_side::rotor_torques;

/// Torque of each joint \[Nm\] for the motion `q` \[rad\], `qd` \[rad/s\], `qdd` \[rad/s²\] with
/// `load` at the flange: rigid bodies and reflected rotors, no friction. The inputs have one entry
/// per joint (missing ones are 0). All zero if the robot has no dynamics.
pub fn rnea(
    model: &Model,
    data: &mut Data,
    load: &Load,
    q: &[f64],
    qd: &[f64],
    qdd: &[f64],
) -> [f64; MAX_DOF] {
    let mut tau = rigid_bodies(model, data, load, q, qd, qdd);
    for (sum, rotor) in tau.iter_mut().zip(rotor_torques(model, qdd)) {
        *sum += rotor;
    }
    tau
}

/// The same without rotors: the torque through the gears.
pub fn rigid_bodies(
    model: &Model,
    data: &mut Data,
    load: &Load,
    q: &[f64],
    qd: &[f64],
    qdd: &[f64],
) -> [f64; MAX_DOF] {
    let Some(loaded) = load.on(model) else { return [0.0; MAX_DOF] };
    model.kinematics.turn(q, &mut data.rotation);
    let [tau] = newton_euler(model, [&data.rotation], &loaded, [[qd, qdd]]);
    tau
}

/// [`rigid_bodies`] in several states \[q, q̇, q̈\].
#[inline]
pub(super) fn rigid_bodies_each<const N: usize>(
    model: &Model,
    load: &Load,
    states: [[&[f64]; 3]; N],
) -> [[f64; MAX_DOF]; N] {
    let Some(loaded) = load.on(model) else { return [[0.0; MAX_DOF]; N] };
    let mut rotations = [[Matrix3::zeros(); MAX_DOF]; N];
    for (rotations, [q, ..]) in rotations.iter_mut().zip(states) {
        model.kinematics.turn(q, rotations);
    }
    let motions = states.map(|[_, qd, qdd]| [qd, qdd]);
    newton_euler(model, rotations.each_ref(), &loaded, motions)
}

/// [`rnea`] of several motions \[q̇, q̈\] at one position, given by the joint rotations.
pub fn rnea_each<const N: usize>(
    model: &Model,
    load: &Load,
    rotations: &Rotations,
    motions: [[&[f64]; 2]; N],
) -> [[f64; MAX_DOF]; N] {
    let Some(loaded) = load.on(model) else { return [[0.0; MAX_DOF]; N] };
    let mut torques = newton_euler(model, [rotations; N], &loaded, motions);
    for (tau, [_, qdd]) in torques.iter_mut().zip(motions) {
        for (sum, rotor) in tau.iter_mut().zip(rotor_torques(model, qdd)) {
            *sum += rotor;
        }
    }
    torques
}

/// Holding torque of each joint at `q` \[rad\] \[Nm\].
pub fn gravity(model: &Model, data: &mut Data, load: &Load, q: &[f64]) -> [f64; MAX_DOF] {
    rnea(model, data, load, q, &[], &[])
}

/// Number of links that carry mass.
pub(super) fn links(model: &Model) -> usize {
    model.links.len().min(model.kinematics.joints.len()).min(MAX_DOF)
}

/// The torques of motions \[q̇, q̈\] at positions with these rotations; `loaded` is the last link.
/// All motions of a link are computed together for instruction-level parallelism.
fn newton_euler<const N: usize>(
    model: &Model,
    rotations: [&Rotations; N],
    loaded: &Link,
    motions: [[&[f64]; 2]; N],
) -> [[f64; MAX_DOF]; N] {
    let geometry = &model.kinematics;
    let mut rates = [[[0.0; MAX_DOF]; 2]; N];
    for (rates, motion) in rates.iter_mut().zip(motions) {
        *rates = [geometry.to_serial(motion[0]), geometry.to_serial(motion[1])];
    }
    let joints = &geometry.joints;
    let last = links(model) - 1;

    // Angular velocity and acceleration of the parent, and acceleration of its origin; gravity is
    // an acceleration of the base.
    let mut w = [Vector3::zeros(); N];
    let mut wd = [Vector3::zeros(); N];
    let mut a = [model.kinematics.up() * GRAVITY; N];
    // Force on each link through its joint [N] and moment about its origin [Nm], in its frame.
    let mut forces = [[Vector3::zeros(); N]; MAX_DOF];
    let mut moments = [[Vector3::zeros(); N]; MAX_DOF];
    for i in 0..=last {
        let joint = &joints[i];
        let link = if i == last { loaded } else { &model.links[i] };
        let p = joint.translation;
        let axis = joint.axis.into_inner();
        let c = link.com;
        for k in 0..N {
            let r = &rotations[k][i];
            let [qd, qdd] = [rates[k][0][i], rates[k][1][i]];
            // Without velocities many terms are zero, without accelerations nearly all.
            let [moves, starts] = motions[k].map(|list| !list.is_empty());
            let (force, moment);
            if moves {
                a[k] = r.tr_mul(&(a[k] + wd[k].cross(&p) + w[k].cross(&w[k].cross(&p))));
                let carried = r.tr_mul(&w[k]);
                wd[k] = r.tr_mul(&wd[k]) + carried.cross(&axis) * qd + axis * qdd;
                w[k] = carried + axis * qd;
                force = (a[k] + wd[k].cross(&c) + w[k].cross(&w[k].cross(&c))) * link.mass;
                let turning = link.inertia * wd[k] + w[k].cross(&(link.inertia * w[k]));
                moment = turning + c.cross(&force);
            } else if starts {
                a[k] = r.tr_mul(&(a[k] + wd[k].cross(&p)));
                wd[k] = r.tr_mul(&wd[k]) + axis * qdd;
                force = (a[k] + wd[k].cross(&c)) * link.mass;
                moment = link.inertia * wd[k] + c.cross(&force);
            } else {
                a[k] = r.tr_mul(&a[k]);
                force = a[k] * link.mass;
                moment = c.cross(&force);
            }
            forces[i][k] = force;
            moments[i][k] = moment;
        }
    }
    let mut tau = [[0.0; MAX_DOF]; N];
    for i in (0..=last).rev() {
        let joint = &joints[i];
        for k in 0..N {
            tau[k][i] = joint.axis.dot(&moments[i][k]);
            if i > 0 {
                let r = &rotations[k][i];
                let force = r * forces[i][k];
                let moment = r * moments[i][k] + joint.translation.cross(&force);
                forces[i - 1][k] += force;
                moments[i - 1][k] += moment;
            }
        }
    }
    for tau in &mut tau {
        *tau = geometry.from_serial_torque(*tau);
    }
    tau
}

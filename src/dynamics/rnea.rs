//! Inverse dynamics by the recursive Newton-Euler algorithm.
//!
//! R. Featherstone, "Rigid Body Dynamics Algorithms", 2008, chapter 5, written
//! out in vectors of three, each body in its own joint's frame.

use nalgebra::Vector3;

use crate::robot::{Link, MAX_DOF, Model};

use super::GRAVITY;
use super::data::Data;
use super::load::Load;
use super::motor_side::rotor_torques;

/// Torque of each joint \[Nm\] for the motion `q` \[rad\], `qd` \[rad/s\], `qdd`
/// \[rad/s²\] with `load` at the flange: rigid bodies and reflected rotors, no
/// friction. The inputs have one entry for each joint (a missing one is 0).
/// All zero where the robot has no dynamics.
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

/// The same without the rotors: the torque through the gears.
pub fn rigid_bodies(
    model: &Model,
    data: &mut Data,
    load: &Load,
    q: &[f64],
    qd: &[f64],
    qdd: &[f64],
) -> [f64; MAX_DOF] {
    let Some(loaded) = load.on(model) else { return [0.0; MAX_DOF] };
    turn(model, data, q);
    newton_euler(model, data, &loaded, qd, qdd)
}

/// [`rnea`] of several motions \[q̇, q̈\] from one position.
pub fn rnea_each<const N: usize>(
    model: &Model,
    data: &mut Data,
    load: &Load,
    q: &[f64],
    motions: [[&[f64]; 2]; N],
) -> [[f64; MAX_DOF]; N] {
    let Some(loaded) = load.on(model) else { return [[0.0; MAX_DOF]; N] };
    turn(model, data, q);
    motions.map(|[qd, qdd]| {
        let mut tau = newton_euler(model, data, &loaded, qd, qdd);
        for (sum, rotor) in tau.iter_mut().zip(rotor_torques(model, qdd)) {
            *sum += rotor;
        }
        tau
    })
}

/// Torque of each joint \[Nm\] that holds the robot still at `q` \[rad\].
pub fn gravity(model: &Model, data: &mut Data, load: &Load, q: &[f64]) -> [f64; MAX_DOF] {
    rnea(model, data, load, q, &[], &[])
}

/// Number of links that carry mass.
fn links(model: &Model) -> usize {
    model.links.len().min(model.kinematics.joints.len()).min(MAX_DOF)
}

/// Keeps the rotation of each joint at `q`.
fn turn(model: &Model, data: &mut Data, q: &[f64]) {
    let q = model.kinematics.to_serial(q);
    for (i, joint) in model.kinematics.joints.iter().enumerate().take(links(model)) {
        data.rotation[i] = joint.rotation_at(q[i]);
    }
}

/// The torques at the position that [`turn`] has kept, `loaded` being the last link.
fn newton_euler(
    model: &Model,
    data: &mut Data,
    loaded: &Link,
    qd: &[f64],
    qdd: &[f64],
) -> [f64; MAX_DOF] {
    let geometry = &model.kinematics;
    let [qd, qdd] = [qd, qdd].map(|values| geometry.to_serial(values));
    let mut tau = [0.0; MAX_DOF];
    let joints = &geometry.joints;
    let last = links(model) - 1;

    // Motion of the parent: angular velocity and acceleration, and acceleration
    // of its origin; gravity enters as an acceleration of the base.
    let mut w = Vector3::zeros();
    let mut wd = Vector3::zeros();
    let mut a = model.kinematics.up() * GRAVITY;
    for i in 0..=last {
        let joint = &joints[i];
        let link = if i == last { loaded } else { &model.links[i] };
        let r = data.rotation[i];
        let p = joint.translation;
        let axis = joint.axis.into_inner();
        a = r.tr_mul(&(a + wd.cross(&p) + w.cross(&w.cross(&p))));
        let carried = r.tr_mul(&w);
        wd = r.tr_mul(&wd) + carried.cross(&axis) * qd[i] + axis * qdd[i];
        w = carried + axis * qd[i];

        let c = link.com;
        let force = (a + wd.cross(&c) + w.cross(&w.cross(&c))) * link.mass;
        data.force[i] = force;
        data.moment[i] = link.inertia * wd + w.cross(&(link.inertia * w)) + c.cross(&force);
    }
    for i in (0..=last).rev() {
        tau[i] = joints[i].axis.dot(&data.moment[i]);
        if i > 0 {
            let force = data.rotation[i] * data.force[i];
            let moment = data.rotation[i] * data.moment[i] + joints[i].translation.cross(&force);
            data.force[i - 1] += force;
            data.moment[i - 1] += moment;
        }
    }
    geometry.from_serial_torque(tau)
}

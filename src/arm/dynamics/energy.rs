//! Kinetic and potential energy, summed over the bodies in the base frame; independent of the
//! inverse dynamics, which tests compare with them.

use nalgebra::{Matrix3, Vector3};

use crate::arm::robot::{GRAVITY, Link, MAX_DOF, Model};

use super::load::Load;
use super::motor_side::motor_rates;

/// Kinetic energy of links, load and rotors \[J\] at `q` \[rad\], `qd` \[rad/s\]; 0 if the robot
/// has no dynamics.
#[must_use]
pub fn kinetic_energy(model: &Model, load: &Load, q: &[f64], qd: &[f64]) -> f64 {
    let mut energy = 0.0;
    for_each_body(model, load, q, qd, |body| {
        let spin = body.rotation.tr_mul(&body.turning);
        energy += 0.5 * body.link.mass * body.velocity.norm_squared();
        energy += 0.5 * spin.dot(&(body.link.inertia * spin));
    });
    if let Some(motors) = model.motors.as_ref().filter(|_| model.has_dynamics()) {
        for (joint, velocity) in motor_rates(model, qd).iter().enumerate().take(model.dof) {
            energy += 0.5 * motors.reflected_inertia(joint) * velocity * velocity;
        }
    }
    energy
}

/// Potential energy of links and load \[J\] at `q` \[rad\] relative to the height of the base
/// frame; 0 if the robot has no dynamics.
#[must_use]
pub fn potential_energy(model: &Model, load: &Load, q: &[f64]) -> f64 {
    let up = model.kinematics.up();
    let mut energy = 0.0;
    for_each_body(model, load, q, &[], |body| {
        energy += body.link.mass * GRAVITY * body.com.dot(&up);
    });
    energy
}

/// A moving body in the base frame.
struct Body<'a> {
    link: &'a Link,
    rotation: Matrix3<f64>,
    com: Vector3<f64>,
    velocity: Vector3<f64>,
    turning: Vector3<f64>,
}

fn for_each_body(
    model: &Model,
    load: &Load,
    q: &[f64],
    qd: &[f64],
    mut visit: impl FnMut(&Body<'_>),
) {
    let Some(loaded) = load.on(model) else { return };
    let angles = model.kinematics.to_serial(q);
    let rates = model.kinematics.to_serial(qd);
    let mut rotation = Matrix3::identity();
    let mut origin = Vector3::zeros();
    let mut velocity = Vector3::zeros();
    let mut turning = Vector3::zeros();
    let bodies = model.kinematics.joints.iter().zip(&model.links).take(MAX_DOF);
    for (i, (joint, link)) in bodies.enumerate() {
        let step = rotation * joint.translation;
        origin += step;
        velocity += turning.cross(&step);
        rotation *= joint.rotation_at(angles[i]);
        turning += rotation * joint.axis.into_inner() * rates[i];
        let link = if i + 1 == model.dof { &loaded } else { link };
        let arm = rotation * link.com;
        visit(&Body {
            link,
            rotation,
            com: origin + arm,
            velocity: velocity + turning.cross(&arm),
            turning,
        });
    }
}

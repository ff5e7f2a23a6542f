//! Bodies and forces: payload, mounting, springs, hoses, contact.
//!
//! A. Klimchik et al., arXiv 1311.6674 (gravity compensators); R. Bouc 1967, Y.-K. Wen 1976
//! (hysteresis).
#![expect(clippy::unnecessary_wraps, reason = "the laws of all effects are drawn alike")]

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Unit, UnitQuaternion, Vector3};

use super::arm::Arm;
use super::law::{Law, gate, window};
use super::motion::Joints;
use super::series::driven;
use crate::arm::dynamics::{Data, Load, gravity};
use crate::arm::robot::{GRAVITY, Model};
use crate::examine::blind::random::Random;

/// Least and largest masses of a payload \[kg\].
const MASSES: [f64; 2] = [0.1, 8.0];
/// Least and largest tilts of the base \[rad\].
const TILTS: [f64; 2] = [0.002, 0.3];
/// Least and largest offsets of an encoder \[rad\].
const OFFSETS: [f64; 2] = [0.002, 0.3];
/// Least and largest contact forces \[N\].
const FORCES: [f64; 2] = [1.0, 150.0];
/// Least range of a joint whose spring can be seen \[rad\].
const RANGE: f64 = 0.8;

/// A box at the flange.
pub(super) fn payload<'a>(arm: &'a Arm, _: usize, random: &mut Random) -> Option<Law<'a>> {
    let com = Vector3::new(
        random.between(-0.08, 0.08),
        random.between(-0.08, 0.08),
        random.between(0.02, 0.12),
    );
    let sides = Vector3::from_fn(|_, _| random.between(0.05, 0.2));
    let torques = move |mass: f64| {
        let square = sides.component_mul(&sides) * (mass / 12.0);
        let inertia = Vector3::new(square.y + square.z, square.x + square.z, square.x + square.y);
        let load = Load { mass, com, inertia: Matrix3::from_diagonal(&inertia) };
        arm.changed(&arm.model, &load)
    };
    let law = Law::new("payload", "box", &[], MASSES, torques);
    let values = move |mass| {
        vec![
            ("mass", mass, true),
            ("com_x", com.x, false),
            ("com_y", com.y, false),
            ("com_z", com.z, false),
        ]
    };
    Some(law.with(values).like(&["link_parameters"]))
}

/// The model in a world whose vertical is `up` in the frame of its base.
fn with_up(model: &Model, up: &Vector3<f64>) -> Model {
    let mut turned = model.clone();
    let opposite = || UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI);
    turned.kinematics.base.rotation =
        UnitQuaternion::rotation_between(up, &Vector3::z()).unwrap_or_else(opposite);
    turned
}

/// A base that leans.
pub(super) fn base_tilt<'a>(arm: &'a Arm, _: usize, random: &mut Random) -> Option<Law<'a>> {
    let direction = random.between(-PI, PI);
    let axis = Unit::new_normalize(Vector3::new(-direction.sin(), direction.cos(), 0.0));
    let torques = move |angle: f64| {
        let lean = UnitQuaternion::from_axis_angle(&axis, angle);
        // The base leans: its frame sees the vertical turned back.
        let up = lean.inverse() * arm.model.kinematics.up();
        arm.changed(&with_up(&arm.model, &up), &Load::none())
    };
    let law = Law::new("base_tilt", "leaning", &[], TILTS, torques);
    Some(law.with(move |size| vec![("angle", size, true), ("direction", direction, false)]))
}

/// An encoder with a wrong zero; in one form it is mounted off its centre, too.
pub(super) fn encoder_offset<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (form, name) = random.form(["constant", "off_centre"]);
    let (sign, phase) = (random.sign(), random.between(0.0, TAU));
    let torques = move |offset: f64| {
        let motion = &arm.motion;
        arm.moved(|row| {
            let [mut q, mut qd, qdd] = [motion.q[row], motion.qd[row], motion.qdd[row]];
            let (sin, cos) = (q[joint] + phase).sin_cos();
            if form == 1 {
                qd[joint] *= 1.0 + 0.2 * sign * offset * cos;
            }
            q[joint] += sign * offset * if form == 0 { 1.0 } else { 1.0 + 0.2 * sin };
            [q, qd, qdd]
        })
    };
    let law = Law::new("encoder_offset", name, &[joint], OFFSETS, torques);
    Some(law.with(move |size| vec![("offset", sign * size, form == 0)]))
}

/// A balancer: a sine of the angle, or a spring whose lever changes.
pub(super) fn gravity_spring<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (form, name) = random.form(["sine", "lever"]);
    let [low, high] = arm.motion.range(joint);
    // Balancers are at axes 2 and 3.
    if high - low < RANGE || !(1..=2).contains(&joint) {
        return None;
    }
    let centre = low + (high - low) * random.between(0.2, 0.8);
    let (sign, lever) = (random.sign(), random.between(0.3, 0.6));
    let sizes = [0.01, 0.6].map(|share| share * arm.rms[joint]);
    let law = Law::scaled(["gravity_spring", name], arm, joint, sizes, |row| {
        let off = arm.motion.q[row][joint] - centre;
        let length = (1.0 + lever * lever - 2.0 * lever * off.cos()).sqrt();
        let shortest = 0.5 * (1.0 - lever);
        sign * off.sin() * if form == 0 { 1.0 } else { 1.0 - shortest / length }
    });
    let values = move |size| vec![("stiffness", sign * size, false), ("centre", centre, false)];
    Some(law.with(values))
}

/// A hose: a spring that hardens, with some hysteresis.
pub(super) fn cable<'a>(arm: &'a Arm, joint: usize, random: &mut Random) -> Option<Law<'a>> {
    let [low, high] = arm.motion.range(joint);
    let range = high - low;
    if range < RANGE || (1..=2).contains(&joint) {
        return None;
    }
    let centre = low + range * random.between(0.3, 0.7);
    let harder = random.between(0.3, 1.0) / (0.5 * range).powi(2);
    let (lost, yields) = (random.between(0.05, 0.12) * range, random.between(0.1, 0.2) * range);
    let q: Vec<f64> = arm.motion.q.iter().map(|q| q[joint]).collect();
    let (mut z, mut before) = (0.0_f64, q[0]);
    let unit = driven(&arm.motion.t, &q, 1e-3, |_, q| {
        let step = (q - before) / yields;
        before = q;
        z = (z + step - 0.5 * (step.abs() * z * z.abs() + step * z * z)).clamp(-1.0, 1.0);
        let off = q - centre;
        [off + harder * off.powi(3) + lost * z]
    });
    let sizes = [0.01, 0.6].map(|share| share * arm.rms[joint] / range);
    let law =
        Law::scaled(["cable", "hardening_with_hysteresis"], arm, joint, sizes, |row| unit[row][0]);
    let values = move |size| vec![("stiffness", size, false), ("centre", centre, false)];
    Some(law.with(values))
}

/// A force on the flange for some time, in one form unsteady.
///
/// Holding a force is holding a weight in another direction of gravity.
pub(super) fn contact<'a>(arm: &'a Arm, _: usize, random: &mut Random) -> Option<Law<'a>> {
    let (form, name) = random.form(["steady", "unsteady"]);
    let window = window(arm, [0.3, 0.5], random);
    let (azimuth, height) = (random.between(0.0, TAU), random.between(-1.0, 1.0));
    let flat = f64::sqrt(1.0 - height * height);
    let force = Vector3::new(flat * azimuth.cos(), flat * azimuth.sin(), height);
    let n = arm.dof();
    let turned = with_up(&arm.model, &-force);
    let weight = Load { mass: 1.0 / GRAVITY, com: Vector3::zeros(), inertia: Matrix3::zeros() };
    let mut data = Data::new();
    let held = |(row, q): (usize, &Joints)| {
        let t = arm.motion.t[row];
        let size = gate(t, window) * if form == 0 { 1.0 } else { 1.0 + 0.3 * (9.0 * t).sin() };
        let with = gravity(&turned, &mut data, &weight, &q[..n]);
        let without = gravity(&turned, &mut data, &Load::none(), &q[..n]);
        std::array::from_fn(|joint| size * (with[joint] - without[joint]))
    };
    let unit: Vec<Joints> = arm.motion.q.iter().enumerate().map(held).collect();
    let torques = move |size: f64| unit.iter().map(|of| of.map(|torque| size * torque)).collect();
    let law = Law::new("contact", name, &[], FORCES, torques);
    let values = move |size| {
        vec![("force", size, false), ("t_start_s", window[0], false), ("t_end_s", window[1], false)]
    };
    Some(law.with(values).within(window))
}

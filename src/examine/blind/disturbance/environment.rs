//! Faults of bodies, springs and external forces.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};

use super::super::action::Action;
use super::super::fault::Disturbance;
use super::super::mechanics::add;
use super::super::plant::Plant;
use super::super::random::Random;
use super::super::scale::Scale;
use super::laws::{NONE, change};

/// Wrist joints, from 0.
const WRIST: [usize; 3] = [3, 4, 5];

fn plant(change: impl Fn(&mut Plant) + Send + Sync + 'static) -> Action {
    Action::Plant(Box::new(change))
}

pub(super) fn payload(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let arm: f64 = scale.plant.bodies.iter().map(|body| body.mass).sum();
    let mass = arm * random.log_between(0.003, 0.05);
    let size = (mass / 2000.0).cbrt();
    let com = Vector3::new(
        size * random.normal_within(2.0),
        size * random.normal_within(2.0),
        size * random.between(0.5, 2.5),
    );
    let (form, name) = random.form(["box", "point", "dumbbell", "long_tool"]);
    let sides = match form {
        1 => Vector3::zeros(),
        2 => Vector3::new(6.0 * size, 0.5 * size, 0.5 * size),
        3 => Vector3::new(0.4 * size, 0.4 * size, 5.0 * size),
        _ => Vector3::from_fn(|_, _| size * random.between(0.6, 1.6)),
    };
    let square = |axis: usize| mass * sides[axis] * sides[axis] / 12.0;
    let inertia = Matrix3::from_diagonal(&Vector3::new(
        square(1) + square(2),
        square(0) + square(2),
        square(0) + square(1),
    ));
    Disturbance::new("payload", name, &[])
        .graded("mass", mass)
        .with("com_x", com.x)
        .with("com_y", com.y)
        .with("com_z", com.z)
        .acting(plant(move |plant| {
            let body = plant.on_flange(mass, com, inertia);
            plant.bodies.push(body);
        }))
}

pub(super) fn link_parameters(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    // The weight of the first link acts on no joint.
    let link = 1 + random.below(scale.plant.dof.saturating_sub(2).max(1));
    let (form, name) = random.form(["mass", "centre_of_mass", "inertia"]);
    let factor = 1.0 + random.sign() * random.between(0.15, 0.6);
    let shift = Vector3::from_fn(|_, _| random.sign() * random.between(0.01, 0.04));
    let mut disturbance = Disturbance::at_joint("link_parameters", name, link);
    if form == 0 {
        let mass = scale.plant.bodies.get(link).map_or(0.0, |body| body.mass);
        disturbance = disturbance.with("mass", (factor - 1.0) * mass);
    }
    disturbance.acting(plant(move |plant| {
        let Some(body) = plant.bodies.get_mut(link) else { return };
        match form {
            0 => {
                body.mass *= factor;
                body.inertia *= factor;
            }
            1 => body.com += shift,
            _ => body.inertia *= factor * factor,
        }
    }))
}

pub(super) fn rotor_inertia(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let least = 3.3 * scale.trust.inertia;
    let sign = if least < 0.3 && random.chance(0.4) { -1.0 } else { 1.0 };
    let share = (sign * random.log_between(least, 5.0 * least)).max(-0.7);
    let inertia = share * scale.plant.rotor[joint];
    let (form, name) = random.form(["constant", "with_churning_oil", "with_eccentric_disc"]);
    let fastest = scale.fastest[joint].max(1e-3);
    let equal: &[&str] = if joint < 2 { &["link_parameters"] } else { &[] };
    Disturbance::at_joint("rotor_inertia", name, joint)
        .with("inertia", inertia)
        .like(equal)
        .motor_torque(joint, move |m| {
            let moved = match form {
                1 => 1.0 + 0.03 * (m.rate[joint] / fastest).powi(2),
                2 => 1.0 + 0.03 * m.q[joint].cos(),
                _ => 1.0,
            };
            inertia * moved * m.acceleration[joint]
        })
}

pub(super) fn gravity_spring(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.one_of(&[1, 1, 2], random);
    let size = random.log_between(0.05, 0.6) * scale.rms[joint];
    let [low, high] = scale.workspace.range[joint];
    let centre = random.between(low, high);
    let stiffness = size / 0.7;
    let (form, name) = random.form(["linear", "rod_and_spring", "gas_cylinder"]);
    Disturbance::at_joint("gravity_spring", name, joint)
        .with("stiffness", stiffness)
        .with("centre", centre)
        .joint_torque(joint, move |m| {
            let x = m.q[joint] - centre;
            match form {
                // A spring between circles of radius 1 and 0.4, longer by a third at rest.
                1 => {
                    let length = (1.16 - 0.8 * x.cos()).sqrt();
                    stiffness * 1.6 * (1.0 - 0.4 / length) * x.sin()
                }
                2 => stiffness * x.sin() * (1.0 + 0.15 * x.cos()),
                _ => stiffness * x,
            }
        })
}

pub(super) fn base_tilt(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let angle = random.log_between(0.2, 3.0).to_radians();
    let direction = random.between(0.0, TAU);
    let (form, name) = random.form(["fixed", "yielding", "settling"]);
    let period = scale.period_s;
    let up = scale.plant.up;
    let axis = Unit::new_normalize(Vector3::new(-direction.sin(), direction.cos(), 0.0));
    let tilted = Rotation3::from_axis_angle(&axis, angle) * up;
    let difference = tilted - up;
    let disturbance = Disturbance::new("base_tilt", name, &[])
        .graded("angle", angle)
        .with("direction", direction)
        .acting(plant(move |plant| plant.up += difference));
    if form == 0 {
        return disturbance;
    }
    // A floor that tilts slightly with the arm's reach or with time.
    let weight = Plant { up: difference, ..scale.plant.clone() };
    disturbance.acting(Action::Joints(change(move |m, tau| {
        let share = match form {
            1 => 0.02 * (m.q[0] - direction).cos(),
            _ => -0.02 * (-m.t / (8.0 * period)).exp(),
        };
        let more = weight.rigid(&m.q, &NONE, &NONE);
        add(tau, &more.map(|part| share * part));
    })))
}

pub(super) fn cable(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.one_of(&[0, 3, 4, 5], random);
    let [low, high] = scale.workspace.range[joint];
    let half = (0.5 * (high - low)).max(0.1);
    let size = random.log_between(0.04, 0.4) * scale.rms[joint];
    let stiffness = size / (0.6 * half);
    let centre = random.between(low, high);
    let (form, name) = random.form(["linear", "stiffening", "taut_on_one_side", "slipping"]);
    Disturbance::at_joint("cable", name, joint)
        .with("stiffness", stiffness)
        .with("centre", centre)
        .joint_torque(joint, move |m| {
            let x = m.q[joint] - centre;
            stiffness
                * match form {
                    1 => x * (0.4 + 0.6 * (x / half).powi(2)),
                    2 => 2.0 * x.max(0.0),
                    3 => half * (x / half * 1.5).tanh(),
                    _ => x,
                }
        })
}

pub(super) fn wrist_coupling(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    // The coupling in the nominal model, and the true one.
    let before = scale.plant.coupling;
    let away = random.sign() * random.log_between(0.15, 1.0);
    let coupling = if (before + away).abs() > 1.2 { before - away } else { before + away };
    let (form, name) = random.form(["geared", "friction_only", "rounded_friction"]);
    let disturbance =
        Disturbance::new("wrist_coupling", name, &[4, 5]).with("coupling", coupling - before);
    if form == 0 {
        return disturbance.acting(plant(move |plant| plant.coupling = coupling));
    }
    let narrow = 0.02 * scale.fastest[5].max(1e-3);
    disturbance.acting(Action::Joints(change(move |m, tau| {
        let law = |v: f64| {
            let dry = if form == 1 { v.signum() } else { (v / narrow).tanh() };
            m.coulomb[5] * if v == 0.0 { 0.0 } else { dry } + m.viscous[5] * v
        };
        let (was, is) = (m.qd[5] + before * m.qd[4], m.qd[5] + coupling * m.qd[4]);
        tau[5] += law(is) - law(was);
        tau[4] += coupling * law(is) - before * law(was);
    })))
}

pub(super) fn contact(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let weight: f64 = scale.plant.bodies.iter().map(|body| body.mass).sum::<f64>() * 9.81;
    let force = weight * random.log_between(0.005, 0.06);
    let start = random.between(0.05, 0.7) * scale.period_s;
    let end = start + random.between(0.06, 0.2) * scale.period_s;
    let (form, name) = random.form(["constant", "half_sine", "spring", "chattering"]);
    let (azimuth, height) = (random.between(0.0, TAU), random.between(-1.0, 1.0));
    let flat = (1.0 - height * height).sqrt();
    let direction = Vector3::new(flat * azimuth.cos(), flat * azimuth.sin(), height);
    let arm = scale.plant.clone();
    let force_of_contact = change(move |m, tau| {
        if !(start..end).contains(&m.in_period) {
            return;
        }
        let x = (m.in_period - start) / (end - start);
        let size = match form {
            1 => (PI * x).sin(),
            2 => (3.0 * x.min(1.0 - x)).min(1.0),
            3 => 0.8 + 0.2 * (40.0 * m.in_period).sin(),
            _ => 1.0,
        };
        let axes = arm.axes(&m.q, &NONE, &NONE);
        let tip = arm.geometry.flange.translation.vector;
        let last = arm.dof - 1;
        let mut more = NONE;
        axes.add_force(last, &axes.point(last, &tip), &(direction * force * size), &mut more);
        add(tau, &arm.geometry.from_serial_torque(more));
    });
    Disturbance::new("contact", name, &[])
        .with("force", force)
        .with("t_start_s", start)
        .with("t_end_s", end)
        .within([start, end])
        .acting(Action::Joints(force_of_contact))
}

/// A wrist cable with hysteresis (R. Bouc 1967, Y.-K. Wen 1976).
pub(super) fn hysteretic_cable(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.one_of(&WRIST, random);
    let size = random.log_between(0.05, 0.3) * scale.rms[joint];
    let yields_at = random.between(0.15, 0.5);
    let mut z = 0.0_f64;
    Disturbance::at_joint("outside", "hysteretic_cable", joint).joint_torque(joint, move |m| {
        let step = m.qd[joint] * m.dt / yields_at;
        z += step - 0.5 * (step.abs() * z * z.abs() + step * z.powi(2));
        z = z.clamp(-1.5, 1.5);
        size * (z + 0.3 * m.q[joint].sin())
    })
}

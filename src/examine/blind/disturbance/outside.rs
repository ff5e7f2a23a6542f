//! Faults without a corresponding effect in the library: the expected verdict is unknown.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::super::action::{Action, Begin};
use super::super::fault::Disturbance;
use super::super::random::Random;
use super::super::scale::{Draw, Scale};
use super::laws::{NONE, memoryless, with_state};
use super::{electrical, environment};

const KINDS: [Draw; 11] = [
    environment::hysteretic_cable,
    electrical::resonance,
    moving_base,
    drift_with_load,
    friction_of_acceleration,
    cross_talk,
    clipped_and_wound_up,
    smooth_of_two_positions,
    friction_of_another_joint,
    chatter,
    viscous_of_load,
];

/// One of these faults.
pub(super) fn outside(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    KINDS[random.below(KINDS.len())](scale, random)
}

/// A joint other than `joint`.
fn other(scale: &Scale<'_>, joint: usize, random: &mut Random) -> usize {
    let n = scale.plant.dof;
    (joint + 1 + random.below(n.saturating_sub(1))) % n
}

/// The base accelerates on a track, synchronously with the cycle.
fn moving_base(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let push = random.log_between(0.1, 1.0);
    let azimuth = random.between(0.0, TAU);
    let direction = Vector3::new(azimuth.cos(), azimuth.sin(), 0.0);
    let waves: Vec<[f64; 3]> = (0..4)
        .map(|_| {
            let harmonic = 1.0 + random.below(9) as f64;
            [harmonic * TAU / scale.period_s, random.normal(), random.between(0.0, TAU)]
        })
        .collect();
    let weightless = scale.plant.clone();
    let begin: Begin = Box::new(move || {
        let (mut arm, waves) = (weightless.clone(), waves.clone());
        Box::new(move |m, tau| {
            let wave = |[omega, size, phase]: &[f64; 3]| size * (omega * m.in_period + phase).sin();
            arm.up = direction * (push * waves.iter().map(wave).sum::<f64>());
            for (sum, part) in tau.iter_mut().zip(arm.rigid(&m.q, &NONE, &NONE)) {
                *sum += part;
            }
        })
    });
    Disturbance::new("outside", "moving_base", Vec::new()).acting(Action::Joints(begin))
}

/// An offset that drifts with the square of the load.
fn drift_with_load(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let typical = scale.rms[joint].max(1e-6);
    let size = random.sign() * random.log_between(0.05, 0.3) * typical;
    let slow = random.between(1.0, 8.0);
    Disturbance::at_joint("outside", "drift_with_load", joint).acting(Action::Joints(with_state(
        joint,
        1.0,
        move |heat: &mut f64, m| {
            let hot = (m.load[joint] / typical).powi(2).min(9.0);
            *heat += m.dt / slow * (hot - *heat);
            size * (*heat - 1.0)
        },
    )))
}

fn friction_of_acceleration(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let share = random.log_between(0.1, 0.6);
    let knee = 0.3 * scale.workspace.acceleration[joint].max(0.1);
    Disturbance::at_joint("outside", "friction_of_acceleration", joint).acting(Action::Gears(
        memoryless(joint, move |m| {
            let pushed = (m.acceleration[joint] * m.sign[joint] / knee).tanh();
            share * m.coulomb[joint] * pushed * m.sign[joint]
        }),
    ))
}

/// The current of one joint leaks into that of another joint.
fn cross_talk(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let from = other(scale, joint, random);
    let ratio = scale.rms[joint] / scale.rms[from].max(1e-6);
    let share = random.sign() * random.log_between(0.04, 0.3) * ratio;
    Disturbance::at_joint("outside", "cross_talk", joint).acting(Action::Torques(Box::new(
        move || Box::new(move |_, tau| tau[joint] += share * tau[from]),
    )))
}

/// A torque limit; the missing part follows later.
fn clipped_and_wound_up(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let limit = random.between(0.55, 0.85) * scale.peak[joint];
    let unwinds = random.between(2.0, 10.0);
    Disturbance::at_joint("outside", "clipped_and_wound_up", joint).acting(Action::Torques(
        Box::new(move || {
            let mut owed = 0.0;
            Box::new(move |m, tau| {
                let wanted = tau[joint];
                let given = (wanted + unwinds * owed).clamp(-limit, limit);
                owed = (owed + (wanted - given) * m.dt).clamp(-0.1 * limit, 0.1 * limit);
                tau[joint] = given;
            })
        }),
    ))
}

/// A random smooth torque as a function of two joint positions.
fn smooth_of_two_positions(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let second = other(scale, joint, random);
    let size = random.log_between(0.04, 0.3) * scale.rms[joint];
    let waves: [[f64; 4]; 4] = std::array::from_fn(|_| {
        [random.normal(), random.normal(), random.between(0.0, TAU), 0.7 * random.normal()]
    });
    Disturbance::at_joint("outside", "smooth_of_two_positions", joint).acting(Action::Joints(
        memoryless(joint, move |m| {
            let wave = |[a, b, phase, c]: [f64; 4]| {
                c * (1.5 * a * m.q[joint] + 1.5 * b * m.q[second] + phase).sin()
            };
            size * waves.into_iter().map(wave).sum::<f64>()
        }),
    ))
}

/// Dry friction that depends on the position of another joint.
fn friction_of_another_joint(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let second = other(scale, joint, random);
    let share = random.log_between(0.15, 0.7);
    let phase = random.between(0.0, TAU);
    Disturbance::at_joint("outside", "friction_of_another_joint", joint).acting(Action::Gears(
        memoryless(joint, move |m| {
            share * m.coulomb[joint] * (1.7 * m.q[second] + phase).sin() * m.sign[joint]
        }),
    ))
}

/// A control loop that chatters at low speed.
fn chatter(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let size = random.log_between(0.1, 0.6) * scale.plant.coulomb[joint];
    let omega = TAU * random.between(6.0, 14.0);
    let slow = 0.15 * scale.fastest[joint].max(1e-3);
    Disturbance::at_joint("outside", "chatter", joint).acting(Action::Gears(memoryless(
        joint,
        move |m| {
            let awake = (-(m.rate[joint] / slow).powi(2)).exp();
            size * awake * (omega * m.in_period).sin()
        },
    )))
}

/// Viscous friction that increases with the load.
fn viscous_of_load(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let typical = scale.load[joint].max(1e-6);
    let share = random.log_between(0.15, 0.8);
    Disturbance::at_joint("outside", "viscous_of_load", joint)
        .acting(Action::Gears(memoryless(joint, move |m| {
            share * m.viscous[joint] * m.rate[joint] * m.load[joint] / typical
        })))
}

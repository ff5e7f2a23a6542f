//! Faults without a corresponding effect in the library: the expected verdict is unknown.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::super::action::Action;
use super::super::fault::Disturbance;
use super::super::mechanics::add;
use super::super::random::Random;
use super::super::scale::{Draw, Scale};
use super::laws::{NONE, change};
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
    let mut arm = scale.plant.clone();
    let shaken = change(move |m, tau| {
        let wave = |[omega, size, phase]: &[f64; 3]| size * (omega * m.in_period + phase).sin();
        arm.up = direction * (push * waves.iter().map(wave).sum::<f64>());
        add(tau, &arm.rigid(&m.q, &NONE, &NONE));
    });
    Disturbance::new("outside", "moving_base", &[]).acting(Action::Joints(shaken))
}

/// An offset that drifts with the square of the load.
fn drift_with_load(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let typical = scale.rms[joint].max(1e-6);
    let size = random.sign() * random.log_between(0.05, 0.3) * typical;
    let slow = random.between(1.0, 8.0);
    let mut heat = 1.0;
    Disturbance::at_joint("outside", "drift_with_load", joint).joint_torque(joint, move |m| {
        let hot = (m.load[joint] / typical).powi(2).min(9.0);
        heat += m.dt / slow * (hot - heat);
        size * (heat - 1.0)
    })
}

fn friction_of_acceleration(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let share = random.log_between(0.1, 0.6);
    let knee = 0.3 * scale.workspace.acceleration[joint].max(0.1);
    Disturbance::at_joint("outside", "friction_of_acceleration", joint).motor_torque(
        joint,
        move |m| {
            let pushed = (m.acceleration[joint] * m.sign[joint] / knee).tanh();
            share * m.coulomb[joint] * pushed * m.sign[joint]
        },
    )
}

/// The current of one joint leaks into that of another joint.
fn cross_talk(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let from = other(scale, joint, random);
    let ratio = scale.rms[joint] / scale.rms[from].max(1e-6);
    let share = random.sign() * random.log_between(0.04, 0.3) * ratio;
    let leak = change(move |_, tau| tau[joint] += share * tau[from]);
    Disturbance::at_joint("outside", "cross_talk", joint).acting(Action::Torques(leak))
}

/// A torque limit; the missing part follows later.
fn clipped_and_wound_up(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let limit = random.between(0.55, 0.85) * scale.peak[joint];
    let unwinds = random.between(2.0, 10.0);
    let mut owed = 0.0;
    Disturbance::at_joint("outside", "clipped_and_wound_up", joint).logged_torque(
        joint,
        move |m, wanted| {
            let given = (wanted + unwinds * owed).clamp(-limit, limit);
            owed = (owed + (wanted - given) * m.dt).clamp(-0.1 * limit, 0.1 * limit);
            given
        },
    )
}

/// A random smooth torque as a function of two joint positions.
fn smooth_of_two_positions(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let second = other(scale, joint, random);
    let size = random.log_between(0.04, 0.3) * scale.rms[joint];
    let waves: [[f64; 4]; 4] = std::array::from_fn(|_| {
        [random.normal(), random.normal(), random.between(0.0, TAU), 0.7 * random.normal()]
    });
    Disturbance::at_joint("outside", "smooth_of_two_positions", joint).joint_torque(
        joint,
        move |m| {
            let wave = |[a, b, phase, c]: [f64; 4]| {
                c * (1.5 * a * m.q[joint] + 1.5 * b * m.q[second] + phase).sin()
            };
            size * waves.into_iter().map(wave).sum::<f64>()
        },
    )
}

/// Dry friction that depends on the position of another joint.
fn friction_of_another_joint(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let second = other(scale, joint, random);
    let share = random.log_between(0.15, 0.7);
    let phase = random.between(0.0, TAU);
    Disturbance::at_joint("outside", "friction_of_another_joint", joint)
        .motor_torque(joint, move |m| {
            share * m.coulomb[joint] * (1.7 * m.q[second] + phase).sin() * m.sign[joint]
        })
}

/// A control loop that chatters at low speed.
fn chatter(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let size = random.log_between(0.1, 0.6) * scale.plant.coulomb[joint];
    let omega = TAU * random.between(6.0, 14.0);
    let slow = 0.15 * scale.fastest[joint].max(1e-3);
    Disturbance::at_joint("outside", "chatter", joint).motor_torque(joint, move |m| {
        let awake = (-(m.rate[joint] / slow).powi(2)).exp();
        size * awake * (omega * m.in_period).sin()
    })
}

/// Viscous friction that increases with the load.
fn viscous_of_load(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let typical = scale.load[joint].max(1e-6);
    let share = random.log_between(0.15, 0.8);
    Disturbance::at_joint("outside", "viscous_of_load", joint).motor_torque(joint, move |m| {
        share * m.viscous[joint] * m.rate[joint] * m.load[joint] / typical
    })
}

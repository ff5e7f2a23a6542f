//! Errors of the measured torque.
#![expect(clippy::unnecessary_wraps, reason = "the laws of all effects are drawn alike")]

use std::f64::consts::TAU;

use super::arm::Arm;
use super::law::{Law, signs};
use super::motion::Joints;
use super::series::{driven, linear_at};
use crate::arm::robot::MAX_DOF;
use crate::examine::blind::random::Random;

/// Least and largest relative errors of a torque constant.
const ERRORS: [f64; 2] = [0.01, 0.5];
/// Least and largest delays \[s\].
const DELAYS: [f64; 2] = [0.0005, 0.028];
/// Longest integration step of a filter \[s\].
const STEP_S: f64 = 5e-4;

/// An offset of the amplifier, or Coulomb friction that differs by direction, which is the same
/// while the joint moves.
pub(super) fn torque_offset<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (form, name) = random.form(["coulomb_asymmetry", "slow_wander"]);
    let (sign, phase) = (random.sign(), random.between(0.0, TAU));
    let signs = signs(arm, joint);
    let sizes = [0.005, 0.3].map(|share| share * arm.rms[joint]);
    let law = Law::scaled(["torque_offset", name], arm, joint, sizes, |row| {
        let x = arm.motion.since_start(row) / arm.motion.duration();
        sign * match form {
            0 => signs[row] * signs[row],
            _ => 1.0 + 0.15 * (TAU * x + phase).sin(),
        }
    });
    Some(law.with(move |size| vec![("offset", sign * size, form == 0)]))
}

/// A torque constant that differs from its data sheet; in one form it falls as the motor warms up.
pub(super) fn torque_constant<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (form, name) = random.form(["constant", "warming_magnets"]);
    let sign = random.sign();
    let law = Law::scaled(["torque_constant", name], arm, joint, ERRORS, |row| {
        let x = arm.motion.since_start(row) / arm.motion.duration();
        let grows = if form == 0 { 1.0 } else { 0.8 + 0.4 * x };
        sign * grows * arm.tau[row][joint]
    });
    Some(law.with(move |size| vec![("error", sign * size, form == 0)]))
}

/// Iron that saturates: the current grows faster than the torque, as a cubic or a hyperbolic sine.
pub(super) fn current_saturation<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (form, name) = random.form(["cubic", "sinh"]);
    let peak = arm.tau.iter().map(|tau| tau[joint].abs()).fold(0.0, f64::max);
    let strength = random.between(1.5, 3.0);
    let scale = strength.sinh() / strength - 1.0;
    let law = Law::scaled(["current_saturation", name], arm, joint, [0.02, 0.8], |row| {
        let x = arm.tau[row][joint] / peak;
        peak * match form {
            0 => x.powi(3),
            _ => ((strength * x).sinh() / strength - x) / scale,
        }
    });
    Some(law.with(|size| vec![("error", size, false)]))
}

/// A field that is weakened at high speed, with a smooth onset.
pub(super) fn flux_weakening<'a>(
    arm: &'a Arm,
    joint: usize,
    random: &mut Random,
) -> Option<Law<'a>> {
    let (form, name) = random.form(["softplus", "quadratic"]);
    let velocity = arm.motion.rate_quantile(joint, random.between(0.5, 0.7));
    let fastest = arm.motion.rate_quantile(joint, 1.0);
    let width = 0.1 * fastest;
    let onset = |v: f64| match form {
        0 => ((v - velocity) / width).exp().ln_1p() * width,
        _ => (v - velocity).max(0.0).powi(2),
    };
    let full = onset(fastest);
    let law = Law::scaled(["flux_weakening", name], arm, joint, [0.02, 0.8], |row| {
        onset(arm.motion.qd[row][joint].abs()) / full * arm.tau[row][joint]
    });
    Some(law.with(move |size| vec![("error", size, false), ("velocity", velocity, false)]))
}

/// Torques that are logged later than the positions: the delay wanders, or the torques come over a
/// slower bus and are held.
pub(super) fn time_delay<'a>(arm: &'a Arm, _: usize, random: &mut Random) -> Option<Law<'a>> {
    let (form, name) = random.form(["wandering", "held"]);
    let phase = random.between(0.0, TAU);
    let torques = move |delay: f64| {
        let t = &arm.motion.t;
        let taken = |row: usize| match form {
            0 => {
                let x = arm.motion.since_start(row) / arm.motion.duration();
                t[row] - delay * (1.0 + 0.2 * (3.0 * TAU * x + phase).sin())
            }
            // Held values are late by half of the bus cycle in the mean.
            _ => (t[row] / (2.0 * delay)).floor() * 2.0 * delay,
        };
        changed(arm, |torque| {
            let late = |row: usize| linear_at(t, torque, taken(row)) - torque[row];
            (0..t.len()).map(late).collect()
        })
    };
    let law = Law::new("time_delay", name, &[], DELAYS, torques);
    Some(law.with(|size| vec![("delay", size, true)]).like(&["filter_lag"]))
}

/// Torques after a second-order filter.
pub(super) fn filter_lag<'a>(arm: &'a Arm, _: usize, random: &mut Random) -> Option<Law<'a>> {
    let (form, name) = random.form(["butterworth", "critically_damped"]);
    let damping = if form == 0 { std::f64::consts::FRAC_1_SQRT_2 } else { 1.0 };
    let torques = move |lag: f64| {
        let frequency = 2.0 * damping / lag;
        let longest = STEP_S.min(0.1 / frequency);
        changed(arm, |torque| {
            let (mut y, mut rate) = (torque[0], 0.0);
            let filtered = driven(&arm.motion.t, torque, longest, |h, input| {
                rate += h * frequency * (frequency * (input - y) - 2.0 * damping * rate);
                y += h * rate;
                [y]
            });
            filtered.iter().zip(torque).map(|([y], torque)| y - torque).collect()
        })
    };
    let law = Law::new("filter_lag", name, &[], DELAYS, torques);
    Some(law.with(|size| vec![("lag", size, false)]).like(&["time_delay"]))
}

/// The change of each joint's torque at the rows, from its torque of the model: the noise of the log
/// stays, since a late noise is as likely as the noise itself.
fn changed(arm: &Arm, change: impl Fn(&[f64]) -> Vec<f64>) -> Vec<Joints> {
    let mut all = vec![[0.0; MAX_DOF]; arm.tau.len()];
    for joint in 0..arm.dof() {
        let of_row = |(tau, left): (&Joints, &Joints)| tau[joint] - left[joint];
        let torque: Vec<f64> = arm.tau.iter().zip(&arm.residual).map(of_row).collect();
        for (row, torque) in all.iter_mut().zip(change(&torque)) {
            row[joint] = torque;
        }
    }
    all
}

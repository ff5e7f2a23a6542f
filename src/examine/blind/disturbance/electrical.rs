//! Faults in the relation of motor torque and current.

use std::f64::consts::{PI, TAU};

use super::super::fault::Disturbance;
use super::super::random::Random;
use super::super::scale::Scale;

/// Iterations of the inversion of a motor's curve.
const STEPS: usize = 30;

pub(super) fn torque_constant(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let error = random.sign() * random.log_between(0.02, 0.15);
    let (form, name) = random.form(["constant", "with_commutation", "noisy_scale"]);
    let order = scale.ratio[joint] * 3.0;
    let wobble = random.between(0.5, 1.5);
    Disturbance::at_joint("torque_constant", name, joint).graded("error", error).logged_torque(
        joint,
        move |m, tau| {
            let ripple = match form {
                1 => 0.002 * (order * m.q[joint]).cos(),
                2 => 0.001 * (wobble * m.t).sin(),
                _ => 0.0,
            };
            tau * (1.0 + error + ripple)
        },
    )
}

pub(super) fn current_sign(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let (form, name) = random.form(["flipped", "flipped_with_offset", "flipped_and_scaled"]);
    let offset = 0.003 * scale.rms[joint];
    Disturbance::at_joint("current_sign", name, joint).logged_torque(
        joint,
        move |_, tau| match form {
            1 => -tau + offset,
            2 => -1.005 * tau,
            _ => -tau,
        },
    )
}

pub(super) fn current_saturation(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let error = random.log_between(0.02, 0.18);
    let peak = scale.peak[joint].max(1e-6);
    let (form, name) = random.form(["cubic", "hyperbolic_tangent", "square", "knee"]);
    // Torque as a function of current, both relative to the peak; at the peak the current exceeds
    // the torque by `error`.
    let curve = move |i: f64| match form {
        1 => {
            let a = 0.58 / error.sqrt();
            a * (i / a).tanh()
        }
        2 => i - error / (1.0 + error).powi(2) * i * i.abs(),
        3 => i - 2.0 * error * (i - i.clamp(-0.5, 0.5)),
        _ => i * (1.0 - error / (1.0 + error).powi(3) * i * i),
    };
    Disturbance::at_joint("current_saturation", name, joint).with("error", error).logged_torque(
        joint,
        move |_, tau| {
            let wanted = tau / peak;
            let mut i = wanted;
            for _ in 0..STEPS {
                i += wanted - curve(i);
            }
            peak * i.clamp(-3.0, 3.0)
        },
    )
}

pub(super) fn flux_weakening(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let error = random.log_between(0.03, 0.25);
    let fastest = scale.fastest[joint].max(1e-3);
    let from = random.between(0.35, 0.75);
    let (form, name) = random.form(["square_beyond", "kinked", "smooth", "cosine"]);
    Disturbance::at_joint("flux_weakening", name, joint)
        .with("velocity", from * fastest)
        .with("error", error)
        .logged_torque(joint, move |m, tau| {
            let x = (m.rate[joint] / fastest).abs();
            let beyond = ((x - from) / (1.0 - from)).max(0.0);
            let share = match form {
                0 => beyond * beyond,
                2 => 1.0 / (1.0 + ((0.5 * (1.0 + from) - x) / (0.12 * (1.0 - from))).exp()),
                3 => 0.5 * (1.0 - (PI * beyond.min(1.0)).cos()),
                _ => beyond,
            };
            tau * (1.0 + error * share)
        })
}

pub(super) fn ripple(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let amplitude = random.log_between(0.01, 0.12) * scale.rms[joint];
    let order = match random.below(3) {
        0 => scale.ratio[joint],
        1 => 2.0 * scale.ratio[joint],
        _ => random.between(8.0, 40.0).round(),
    };
    let phase = random.between(0.0, TAU);
    let (form, name) = random.form(["cosine", "two_harmonics", "triangle", "growing_with_load"]);
    let typical = scale.rms[joint].max(1e-6);
    Disturbance::at_joint("ripple", name, joint)
        .with("amplitude", amplitude)
        .with("order", order)
        .motor_torque(joint, move |m| {
            let angle = order * m.q[joint] + phase;
            amplitude
                * match form {
                    1 => 0.9 * angle.cos() + 0.35 * (2.0 * angle + phase).cos(),
                    2 => angle.cos().asin() * 2.0 / PI,
                    3 => angle.cos() * (0.5 + 0.5 * m.load[joint].abs() / typical),
                    _ => angle.cos(),
                }
        })
}

/// A current that follows the torque with a resonance.
pub(super) fn resonance(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let omega = TAU * random.between(3.0, 9.0);
    let damping = random.between(0.02, 0.08);
    let share = random.log_between(0.1, 0.5);
    let [mut x, mut v] = [0.0; 2];
    Disturbance::at_joint("outside", "resonance", joint)
        .with("frequency", omega / TAU)
        .joint_torque(joint, move |m| {
            v += m.dt * (omega * omega * (m.load[joint] - x) - 2.0 * damping * omega * v);
            x += m.dt * v;
            share * (x - m.load[joint])
        })
}

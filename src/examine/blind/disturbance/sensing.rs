//! Faults of sensing and logging.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use super::super::action::Action;
use super::super::fault::Disturbance;
use super::super::mechanics::Joints;
use super::super::random::Random;
use super::super::scale::Scale;
use super::laws::{NONE, change};

pub(super) fn encoder_offset(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let (form, name) = random.form(["constant", "motor_turn", "with_eccentricity"]);
    let offset = random.sign()
        * match form {
            1 => TAU / scale.ratio[joint].max(1.0),
            _ => random.log_between(2e-3, 60e-3),
        };
    let phase = random.between(0.0, TAU);
    Disturbance::at_joint("encoder_offset", name, joint).graded("offset", offset).acting(
        Action::Positions(change(move |_, q| {
            let eccentric = if form == 2 { 0.01 * offset * (q[joint] + phase).cos() } else { 0.0 };
            q[joint] = q[joint] - offset - eccentric;
        })),
    )
}

pub(super) fn torque_offset(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let joint = scale.any_joint(random);
    let offset = random.sign() * random.log_between(0.015, 0.25) * scale.rms[joint];
    let (form, name) = random.form(["constant", "directions_differ", "fading_in"]);
    Disturbance::at_joint("torque_offset", name, joint).graded("offset", offset).logged_torque(
        joint,
        move |m, tau| {
            let share = match form {
                1 => m.sign[joint] * m.sign[joint],
                2 => 1.0 - 0.05 * (-m.t / 20.0).exp(),
                _ => 1.0,
            };
            tau + offset * share
        },
    )
}

pub(super) fn time_delay(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let delay = random.log_between(1.5e-3, 18e-3);
    let (form, name) = random.form(["constant", "wandering", "tapped"]);
    // A network with occasional packet repetitions adds less than a millisecond of delay.
    let wander = 0.05 * delay;
    let joints = whole_or_one(scale, random);
    let disturbance =
        Disturbance::new("time_delay", name, &joints).graded("delay", delay).like(&["filter_lag"]);
    let joints = affected(scale, joints);
    let mut past: VecDeque<Joints> = VecDeque::new();
    let delayed = change(move |m, tau| {
        let late = match form {
            1 => delay + wander * (0.7 * m.t).sin(),
            _ => delay,
        };
        past.push_front(*tau);
        let steps = late / m.dt;
        past.truncate(steps as usize + 3);
        let last = past.len() - 1;
        let (whole, part) = (steps.floor() as usize, steps.fract());
        let (newer, older) = (past[whole.min(last)], past[(whole + 1).min(last)]);
        for &j in &joints {
            // Averaging two samples smears a step, interpolation shifts it.
            tau[j] = match form {
                2 => {
                    let after = past[(whole + 2).min(last)][j];
                    let before = past[whole.saturating_sub(1).min(last)][j];
                    let line = newer[j] + part * (older[j] - newer[j]);
                    let wide = before + (1.0 + part) / 3.0 * (after - before);
                    0.7 * line + 0.3 * wide
                }
                _ => newer[j] + part * (older[j] - newer[j]),
            };
        }
    });
    disturbance.acting(Action::Torques(delayed))
}

pub(super) fn filter_lag(scale: &Scale<'_>, random: &mut Random) -> Disturbance {
    let lag = random.log_between(2e-3, 20e-3);
    let (form, name) = random.form(["first_order", "butterworth", "moving_average", "two_poles"]);
    let joints = whole_or_one(scale, random);
    let disturbance =
        Disturbance::new("filter_lag", name, &joints).graded("lag", lag).like(&["time_delay"]);
    let joints = affected(scale, joints);
    let mut states: Option<[Joints; 2]> = None;
    let mut past: VecDeque<Joints> = VecDeque::new();
    let filtered = change(move |m, tau| {
        let [x, v] = states.get_or_insert([*tau, NONE]);
        past.push_front(*tau);
        // The delay of a moving average is half of its length.
        let length = (2.0 * lag / m.dt).round() as usize + 1;
        past.truncate(length);
        for &j in &joints {
            let input = tau[j];
            tau[j] = match form {
                1 => {
                    // Group delay √2/ω at low frequencies; exact in the steady state.
                    let omega = std::f64::consts::SQRT_2 / lag;
                    let steps = (omega * m.dt / 0.02).ceil().max(1.0);
                    let h = m.dt / steps;
                    for _ in 0..steps as usize {
                        let pull = omega * omega * (input - x[j])
                            - std::f64::consts::SQRT_2 * omega * v[j];
                        v[j] += h * pull;
                        x[j] += h * v[j];
                    }
                    x[j]
                }
                2 => past.iter().map(|old| old[j]).sum::<f64>() / past.len() as f64,
                3 => {
                    let kept = lag / (lag + 2.0 * m.dt);
                    x[j] = input + kept * (x[j] - input);
                    v[j] = x[j] + kept * (v[j] - x[j]);
                    v[j]
                }
                _ => {
                    x[j] = input + lag / (lag + m.dt) * (x[j] - input);
                    x[j]
                }
            };
        }
    });
    disturbance.acting(Action::Torques(filtered))
}

/// All joints, stated as an empty list, or one.
fn whole_or_one(scale: &Scale<'_>, random: &mut Random) -> Vec<usize> {
    if random.chance(0.7) { Vec::new() } else { vec![scale.any_joint(random)] }
}

fn affected(scale: &Scale<'_>, joints: Vec<usize>) -> Vec<usize> {
    if joints.is_empty() { (0..scale.plant.dof).collect() } else { joints }
}

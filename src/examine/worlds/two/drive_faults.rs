//! Draws faults of the drives: torque constants, delays, filters, observers.

use super::fault::{Action, Fault, Ground};
use super::sensor::{Part, Sensor};
use super::terms::Seen;
use crate::examine::worlds::random::Rng;
use std::f64::consts::{SQRT_2, TAU};

/// Ids drawn here.
pub(super) const IDS: [&str; 7] = [
    "torque_constant",
    "current_saturation",
    "flux_weakening",
    "current_sign",
    "time_delay",
    "filter_lag",
    "apparent_torque",
];

/// Draws a fault of an id.
pub(super) fn draw(id: &str, ground: &Ground, rng: &mut Rng) -> Fault {
    match id {
        "torque_constant" => constant(ground, rng),
        "current_saturation" => saturation(ground, rng),
        "flux_weakening" => weakening(ground, rng),
        "current_sign" => sign(ground, rng),
        "apparent_torque" => apparent(ground, rng),
        _ => late(id, ground, rng),
    }
}

/// A fault of the path at some joints, or at all; `make` gives the law of a joint and its parameters.
pub(super) fn of_path(
    id: &str,
    form: &str,
    g: &Ground,
    joints: &[usize],
    mut make: impl FnMut(usize) -> (Part, Vec<(&'static str, f64, bool)>),
) -> Fault {
    let all: Vec<usize> = (0..g.n()).collect();
    let mut fault = Fault::new(id, form, joints, Action::Nothing);
    let mut sensor = Sensor::default();
    for i in if joints.is_empty() { &all } else { joints } {
        let (part, told) = make(*i);
        sensor.parts.push(part);
        for (name, value, graded) in told {
            fault.truth.tell(name, Some(*i), value, graded);
        }
    }
    fault.action = Action::Sensor(sensor);
    fault
}

fn constant(g: &Ground, rng: &mut Rng) -> Fault {
    let all = rng.chance(0.12);
    let joints = if all { (0..g.n()).collect() } else { g.joints(3, rng) };
    let warming = rng.chance(0.5);
    let form = if warming {
        "gain that drifts as magnets warm"
    } else {
        "gain that depends a little on the sign"
    };
    let mut error = rng.sign() * rng.log_between(0.03, 0.4);
    let fault = of_path("torque_constant", form, g, &joints, |i| {
        if !all {
            error = rng.sign() * rng.log_between(0.03, 0.4);
        }
        let error = error;
        let part = if warming {
            let (share, time) = (rng.between(0.05, 0.2), 0.7 * g.length);
            Part::new(i, move |tau, x, _| {
                let warm = 1.0 - (-x.now.t.max(0.0) / time).exp();
                tau * (1.0 + error * (1.0 + share * warm))
            })
        } else {
            let (side, width) = (rng.sign() * 0.15 * error, 0.3 * g.scale.torque[i]);
            Part::new(i, move |tau, _, _| tau * (1.0 + error + side * (tau / width).tanh()))
        };
        (part, vec![("error", error, true)])
    });
    if all { fault.like(&["link_parameters"]) } else { fault }
}

/// Saturation of iron, a knee, and a tangent that is clipped at 85 % of a right angle.
fn saturation(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let form = rng.below(3);
    let name = ["fourth power and square", "knee", "tangent"][form];
    of_path("current_saturation", name, g, &joints, |i| {
        let peak = g.scale.peak[i];
        let (error, part) = match form {
            0 => {
                let error = rng.log_between(0.06, 0.8);
                // Beyond the peak of the logs the iron is full.
                let law = move |tau: f64| {
                    let square = (tau / peak).powi(2).min(1.6);
                    tau * (1.0 + 0.5 * error * square * (1.0 + square))
                };
                (error, Part::new(i, move |tau, _, _| law(tau)))
            }
            1 => {
                let (error, from) = (rng.log_between(0.15, 1.5), rng.between(0.3, 0.55) * peak);
                let over = move |tau: f64| (tau.abs() - from).max(0.0).copysign(tau);
                (error, Part::new(i, move |tau, _, _| tau + error * over(tau)))
            }
            _ => {
                let scale = peak / rng.log_between(0.45, 1.15);
                let law = move |tau: f64| scale * (tau / scale).clamp(-1.33, 1.33).tan();
                (0.0, Part::new(i, move |tau, _, _| law(tau)))
            }
        };
        (part, vec![("error", error, false)])
    })
}

fn weakening(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(3, rng);
    let base = rng.chance(0.5);
    let form = if base { "speed over base speed" } else { "voltage ellipse" };
    of_path("flux_weakening", form, g, &joints, |i| {
        let error = rng.log_between(0.15, 1.0);
        let from = g.scale.speed[i] * rng.between(0.25, 0.5);
        let part = Part::new(i, move |tau, x, _| {
            let ratio = x.v.abs() / from;
            if base {
                tau * (1.0 + error * (ratio - 1.0).max(0.0))
            } else {
                tau * (1.0 + error * (ratio.powi(2) - 1.0).max(0.0)).sqrt()
            }
        });
        (part, vec![("error", error, false), ("velocity", from, base)])
    })
}

fn sign(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(2, rng);
    let gain = rng.chance(0.5);
    let form =
        if gain { "turned sign and another gain" } else { "turned sign and a zero of the sensor" };
    of_path("current_sign", form, g, &joints, |i| {
        let size = if gain { 0.04 } else { 0.03 * g.scale.torque[i] } * rng.normal();
        let law = move |tau: f64| if gain { -tau * (1.0 + size) } else { size - tau };
        (Part::new(i, move |tau, _, _| law(tau)), vec![("flipped", 1.0, true)])
    })
}

/// Delays below this look like lags of a filter \[s\].
const SHORT: f64 = 0.012;

fn late(id: &str, g: &Ground, rng: &mut Rng) -> Fault {
    let joints = if rng.chance(0.7) { Vec::new() } else { vec![rng.below(g.n())] };
    let time = rng.log_between(0.004, 0.045);
    let form = rng.below(3);
    let period = g.period * rng.between(0.6, 1.7);
    let fault = if id == "time_delay" {
        let name = ["all-pass of first order", "sample and hold", "wandering"][form];
        let make = |i| match form {
            0 => Part::new(i, move |tau, x, memory| {
                // Low pass of half the delay, twice, less the signal (Padé).
                2.0 * memory.low_pass(tau, 0.5 * time, 0.5, x.now.dt) - tau
            }),
            1 => Part::new(i, move |tau, x, memory| {
                memory.clock += x.now.dt;
                if memory.clock >= 2.0 * time {
                    memory.clock -= 2.0 * time;
                    memory.x[0] = tau;
                }
                memory.x[0]
            }),
            _ => Part::new(i, move |_, x, memory| {
                let wave = 1.0 + 0.25 * (TAU * x.now.t / period).sin();
                let steps = (time * wave / x.now.dt).max(0.0);
                let (whole, share) = (steps as usize, steps.fract());
                (1.0 - share) * memory.past.ago(whole) + share * memory.past.ago(whole + 1)
            }),
        };
        of_path(id, name, g, &joints, |i| (make(i), Vec::new())).graded("delay", None, time)
    } else {
        let name = ["two poles", "moving average", "Butterworth of second order"][form];
        let make = |i| match form {
            0 => Part::new(i, move |tau, x, memory| two_poles(tau, time, x, &mut memory.x)),
            1 => Part::new(i, move |_, x, memory| {
                let width = ((2.0 * time / x.now.dt).round() as usize).max(1);
                memory.x[0] += (memory.past.ago(0) - memory.past.ago(width)) / width as f64;
                memory.x[0]
            }),
            _ => Part::new(i, move |tau, x, memory| {
                let (w, [place, rate]) = (SQRT_2 / time, memory.x);
                let next = rate + x.now.dt * (w * w * (tau - place) - SQRT_2 * w * rate);
                memory.x = [place + x.now.dt * next, next];
                memory.x[0]
            }),
        };
        let fault = of_path(id, name, g, &joints, |i| (make(i), Vec::new()));
        fault.parameter("lag", None, time, form == 0)
    };
    let only = joints.first().map_or(0.0, |i| (i + 1) as f64);
    let fault = fault.graded("only_joint", None, only);
    let other = if id == "time_delay" { "filter_lag" } else { "time_delay" };
    if time < SHORT { fault.like(&[other]) } else { fault }
}

/// Two poles, in sum `time` \[s\].
fn two_poles(tau: f64, time: f64, x: &Seen, state: &mut [f64; 2]) -> f64 {
    let dt = x.now.dt;
    state[0] += dt * (tau - state[0]) / (0.85 * time + dt);
    if x.now.t < -2.0 {
        state[1] = state[0];
    }
    state[1] += dt * (state[0] - state[1]) / (0.15 * time + dt);
    state[1]
}

fn apparent(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(2, rng);
    let smooth = rng.chance(0.5);
    let form = if smooth { "smoothed observer" } else { "observer that saturates" };
    of_path("apparent_torque", form, g, &joints, |i| {
        let size = g.torque(i, rng);
        let inertia = rng.sign() * size / g.scale.acceleration[i];
        let viscous = rng.sign() * 0.5 * size / g.scale.rate[i];
        let part = Part::new(i, move |tau, x, memory| {
            let extra = inertia * x.a + viscous * x.v;
            if !smooth {
                return tau + 4.0 * size * (extra / (4.0 * size)).tanh();
            }
            memory.x[1] += x.now.dt * (extra - memory.x[1]) / (0.006 + x.now.dt);
            tau + memory.x[1]
        });
        (part, vec![("inertia", inertia, smooth), ("viscous", viscous, smooth)])
    })
}

//! Draws faults that no library of effects has.

use crate::examine::worlds::model::V3;
use std::f64::consts::TAU;

use super::arm::block;
use super::drive_faults::of_path;
use super::fault::{Action, Fault, Ground};
use super::sensor::Part;
use super::structure::Change;
use super::terms::{Seen, TICK, Term};
use crate::examine::worlds::random::Rng;

/// Number of different faults.
const COUNT: usize = 14;
/// How many of them are torques at a joint; the others are of the path and of bodies.
const TERMS: usize = 7;

/// Speed below which a joint rests \[rad/s\], and time in which breakaway grows by its unit \[s\].
const REST: f64 = 0.005;
const GROWTH: f64 = 0.2;

pub(super) fn draw(g: &Ground, rng: &mut Rng) -> Fault {
    let which = rng.below(COUNT);
    let i = rng.below(g.n());
    if which < TERMS { term(which, i, g, rng) } else { other(which, i, g, rng) }
}

fn term(which: usize, i: usize, g: &Ground, rng: &mut Rng) -> Fault {
    let size = 1.5 * g.torque(i, rng);
    let other = (i + 1 + rng.below(g.n() - 1)) % g.n();
    let s = g.scale;
    let place = s.middle[other] + 0.4 * s.width[other] * rng.between(-1.0, 1.0);
    let (name, term) = match which {
        0 => {
            let width = 0.2 * s.width[other];
            let law = move |x: &Seen| size * (1.0 + ((x.now.q[other] - place) / width).tanh());
            ("friction that depends on another joint's angle", Term::level(i, law))
        }
        1 => {
            let (k, rate) = (2.0 * size / s.rate[other], s.rate[i]);
            let law = move |x: &Seen| k * x.now.v[other] * x.v.abs() / rate;
            ("drag by another joint's speed", Term::smooth(i, law))
        }
        2 => {
            let omega = TAU * rng.between(4.0, 9.0);
            let inertia = (1.3 * size / s.acceleration[i]).min(2.0 * g.robot.arm.rotor[i]);
            let damping = rng.between(0.01, 0.04);
            let term = Term::new(i, move |x, states| {
                let force = omega * omega * states[0] + 2.0 * damping * omega * states[1];
                states[1] -= x.now.dt * (force + x.a);
                states[0] += x.now.dt * states[1];
                (0.0, -inertia * force)
            });
            ("oscillator on the link", term)
        }
        3 => {
            let top = 1.8 * s.acceleration[i];
            let law = move |x: &Seen| size * (x.a / top).clamp(-2.0, 2.0).powi(3);
            ("torque of the cubed acceleration", Term::smooth(i, law))
        }
        4 => {
            let turn = TAU / rng.pick(&[2.0, 3.0, 4.0, 6.0]);
            let width = rng.between(0.03, 0.08);
            let from = s.middle[i] + 0.5 * s.width[i] * rng.between(-1.0, 1.0);
            let law = move |x: &Seen| {
                let d = (x.q - from + 0.5 * turn).rem_euclid(turn) - 0.5 * turn;
                3.0 * size * (-(d / width).powi(2)).exp()
            };
            ("broken tooth", Term::level(i, law))
        }
        5 => {
            let time = g.period * rng.between(0.15, 0.6);
            // On or off, and the time of the last tick.
            let term = Term::new(i, move |x, states| {
                if x.now.t > states[1] + TICK {
                    states[1] = x.now.t;
                    if x.chance < TICK / time {
                        states[0] = 1.0 - states[0];
                    }
                }
                (1.5 * size * states[0], 0.0)
            });
            ("friction that switches at random", term)
        }
        _ => {
            let way = rng.between(0.05, 0.2);
            let term = Term::new(i, move |x, states| {
                let rate = if x.v.abs() < REST { 1.0 / GROWTH } else { 0.0 };
                states[0] = (states[0] + x.now.dt * rate) / (1.0 + x.now.dt * x.v.abs() / way);
                (3.0 * size * states[0].ln_1p(), 0.0)
            });
            ("breakaway that grows with rest", term)
        }
    };
    Fault::new("outside", name, &[i], Action::Terms(vec![term]))
}

fn other(which: usize, i: usize, g: &Ground, rng: &mut Rng) -> Fault {
    let s = g.scale;
    if which == TERMS {
        return slide(g, rng);
    }
    let share = rng.log_between(0.05, 0.6);
    let size = share * s.torque[i];
    let (form, part) = match which - TERMS {
        1 => {
            let most = s.peak[i] * (1.0 - 0.2 - share).max(0.25);
            let part = Part::new(i, move |tau, _, _| tau.clamp(-most, most));
            ("reported torque is clipped", part)
        }
        2 => {
            let law = move |tau: f64| (tau.abs() - size).max(0.0).copysign(tau);
            ("dead band of the amplifier", Part::new(i, move |tau, _, _| law(tau)))
        }
        3 => {
            let (share, omega) = (0.7 * share, TAU * rng.between(0.3, 3.0));
            let law = move |x: &Seen| 1.0 + share * (omega * x.now.t).sin();
            ("hum of the supply", Part::new(i, move |tau, x, _| tau * law(x)))
        }
        4 => {
            // The noise is largest a quarter turn further.
            let angle = s.middle[i] + rng.between(-0.5, 0.5) * s.width[i] - 0.25 * TAU;
            let part = Part::new(i, move |tau, x, _| {
                let place = (0.5 + 0.5 * (x.q - angle).sin()).powi(4);
                tau + size * place * 3.46 * (x.chance - 0.5)
            });
            ("noise that depends on the angle", part)
        }
        5 => {
            let part = Part::new(i, move |tau, _, memory| {
                memory.x[0] = memory.x[0].clamp(tau - 0.7 * size, tau + 0.7 * size);
                memory.x[0]
            });
            ("hysteresis of the torque sensor", part)
        }
        _ => {
            let (time, mean) = (rng.between(0.1, 0.4), rng.between(0.8, 4.0));
            let part = Part::new(i, move |tau, x, memory| {
                memory.clock -= x.now.dt;
                if memory.clock < 0.0 {
                    memory.x[0] = tau;
                    if x.chance < TICK / mean {
                        memory.clock = time;
                    }
                }
                memory.x[0]
            });
            ("samples that freeze", part)
        }
    };
    of_path("outside", form, g, &[i], |_| (part.clone(), Vec::new()))
}

fn slide(g: &Ground, rng: &mut Rng) -> Fault {
    let link = 1 + rng.below(g.n() - 1);
    let mass = rng.between(0.15, 0.7) * g.robot.size.payload;
    let half = rng.between(0.06, 0.15) * g.robot.size.reach;
    let edge = (mass / 5000.0).cbrt();
    let com = g.robot.arm.bodies.get(link).map_or_else(V3::zeros, |body| body.com);
    let way = rng.normals();
    let change = Change::Slide {
        link,
        body: block(mass, com, V3::repeat(edge)),
        rail: way / way.norm().max(1e-6) * half,
        place: 0.0,
    };
    Fault::new("outside", "mass that slides", &[link], Action::Body(vec![change]))
}

//! Faults between the motor's torque and its log.

use super::super::law::{Plain, Reader, View};
use super::friction::SPREAD;
use super::{Context, Fault, Order};
use crate::examine::worlds::random::{Rng, hashed};

/// Error of a gain at size 1.
const GAIN: f64 = 0.08;
/// Most of a gain's error.
const GAIN_MOST: f64 = 2.0;
/// Error of saturation at the largest torque at size 1: it acts only on large torques.
const SATURATION: f64 = 0.15;
/// Error of flux weakening at the largest speed at size 1.
const WEAKENING: f64 = 0.25;
/// Delay \[s\] at size 1, and the most.
const DELAY: (f64, f64) = (0.008, 0.049);
/// Lag \[s\] at size 1, and the most.
const LAG: (f64, f64) = (0.008, 0.09);
/// A lag \[s\] up to which delay and filter are alike to first order in motions of some hertz.
const SMALL: f64 = 0.006;
/// Share of delays and filters of one joint alone.
const ALONE: f64 = 0.3;

/// Torque constant: magnets that get warm, a gain with a wave over the angle, a gain that is more
/// where the motor drives.
pub(super) fn constant(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["warm_magnets", "wavy_gain", "loop_gain"];
    let mut fault = Fault::new("torque_constant", names[order.form], order.joints);
    let sign = if rng.chance(0.35) { -1.0 } else { 1.0 };
    let lag = 0.5 * ctx.duration.max(10.0);
    for &j in order.joints {
        let mut error = (GAIN * order.size * rng.uniform(SPREAD)).min(GAIN_MOST) * sign;
        error = error.max(-0.8);
        let (waves, phase) = (2.0 + rng.below(5) as f64, rng.angle());
        let form = order.form;
        fault.reader(
            j,
            Plain(move |x: &View, tau: f64| {
                let gain = match form {
                    0 => error * (1.06 - 0.12 * (-x.t / lag).exp()),
                    1 => error * (1.0 + 0.2 * (waves * x.q + phase).cos()),
                    _ => error,
                };
                tau * (1.0 + gain)
            }),
        );
        fault.truth.tell("error", Some(j), error, true);
    }
    if order.joints.len() == ctx.arm.count() {
        fault.same_as(&["link_parameters"]);
    }
    fault
}

/// Saturation: the root of iron that saturates, a knee, and an exponential.
pub(super) fn saturation(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["iron_root", "knee", "exponential"];
    let mut fault = Fault::new("current_saturation", names[order.form], order.joints);
    for &j in order.joints {
        let error = (SATURATION * order.size * rng.uniform(SPREAD)).min(4.0);
        let limit = ctx.arm.effort[j].max(ctx.level.peak[j]);
        let peak = ctx.level.peak[j].max(1e-9);
        let form = order.form;
        let scale = ((1.0 + error) * (1.0 + error) - 1.0) / (limit * limit);
        let knee = rng.uniform((0.3, 0.55)) * peak;
        let steep = rng.uniform((1.5, 3.5));
        fault.reader(
            j,
            Plain(move |_: &View, tau: f64| {
                let size = tau.abs();
                match form {
                    0 => tau * (1.0 + scale * tau * tau).sqrt(),
                    1 => {
                        let over = (size - knee).max(0.0);
                        tau + tau.signum() * error * over * limit / (limit - knee).max(1e-9)
                    }
                    _ => tau * (1.0 + error * (steep * size / limit).exp_m1() / steep.exp_m1()),
                }
            }),
        );
        fault.truth.tell("error", Some(j), error, form == 0 && peak > 0.7 * limit);
    }
    fault
}

/// Flux weakening: a soft onset, a square, and the current that grows as the voltage is used up.
pub(super) fn weakening(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["soft_onset", "square", "voltage_limit"];
    let mut fault = Fault::new("flux_weakening", names[order.form], order.joints);
    for &j in order.joints {
        let error = (WEAKENING * order.size * rng.uniform(SPREAD)).min(4.0);
        let top = ctx.level.speed[j].max(0.01);
        let from = top * rng.uniform((0.3, 0.65));
        let form = order.form;
        let soft = 0.06 * top;
        fault.reader(
            j,
            Plain(move |x: &View, tau: f64| {
                let v = x.v.abs();
                let share = (v - from).max(0.0) / (top - from);
                let gain = match form {
                    0 => soft * ((v - from) / soft).min(40.0).exp().ln_1p() / (top - from),
                    1 => share * share,
                    _ => 0.35 * share / (1.0 - 0.65 * share.min(1.3)).max(0.15),
                };
                tau * (1.0 + error * gain)
            }),
        );
        fault.truth.tell("error", Some(j), error, false);
        fault.truth.tell("velocity", Some(j), from, form == 0);
    }
    fault
}

/// Fine steps that a line keeps: more than the longest delay takes.
const LINE: usize = 2048;

/// A line of past torques that is read some time later.
struct Line {
    delay: f64,
    jitter: f64,
    key: u64,
    slot: f64,
}

impl Reader for Line {
    fn read(&self, x: &View, memory: &mut Vec<f64>, tau: f64, dt: f64) -> f64 {
        let delay = self.delay * (1.0 + self.jitter * hashed(self.key, (x.t / self.slot) as u64));
        if memory.len() > 2 * LINE {
            memory.drain(..LINE);
        }
        memory.push(tau);
        let back = delay / dt;
        let whole = back.floor();
        let at = |steps: f64| {
            let index = memory.len() as f64 - 1.0 - steps;
            memory.get(index.max(0.0) as usize).copied().unwrap_or(tau)
        };
        let share = back - whole;
        at(whole) * (1.0 - share) + at(whole + 1.0) * share
    }
}

/// A bus that brings a new value only now and then.
struct Held {
    hold: f64,
}

impl Reader for Held {
    fn read(&self, x: &View, memory: &mut Vec<f64>, tau: f64, _: f64) -> f64 {
        if memory.len() < 2 {
            *memory = vec![x.t + self.hold, tau];
        } else if x.t >= memory[0] {
            memory[0] += self.hold;
            memory[1] = tau;
        }
        memory[1]
    }
}

/// Delay: transport with jitter from one second to the next, and a slow bus.
pub(super) fn delay(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["jittering_transport", "slow_bus"];
    let mut fault = Fault::new("time_delay", names[order.form], &[]);
    let delay = (DELAY.0 * order.size * rng.uniform(SPREAD)).clamp(0.000_5, DELAY.1);
    let alone = rng.chance(ALONE).then(|| rng.below(ctx.arm.count()));
    let key = rng.bits();
    let form = order.form;
    for j in 0..ctx.arm.count() {
        if alone.is_some_and(|only| only != j) {
            continue;
        }
        if form == 0 {
            fault.reader(j, Line { delay, jitter: 0.15, key, slot: 0.7 });
        } else {
            fault.reader(j, Held { hold: (2.0 * delay).min(0.06) });
        }
    }
    let value = if form == 0 { delay } else { delay.min(0.03) };
    fault.truth.tell("delay", None, value, true);
    fault.truth.tell("only_joint", None, alone.map_or(0.0, |j| j as f64 + 1.0), true);
    fault.truth.joints = alone.map_or_else(Vec::new, |j| vec![j + 1]);
    if value < SMALL {
        fault.same_as(&["filter_lag"]);
    }
    fault
}

/// A filter of the reported torque.
enum Filter {
    /// Butterworth of second order, natural frequency \[rad/s\].
    Butterworth(f64),
    /// Mean of the last so many seconds.
    Mean(f64),
    /// Two equal lags in line \[s\].
    Double(f64),
}

impl Reader for Filter {
    fn read(&self, _: &View, memory: &mut Vec<f64>, tau: f64, dt: f64) -> f64 {
        match self {
            Self::Mean(window) => {
                let count = ((window / dt).round() as usize).max(1);
                // Memory: place, sum, then the ring.
                if memory.len() != count + 2 {
                    *memory = vec![tau; count + 2];
                    memory[0] = 0.0;
                    memory[1] = tau * count as f64;
                }
                let place = memory[0] as usize % count;
                memory[1] += tau - memory[place + 2];
                memory[place + 2] = tau;
                memory[0] = ((place + 1) % count) as f64;
                memory[1] / count as f64
            }
            Self::Butterworth(omega) => {
                second(memory, tau, (omega * omega, 2.0_f64.sqrt() * omega), dt)
            }
            Self::Double(lag) => second(memory, tau, (1.0 / (lag * lag), 2.0 / lag), dt),
        }
    }
}

/// One Runge-Kutta step of `ẍ = w (u − x) − d ẋ`, with u linear within the step.
fn second(memory: &mut Vec<f64>, tau: f64, law: (f64, f64), dt: f64) -> f64 {
    if memory.len() < 3 {
        *memory = vec![tau, 0.0, tau];
    }
    let rate = |x: f64, y: f64, u: f64| (y, law.0 * (u - x) - law.1 * y);
    let (x, y, u0) = (memory[0], memory[1], memory[2]);
    let um = 0.5 * (u0 + tau);
    let a = rate(x, y, u0);
    let b = rate(x + 0.5 * dt * a.0, y + 0.5 * dt * a.1, um);
    let c = rate(x + 0.5 * dt * b.0, y + 0.5 * dt * b.1, um);
    let d = rate(x + dt * c.0, y + dt * c.1, tau);
    memory[0] = x + dt * (a.0 + 2.0 * (b.0 + c.0) + d.0) / 6.0;
    memory[1] = y + dt * (a.1 + 2.0 * (b.1 + c.1) + d.1) / 6.0;
    memory[2] = tau;
    memory[0]
}

/// Lag of a filter: Butterworth, moving mean, two lags in line, each with the delay at low frequency
/// that a single lag has.
pub(super) fn filter(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["butterworth", "moving_mean", "double_lag"];
    let mut fault = Fault::new("filter_lag", names[order.form], &[]);
    let lag = (LAG.0 * order.size * rng.uniform(SPREAD)).clamp(0.001, LAG.1);
    let alone = rng.chance(ALONE).then(|| rng.below(ctx.arm.count()));
    for j in 0..ctx.arm.count() {
        if alone.is_some_and(|only| only != j) {
            continue;
        }
        fault.reader(
            j,
            match order.form {
                0 => Filter::Butterworth(2.0_f64.sqrt() / lag),
                1 => Filter::Mean(2.0 * lag),
                _ => Filter::Double(0.5 * lag),
            },
        );
    }
    fault.truth.tell("lag", None, lag, lag < 2.0 * SMALL);
    fault.truth.tell("only_joint", None, alone.map_or(0.0, |j| j as f64 + 1.0), true);
    fault.truth.joints = alone.map_or_else(Vec::new, |j| vec![j + 1]);
    if lag < SMALL {
        fault.same_as(&["time_delay"]);
    }
    fault
}

/// Sign of the current: swapped phases, and swapped with a gain that is slightly off.
pub(super) fn sign(_: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["swapped_phases", "swapped_and_rescaled"];
    let mut fault = Fault::new("current_sign", names[order.form], order.joints);
    for &j in order.joints {
        let gain = if order.form == 1 { 1.0 + 0.03 * rng.spread(1.0) } else { 1.0 };
        fault.reader(j, Plain(move |_: &View, tau: f64| -gain * tau));
        fault.truth.tell("flipped", Some(j), 1.0, true);
    }
    fault
}

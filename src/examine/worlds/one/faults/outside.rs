//! Faults that no library has. Each is a fault of a real machine, told in the comment of its builder.

use super::super::arm::GRAVITY;
use super::super::dynamics::{down, torques};
use super::super::law::{Law, Oscillator, Plain, Reader, States, Static, View, states};
use super::friction::{SPREAD, amount};
use super::{Context, Fault, Moment, Order};
use crate::examine::worlds::model::{Body, M3, V3};
use crate::examine::worlds::random::{Rng, hashed};
use std::f64::consts::TAU;

/// Frequencies of an unmodelled mode \[Hz\].
const MODE: (f64, f64) = (4.0, 11.0);
/// Time for which a switching mode stays \[s\].
const STAY: (f64, f64) = (0.5, 2.5);
/// Time for which a frozen reading stays \[s\].
const FROZEN: (f64, f64) = (0.03, 0.12);
/// Number of builders.
pub(super) const COUNT: usize = 11;

/// Another joint than `j`.
fn another(ctx: &Context, j: usize, rng: &mut Rng) -> usize {
    (j + 1 + rng.below(ctx.arm.count() - 1)) % ctx.arm.count()
}

/// A casting bends and squeezes the bearing of one joint as another joint turns.
fn neighbour(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let mut fault = Fault::new("outside", "friction_over_another_joint", order.joints);
    for &j in order.joints {
        let k = another(ctx, j, rng);
        let c = 1.5 * amount(ctx, order, j, rng);
        let (middle, half) = (ctx.level.middle[k], ctx.level.half[k].max(0.05));
        let width = rng.uniform((0.3, 0.6)) * half;
        fault.law_with(
            j,
            k,
            Static(move |x: &View| c * ((x.other_q - middle) / width).tanh() * x.sign),
        );
    }
    fault
}

/// The controller's output is cut on one side; the log shows the cut value.
fn clipped(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let mut fault = Fault::new("outside", "clipped_output", order.joints);
    for &j in order.joints {
        let share = (1.0 - 0.12 * order.size * rng.uniform(SPREAD)).clamp(0.25, 0.97);
        let (cut, side) = (share * ctx.level.peak[j], rng.sign());
        fault.reader(j, Plain(move |_: &View, tau: f64| side * (side * tau).min(cut)));
    }
    fault
}

/// A worn slip ring makes the current noisy at some angles.
fn noisy(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let mut fault = Fault::new("outside", "noise_over_angle", order.joints);
    fault.drifts = true;
    for &j in order.joints {
        let c = 4.0 * amount(ctx, order, j, rng);
        let (middle, half) = (ctx.level.middle[j], ctx.level.half[j].max(0.05));
        let (at, width) = (middle + 0.6 * half * rng.uniform((-1.0, 1.0)), 0.35 * half);
        let key = rng.bits();
        // White up to 100 Hz: a new value every 5 ms.
        fault.torque(j, move |x| {
            c * (-((x.q - at) / width).powi(2)).exp() * hashed(key, (x.t / 0.005) as u64)
        });
    }
    fault
}

/// A link or the floor swings, driven by the acceleration of another joint.
fn mode(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let mut fault = Fault::new("outside", "flexible_mode", order.joints);
    for &j in order.joints {
        let k = another(ctx, j, rng);
        let c = 4.0 * amount(ctx, order, j, rng) / ctx.level.acceleration[k].max(0.01);
        let (omega, zeta) = (TAU * rng.log(MODE), rng.log((0.01, 0.06)));
        fault.law_with(j, k, Oscillator::new(omega, zeta, move |x| c * x.other_a));
    }
    fault
}

/// A loose counterweight slides along a rail in the upper arm, with stops and friction: it lies at one
/// end until the arm leans far enough. Its torque is that of a bistable weight.
struct Sliding {
    weight: f64,
    centre: f64,
    stick: f64,
    time: f64,
}

impl Law for Sliding {
    fn start(&self, x: &View) -> States {
        states([(x.q - self.centre).signum()])
    }
    fn rates(&self, x: &View, s: &States) -> States {
        let pull = (x.q - self.centre).sin();
        if pull.abs() <= self.stick || s[0] * pull > 0.0 && s[0].abs() >= 1.0 {
            return states([]);
        }
        // Slides at a speed that grows with the slope beyond the friction of the rail.
        states([(pull - self.stick * pull.signum()) / (0.2 * self.time)])
    }
    fn settle(&self, _: &View, s: &mut States) {
        s[0] = s[0].clamp(-1.0, 1.0);
    }
    fn torque(&self, x: &View, s: &States) -> f64 {
        self.weight * s[0] * (x.q - self.centre).cos()
    }
}

fn sliding(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let mut fault = Fault::new("outside", "sliding_mass", order.joints);
    for &j in order.joints {
        let half = ctx.level.half[j].max(0.05);
        let weight = 1.5 * amount(ctx, order, j, rng);
        let centre = ctx.level.middle[j] + 0.3 * half * rng.uniform((-1.0, 1.0));
        let stick = 0.35 * half.min(1.0);
        fault.law(j, Sliding { weight, centre, stick, time: rng.uniform((0.3, 1.0)) });
    }
    fault
}

/// A loose contact: now and then the friction level jumps, for some time, without a cause in motion.
fn switching(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let mut fault = Fault::new("outside", "random_mode", order.joints);
    fault.drifts = true;
    let (stay, key) = (rng.log(STAY), rng.bits());
    for &j in order.joints {
        let c = 2.0 * amount(ctx, order, j, rng);
        fault.torque(j, move |x| {
            if hashed(key, (x.t / stay) as u64) > 0.1 { c * (0.4 + 0.6 * x.sign) } else { 0.0 }
        });
    }
    fault
}

/// A wrong feedforward: the torque has a share of the cube of the acceleration.
fn cube(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let mut fault = Fault::new("outside", "cubed_acceleration", order.joints);
    for &j in order.joints {
        let c = 5.0 * amount(ctx, order, j, rng) * rng.sign();
        let top = ctx.level.acceleration[j].max(0.01);
        fault.torque(j, move |x| c * (x.a / top).powi(3));
    }
    fault
}

/// A reading that freezes now and then.
struct Frozen {
    key: u64,
    slot: f64,
    share: f64,
}

impl Reader for Frozen {
    fn read(&self, x: &View, memory: &mut Vec<f64>, tau: f64, _: f64) -> f64 {
        let frozen = hashed(self.key, (x.t / self.slot) as u64) < 2.0 * self.share - 1.0;
        if memory.is_empty() {
            memory.push(tau);
        }
        if !frozen {
            memory[0] = tau;
        }
        memory[0]
    }
}

/// Builds a reading that freezes.
fn freezing(_: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let mut fault = Fault::new("outside", "frozen_reading", order.joints);
    fault.drifts = true;
    let (key, slot) = (rng.bits(), rng.log(FROZEN));
    let share = (0.15 * order.size).clamp(0.03, 0.75);
    for &j in order.joints {
        fault.reader(j, Frozen { key, slot, share });
    }
    fault
}

/// Cross talk of two current sensors.
fn crosstalk(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let mut fault = Fault::new("outside", "cross_talk", order.joints);
    for &j in order.joints {
        let k = another(ctx, j, rng);
        let c = amount(ctx, order, j, rng) / ctx.level.load[k].max(1e-9) * rng.sign();
        let inertia = ctx.arm.rotor[k];
        fault.law_with(j, k, Static(move |x: &View| c * (x.other_load + inertia * x.other_a)));
    }
    fault
}

/// After each reversal the gear rings: the jump of friction excites a lightly damped mode.
fn ringing(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let mut fault = Fault::new("outside", "ringing_after_reversal", order.joints);
    for &j in order.joints {
        let c = 2.0 * amount(ctx, order, j, rng);
        let (omega, zeta) = (TAU * rng.log(MODE), rng.log((0.02, 0.08)));
        // The mode's answer to the direction, less the direction itself.
        fault.law(j, Oscillator::new(omega, zeta, move |x| c * x.sign));
        fault.torque(j, move |x| -c * x.sign);
    }
    fault
}

/// A pendulum hangs at the flange (a hose with its gripper) and swings about the plumb line: its
/// pull follows the horizontal acceleration with its own frequency.
fn pendulum(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let mut fault = Fault::new("outside", "swinging_pendulum", &[]);
    let mass = 0.15 * ctx.arm.payload * order.size * rng.uniform(SPREAD);
    let body = Body { mass, com: ctx.arm.flange, inertia: M3::zeros() };
    let last = ctx.arm.count() - 1;
    fault.field = Some(Box::new(move |m: &Moment| {
        // Without its weight: what the horizontal acceleration asks for.
        let up = V3::new(0.0, 0.0, GRAVITY);
        torques(std::iter::once((last, &body)), m.pose, (m.v, m.a), &(down() + up))
    }));
    let (omega, zeta) = (TAU * rng.uniform((0.6, 1.4)), rng.uniform((0.02, 0.1)));
    for j in 0..=last {
        fault.law(j, Oscillator::new(omega, zeta, |x| x.field));
    }
    fault
}

/// Builds a fault of the number `form`.
pub(super) fn outside(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let all: [super::Builder; COUNT] = [
        neighbour, clipped, noisy, mode, sliding, switching, cube, freezing, crosstalk, ringing,
        pendulum,
    ];
    all[order.form](ctx, order, rng)
}

//! Gears and motors: play, elasticity, ripple, rotors and the coupling of the wrist.

use super::super::law::{Law, Memory, Oscillator, States, Static, View, states};
use super::friction::{SPREAD, amount};
use super::{Context, Fault, Order};
use crate::examine::worlds::random::Rng;
use std::f64::consts::{PI, TAU};

/// Relaxation of a loaded gear \[s\]: steel with grease settles within milliseconds.
const RELAXATION: (f64, f64) = (0.004, 0.009);
/// Gap \[rad\] at size 1, and its bounds.
const GAP: (f64, (f64, f64)) = (0.001_5, (0.000_1, 0.025));
/// Twist \[rad\] of an elastic gear under the peak torque at size 1, and its bounds.
const TWIST: (f64, (f64, f64)) = (0.003, (0.000_1, 0.02));
/// Belts and input stages swing at these frequencies \[Hz\].
const BELT: (f64, f64) = (18.0, 45.0);
/// Orders of ripple: teeth, pins and eccentric shafts per turn of the joint.
const ORDERS: (f64, f64) = (3.0, 120.0);
/// Waves of the ripple per sample, at most: the log must show them.
const WAVES: f64 = 0.25;
/// Extra turns of the last motor per turn of the axis before.
const COUPLING: (f64, f64) = (0.3, 1.2);

/// A twist that a function of load and of the memory of the load calls for, behind a relaxation.
struct Twist<F> {
    relaxation: f64,
    /// Half width of the play operator of the load \[Nm\].
    play: f64,
    target: F,
}

impl<F: Fn(f64, f64) -> f64> Twist<F> {
    fn new(relaxation: f64, play: f64, target: F) -> Self {
        Self { relaxation, play, target }
    }
}

impl<F: Fn(f64, f64) -> f64> Law for Twist<F> {
    fn start(&self, x: &View) -> States {
        let twist = (self.target)(x.load, x.load);
        states([twist, x.load, twist])
    }
    fn rates(&self, x: &View, s: &States) -> States {
        // Two relaxations in line: the speed of the twist is continuous.
        let target = (self.target)(x.load, s[1]);
        states([s[2] - s[0], 0.0, target - s[2]]).map(|way| way / self.relaxation)
    }
    fn settle(&self, x: &View, s: &mut States) {
        s[1] = s[1].clamp(x.load - self.play, x.load + self.play);
    }
    fn bend(&self, _: &View, s: &States) -> f64 {
        s[0]
    }
}

/// A gap that is crossed at a speed that the load gives.
struct Crossing {
    gap: f64,
    speed: f64,
    full: f64,
    relaxation: f64,
}

impl Law for Crossing {
    fn start(&self, x: &View) -> States {
        states([0.5 * self.gap * x.load.signum(); 2])
    }
    fn rates(&self, x: &View, s: &States) -> States {
        let push = (x.load / self.full).clamp(-1.0, 1.0);
        let free = s[1].abs() < 0.5 * self.gap || s[1] * push < 0.0;
        let crossing = if free { self.speed * push } else { 0.0 };
        states([(s[1] - s[0]) / self.relaxation, crossing])
    }
    fn settle(&self, _: &View, s: &mut States) {
        s[1] = s[1].clamp(-0.5 * self.gap, 0.5 * self.gap);
    }
    fn bend(&self, _: &View, s: &States) -> f64 {
        s[0]
    }
}

/// Backlash: a gap crossed as a differential equation after M. Nordin, J. Galić, P.-O. Gutman
/// (Int. J. Adaptive Control 11, 1997), a play operator with an arctangent, and lost motion of an RV
/// gear, soft at small torques.
pub(super) fn backlash(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["crossing_equation", "play_arctangent", "lost_motion"];
    let mut fault = Fault::new("backlash", names[order.form], order.joints);
    for &j in order.joints {
        let gap = (GAP.0 * order.size * rng.uniform(SPREAD)).clamp(GAP.1.0, GAP.1.1);
        let level = ctx.level.load[j].max(1e-9);
        let relaxation = rng.uniform(RELAXATION);
        let width = level * rng.uniform((0.03, 0.12));
        match order.form {
            0 => fault.law(
                j,
                Crossing {
                    gap,
                    speed: gap / rng.uniform((0.02, 0.08)),
                    full: level * rng.uniform((0.05, 0.2)),
                    relaxation,
                },
            ),
            1 => fault.law(
                j,
                Twist::new(relaxation, 0.5 * width, move |_, memory| {
                    gap / PI * (memory / width).atan()
                }),
            ),
            _ => fault.law(
                j,
                Twist::new(relaxation, width, move |load, memory| {
                    let soft = |l: f64| l / (l.abs() + 0.7 * width);
                    0.5 * gap * (0.6 * soft(load) + 0.4 * soft(memory))
                }),
            ),
        }
        fault.truth.tell("gap", Some(j), gap, true);
    }
    fault
}

/// Elasticity: hardening (T. Tuttle, W. Seering, 1996), three ranges of stiffness as in catalogues of
/// strain wave gears, and a hysteresis of the torsion.
pub(super) fn elasticity(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["hardening", "three_ranges", "torsion_hysteresis"];
    let mut fault = Fault::new("elasticity", names[order.form], order.joints);
    for &j in order.joints {
        let peak = ctx.level.peak[j].max(1e-9);
        let twist = (TWIST.0 * order.size * rng.uniform(SPREAD)).clamp(TWIST.1.0, TWIST.1.1);
        let relaxation = rng.uniform(RELAXATION);
        let k = peak / twist;
        match order.form {
            // δ of k₁δ + k₃δ³ = τ, approximated by its own series inverted once.
            0 => fault.law(
                j,
                Twist::new(relaxation, 0.0, move |load, _| {
                    1.25 * load / k / (1.0 + 0.6 * (load / peak).powi(2)).powf(0.45)
                }),
            ),
            1 => fault.law(
                j,
                Twist::new(relaxation, 0.0, move |load, _| {
                    let l = load.abs();
                    let (one, two) = (0.15 * peak, 0.5 * peak);
                    let first = l.min(one) * 1.6;
                    let second = (l - one).clamp(0.0, two - one) * 1.1;
                    let third = (l - two).max(0.0) * 0.8;
                    load.signum() * (first + second + third) / k
                }),
            ),
            _ => fault.law(
                j,
                Twist::new(relaxation, 0.06 * peak, move |load, memory| {
                    (0.85 * load + 0.15 * memory) / k
                }),
            ),
        }
        fault.truth.tell("stiffness", Some(j), k, order.form == 2);
    }
    fault
}

/// Ripple: cusps of meshing teeth, two modulated harmonics, and ripple that grows with the load.
pub(super) fn ripple(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["cusps", "modulated_harmonics", "load_ripple"];
    let mut fault = Fault::new("ripple", names[order.form], order.joints);
    for &j in order.joints {
        let c = 1.4 * amount(ctx, order, j, rng);
        let most = (WAVES * ctx.rate * TAU / ctx.level.speed[j].max(0.05)).min(ORDERS.1);
        let n = rng.log((ORDERS.0, most.max(ORDERS.0 + 1.0))).round();
        let (phase, other) = (rng.angle(), rng.angle());
        let level = ctx.level.load[j].max(1e-9);
        match order.form {
            0 => fault.torque(j, move |x| {
                // |sin| less its mean: its lowest wave has the order n.
                2.0 * c * ((0.5 * (n * x.q - phase)).sin().abs() - 2.0 / PI)
            }),
            1 => fault.torque(j, move |x| {
                let first = (n * x.q - phase).cos() * (1.0 + 0.35 * (x.q - other).cos());
                c * (first + 0.3 * (2.0 * n * x.q - other).cos())
            }),
            _ => fault.torque(j, move |x| {
                c * (0.5 + 0.5 * (x.load.abs() / level).min(3.0)) * (n * x.q - phase).cos()
            }),
        }
        fault.truth.tell("amplitude", Some(j), c, false);
        fault.truth.tell("order", Some(j), n, true);
    }
    fault
}

/// Rotor inertia: behind a belt that swings, and as a disc on a spline that is dragged along.
pub(super) fn rotor(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["belt_stage", "splined_disc"];
    let mut fault = Fault::new("rotor_inertia", names[order.form], order.joints);
    for &j in order.joints {
        let top = ctx.level.acceleration[j].max(0.01);
        let inertia = 3.0 * amount(ctx, order, j, rng) / top;
        if order.form == 0 {
            fault.law(
                j,
                Oscillator::new(TAU * rng.log(BELT), rng.uniform((0.15, 0.5)), move |x| {
                    inertia * x.a
                }),
            );
        } else {
            let lag = rng.uniform((0.003, 0.008));
            let output = move |x: &View, w: f64| inertia * (x.v - w) / lag;
            fault.law(j, Memory::new(lag, |x| x.v, output));
        }
        fault.truth.tell("inertia", Some(j), inertia, true);
    }
    if order.joints.iter().all(|j| *j < 2) {
        fault.same_as(&["link_parameters"]);
    }
    fault
}

/// Coupling of the wrist: friction and inertia of motor 6 follow `w = q̇₆ + c q̇₅`.
pub(super) fn wrist(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["bevel_train", "bevel_train_with_mesh"];
    let mut fault = Fault::new("wrist_coupling", names[order.form], &[]);
    let c = rng.log(COUPLING) * rng.sign() * order.size.min(1.0);
    // Beyond the turns themselves a worn train has more friction.
    let more = order.size.max(1.0);
    let (coulomb, viscous) = (ctx.arm.coulomb[5] * more, ctx.arm.viscous[5] * more);
    let inertia = ctx.arm.rotor[5];
    let corner = 0.02 * ctx.level.speed[5].max(0.05);
    let mu = if order.form == 1 { 0.08 } else { 0.0 };
    let friction =
        move |w: f64, load: f64| (coulomb + mu * load.abs()) * (w / corner).tanh() + viscous * w;
    let (base_c, base_v) = (ctx.arm.coulomb[5], ctx.arm.viscous[5]);
    fault.law_with(
        5,
        4,
        Static(move |x: &View| {
            let w = x.v + c * x.other_v;
            friction(w, x.load) - base_c * x.sign - base_v * x.v + inertia * c * x.other_a
        }),
    );
    fault.law_with(
        4,
        5,
        Static(move |x: &View| {
            let w = x.other_v + c * x.v;
            c * (friction(w, x.other_load) + inertia * (x.other_a + c * x.a))
        }),
    );
    fault.truth.tell("coupling", None, c, true);
    fault.truth.tell("coulomb", None, coulomb - base_c, false);
    fault.truth.tell("viscous", None, viscous - base_v, false);
    fault
}

//! Faults of friction. All follow the direction of the Maxwell elements, so that they stick and
//! build up with displacement as the everyday friction does.

use super::super::law::{Bouc, Law, Memory, States, View, states};
use super::{Context, Fault, Order};
use crate::examine::worlds::random::Rng;

/// Share of the rms torque that a fault of size 1 has.
pub(super) const SHARE: f64 = 0.1;
/// Spread of the sizes of a fault's joints.
pub(super) const SPREAD: (f64, f64) = (0.7, 1.3);
/// Stribeck speeds over the largest speed of the motion.
const STRIBECK: (f64, f64) = (0.02, 0.2);
/// Memory of the lubricant film \[s\] (B. Armstrong-Hélouvry, 1994: some milliseconds to 0.1 s).
const FILM: (f64, f64) = (0.005, 0.04);
/// Time constants of warming over the duration of a log.
const WARMING: (f64, f64) = (0.15, 0.9);
/// Slowest warming effect that the library allows \[s\].
const LEAST_WARMING: f64 = 1.0;
/// Breakaway distance \[rad\] of worn gears and soft seals at size 1.
const SOFT: f64 = 0.004;
/// Bounds of that distance \[rad\].
const SOFT_BOUNDS: (f64, f64) = (0.000_3, 0.15);
/// Time in which a brake falls in or lets go \[s\].
const EDGE: (f64, f64) = (0.02, 0.1);

/// Torque \[Nm\] of a fault at a joint.
pub(super) fn amount(ctx: &Context, order: &Order, j: usize, rng: &mut Rng) -> f64 {
    SHARE * order.size * ctx.level.torque[j] * rng.uniform(SPREAD)
}

/// Level of friction: scaled Maxwell friction; the logarithmic speed law of H. Eyring (Viscosity,
/// plasticity, and diffusion, 1936); seals that wedge up a film of grease.
pub(super) fn level(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["maxwell_slip_scaled", "eyring_film", "seal_and_grease"];
    let mut fault = Fault::new("friction_level", names[order.form], order.joints);
    let only = rng.chance(0.3);
    let down = rng.chance(0.25);
    for &j in order.joints {
        let (mut c, top) = (amount(ctx, order, j, rng), ctx.level.speed[j].max(0.01));
        let mut b = if only { 0.0 } else { c * rng.uniform((0.3, 1.2)) / top };
        if down {
            c = -c.min(0.8 * ctx.arm.coulomb[j]);
            b = -b.min(0.8 * ctx.arm.viscous[j]);
        }
        match order.form {
            0 => fault.torque(j, move |x| c * x.sign + b * x.v),
            1 => {
                let slow = top * rng.uniform((0.02, 0.1));
                let whole = (top / slow).asinh();
                let film = move |x: &View| {
                    (c + b * top) * (0.5 * x.sign + 0.5 * (x.v / slow).asinh() / whole)
                };
                fault.torque(j, film);
            }
            _ => {
                let slow = top * rng.uniform((0.05, 0.2));
                let seal =
                    move |x: &View| c * x.sign + b * x.v * (1.0 + 0.35 * (-x.v.abs() / slow).exp());
                fault.torque(j, seal);
            }
        }
        fault.truth.tell("coulomb", Some(j), c, order.form == 0);
        fault.truth.tell("viscous", Some(j), b, order.form == 0);
    }
    if only && !down && order.form == 0 {
        fault.same_as(&["brake_drag"]);
    }
    fault
}

/// Stribeck friction: rational (D. Hess, A. Soom, ASME J. Tribology 112, 1990), exponential of the
/// speed (A. Tustin, 1947), and rational with the memory of the film.
pub(super) fn stribeck(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["hess_soom", "tustin", "film_memory"];
    let mut fault = Fault::new("stribeck", names[order.form], order.joints);
    for &j in order.joints {
        let s = 3.0 * amount(ctx, order, j, rng);
        let slow = (ctx.level.speed[j] * rng.log(STRIBECK)).clamp(0.002, 0.8);
        let hess = move |v: f64| s / (1.0 + (v / slow) * (v / slow));
        match order.form {
            0 => fault.torque(j, move |x| hess(x.v) * x.sign),
            1 => fault.torque(j, move |x| s * (-x.v.abs() / slow).exp() * x.sign),
            _ => fault
                .law(j, Memory::new(rng.log(FILM), |x| x.v.abs(), move |x, v| hess(v) * x.sign)),
        }
        fault.truth.tell("stiction", Some(j), s, order.form != 2);
        fault.truth.tell("velocity", Some(j), slow, order.form == 1);
    }
    fault
}

/// Nonlinear viscous friction: shear thinning (P. Carreau, 1972), churning oil with square and cube,
/// saturation of the film.
pub(super) fn viscous(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["carreau_thinning", "churning", "saturating_film"];
    let mut fault = Fault::new("nonlinear_viscous", names[order.form], order.joints);
    for &j in order.joints {
        let (c, top) = (2.0 * amount(ctx, order, j, rng), ctx.level.speed[j].max(0.01));
        let slow = top * rng.uniform((0.05, 0.25));
        let mix = rng.unit();
        match order.form {
            0 => fault.torque(j, move |x| {
                let ratio = x.v / slow;
                c * (x.v / top) * (slow / top).powf(-0.6) * (1.0 + ratio * ratio).powf(-0.3)
            }),
            1 => fault.torque(j, move |x| {
                let r = x.v / top;
                c * r.abs() * r * (mix + (1.0 - mix) * r.abs())
            }),
            _ => fault
                .torque(j, move |x| c * (x.v / slow).tanh() * (0.6 + 0.4 * (x.v / top).powi(2))),
        }
        fault.truth.tell("coefficient", Some(j), c, false);
    }
    fault
}

/// Asymmetry of viscous friction with a rounded corner, and of a film that thins.
pub(super) fn viscous_asymmetry(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["rounded_corner", "thinning_one_way"];
    let mut fault = Fault::new("viscous_asymmetry", names[order.form], order.joints);
    for &j in order.joints {
        let top = ctx.level.speed[j].max(0.01);
        let b = 2.0 * amount(ctx, order, j, rng) * rng.sign() / top;
        let corner = top * rng.uniform((0.02, 0.06));
        if order.form == 0 {
            fault.torque(j, move |x| b * ((x.v * x.v + corner * corner).sqrt() - corner));
        } else {
            let way = rng.sign();
            fault.torque(j, move |x| {
                let r = x.v.abs() / top;
                let more = if x.v * way > 0.0 { 1.15 } else { 0.85 };
                b * top * more * r * (1.25 - 0.25 * r)
            });
        }
        fault.truth.tell("asymmetry", Some(j), b, order.form == 0);
    }
    fault
}

/// Friction of the load: rounded with a memory of the load, and with a threshold of preload.
pub(super) fn load(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["rounded_load", "preloaded_mesh", "hertz_contact"];
    let mut fault = Fault::new("load_friction", names[order.form], order.joints);
    for &j in order.joints {
        let level = ctx.level.load[j].max(1e-9);
        let mu = (amount(ctx, order, j, rng) / level).min(0.5);
        let round = level * rng.uniform((0.05, 0.15));
        let preload = level * rng.uniform((0.2, 0.5));
        match order.form {
            0 => fault.law(
                j,
                Memory::new(
                    rng.log(FILM),
                    |x| x.load,
                    move |x, l| mu * ((l * l + round * round).sqrt() - round) * x.sign,
                ),
            ),
            1 => fault.torque(j, move |x| mu * (x.load.abs() - preload).max(0.0) * x.sign),
            // Rolling contact: friction grows less than in proportion.
            _ => fault.torque(j, move |x| mu * level * (x.load.abs() / level).powf(0.8) * x.sign),
        }
        fault.truth.tell("mu", Some(j), mu, order.form == 0);
    }
    fault.same_as(&["gear_efficiency"]);
    fault
}

/// Efficiency of the gear: soft change between driving and driven, and losses that saturate.
pub(super) fn efficiency(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["soft_quadrants", "saturating_loss"];
    let mut fault = Fault::new("gear_efficiency", names[order.form], order.joints);
    let same = rng.chance(0.2);
    for &j in order.joints {
        let level = ctx.level.load[j].max(1e-9);
        let a = (amount(ctx, order, j, rng) / level).min(0.8);
        let b = if same { a } else { (a * rng.uniform((0.0, 2.0))).min(0.8) };
        let width = 0.05 * level * ctx.level.speed[j].max(0.01);
        let full = level * rng.uniform((0.4, 1.2));
        let saturates = order.form == 1;
        fault.torque(j, move |x| {
            let motoring = 0.5 + 0.5 * (x.load * x.v / width).tanh();
            let loss = a * motoring + b * (1.0 - motoring);
            let through =
                if saturates { full * (x.load.abs() / full).tanh() } else { x.load.abs() };
            loss * through * x.sign
        });
        fault.truth.tell("motoring", Some(j), a, !saturates);
        fault.truth.tell("generating", Some(j), b, !saturates);
    }
    if same {
        fault.same_as(&["load_friction"]);
    }
    fault
}

/// Friction that is heated by its own motion; viscosity falls with temperature (H. Vogel, 1921).
struct Heat {
    lag: f64,
    coulomb: f64,
    viscous: f64,
    top: f64,
}

impl Law for Heat {
    fn rates(&self, x: &View, s: &States) -> States {
        let heat = 0.5 + x.v.abs() / self.top;
        states([(heat - s[0]) / self.lag])
    }
    fn torque(&self, x: &View, s: &States) -> f64 {
        let cold = (-3.5 * s[0]).exp();
        (self.coulomb * x.sign + self.viscous * x.v) * cold
    }
}

/// Warming up: two time constants (oil and housing), a hyperbola, and a temperature as a state.
pub(super) fn warm_up(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["two_bodies", "hyperbolic", "heated_by_motion"];
    let mut fault = Fault::new("warm_up", names[order.form], order.joints);
    fault.drifts = true;
    let lag = (ctx.duration * rng.log(WARMING)).max(LEAST_WARMING);
    for &j in order.joints {
        let top = ctx.level.speed[j].max(0.01);
        let c = 2.0 * amount(ctx, order, j, rng);
        let b = c * rng.uniform((0.3, 1.5)) / top;
        let plain = move |x: &View| c * x.sign + b * x.v;
        match order.form {
            0 => fault.torque(j, move |x| {
                plain(x) * (0.6 * (-x.t / lag).exp() + 0.4 * (-x.t / (3.0 * lag)).exp())
            }),
            1 => fault.torque(j, move |x| plain(x) / (1.0 + x.t / lag).powf(1.5)),
            _ => fault.law(j, Heat { lag: 2.0 * lag, coulomb: c, viscous: b, top }),
        }
        fault.truth.tell("coulomb", Some(j), c, false);
        fault.truth.tell("viscous", Some(j), b, false);
        fault.truth.tell("time_constant", Some(j), lag, false);
    }
    fault
}

/// Friction over the angle: worn spots, a wave of von Mises, a saw tooth.
pub(super) fn position(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["worn_spots", "von_mises", "triangle"];
    let mut fault = Fault::new("position_friction", names[order.form], order.joints);
    for &j in order.joints {
        let c = 2.0 * amount(ctx, order, j, rng);
        let (middle, half) = (ctx.level.middle[j], ctx.level.half[j].max(0.05));
        let centre = middle + 0.7 * half * rng.uniform((-1.0, 1.0));
        let second = middle + 0.7 * half * rng.uniform((-1.0, 1.0));
        let width = half * rng.uniform((0.2, 0.5));
        let sharp = rng.uniform((0.8, 2.5));
        match order.form {
            0 => fault.torque(j, move |x| {
                let bump = |at: f64| (-((x.q - at) / width).powi(2)).exp();
                c * (bump(centre) - 0.6 * bump(second)) * x.sign
            }),
            1 => fault.torque(j, move |x| {
                c * (2.0 * (sharp * ((x.q - centre).cos() - 1.0)).exp() - 1.0) * x.sign
            }),
            _ => fault.torque(j, move |x| {
                c * (x.q - centre).cos().clamp(-1.0, 1.0).asin() / std::f64::consts::FRAC_PI_2
                    * x.sign
            }),
        }
        fault.truth.tell("amplitude", Some(j), c, false);
        fault.truth.tell("phase", Some(j), centre, false);
    }
    fault
}

/// Pre-sliding: the bristles of C. Canudas de Wit et al. (IEEE T-AC 40, 1995), the elasto-plastic
/// bristles of P. Dupont et al. (IEEE T-AC 47, 2002) and a stretched Bouc-Wen loop.
pub(super) fn presliding(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["bristle_root", "elasto_plastic", "asymmetric_loop"];
    let mut fault = Fault::new("presliding", names[order.form], order.joints);
    for &j in order.joints {
        let distance =
            (SOFT * order.size * rng.uniform(SPREAD)).clamp(SOFT_BOUNDS.0, SOFT_BOUNDS.1);
        let c = ctx.arm.coulomb[j];
        match order.form {
            // The force is a root-like function of the bristle: stiff at first, then soft.
            0 => fault.law(
                j,
                Bouc::new(distance, 1.0, move |x, z| {
                    let soft = z * (1.25 - 0.25 * z * z);
                    c * (soft - x.sign)
                }),
            ),
            1 => fault.law(j, Plastic { distance: 1.4 * distance, coulomb: c }),
            _ => fault.law(j, Bouc::new(distance, 0.8, move |x, z| c * (z - x.sign))),
        }
        fault.truth.tell("distance", Some(j), distance, order.form == 2);
    }
    fault
}

/// Elasto-plastic bristle: purely elastic up to a share of its length, then growing slip.
struct Plastic {
    distance: f64,
    coulomb: f64,
}

/// Share of the bristle's length that is purely elastic.
const ELASTIC: f64 = 0.6;

impl Law for Plastic {
    fn rates(&self, x: &View, s: &States) -> States {
        let z = s[0].abs();
        let pushed = s[0] * x.v > 0.0;
        let share = ((z - ELASTIC) / (1.0 - ELASTIC)).clamp(0.0, 1.0);
        let slip = if pushed { 0.5 - 0.5 * (std::f64::consts::PI * share).cos() } else { 0.0 };
        states([x.v * (1.0 - slip) / self.distance])
    }
    fn settle(&self, _: &View, s: &mut States) {
        s[0] = s[0].clamp(-1.0, 1.0);
    }
    fn torque(&self, x: &View, s: &States) -> f64 {
        self.coulomb * (s[0] - x.sign)
    }
}

/// 1 within a window \[s\], 0 outside, with straight edges of a width \[s\].
pub(super) fn gate(phase: f64, window: [f64; 2], edge: f64) -> f64 {
    ((phase - window[0]) / edge).clamp(0.0, 1.0) * ((window[1] - phase) / edge).clamp(0.0, 1.0)
}

/// A window within the period \[s\].
pub(super) fn window(ctx: &Context, share: (f64, f64), rng: &mut Rng) -> [f64; 2] {
    let length = ctx.period * rng.uniform(share);
    let start = rng.uniform((0.02 * ctx.period, 0.98 * ctx.period - length));
    [(start * 100.0).round() / 100.0, ((start + length) * 100.0).round() / 100.0]
}

/// Drag of a brake: it falls in and lets go softly, wobbles over the turn, or fades as it gets hot.
pub(super) fn brake(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["soft_edges", "wobbling_disc", "fading"];
    let mut fault = Fault::new("brake_drag", names[order.form], order.joints);
    let within = rng.chance(0.6).then(|| window(ctx, (0.15, 0.5), rng));
    let (edge, turns, phase) = (rng.log(EDGE), 3.0 + rng.below(5) as f64, rng.angle());
    for &j in order.joints {
        let c = amount(ctx, order, j, rng);
        let form = order.form;
        fault.torque(j, move |x| {
            let on = within.map_or(1.0, |w| gate(x.phase, w, edge));
            let since = within.map_or(0.0, |w| (x.phase - w[0]).max(0.0) / (w[1] - w[0]));
            let level = match form {
                1 => 1.0 + 0.4 * (turns * x.q + phase).cos(),
                2 => 0.6 + 0.7 * (-2.0 * since).exp(),
                _ => 1.0,
            };
            c * level * on * x.sign
        });
        fault.truth.tell("drag", Some(j), c, form != 2);
    }
    if let Some(w) = within {
        fault.truth.tell("t_start_s", None, w[0], true);
        fault.truth.tell("t_end_s", None, w[1], true);
    } else {
        fault.same_as(&["friction_level"]);
    }
    fault.truth.window = within;
    fault
}

//! Springs, balancers, cables and offsets.

use super::super::law::{Bouc, Memory};
use super::friction::amount;
use super::{Context, Fault, Order};
use crate::examine::worlds::random::Rng;

/// Lever of a spring's fixed point over that of its moving point.
const LEVERS: (f64, f64) = (1.3, 3.0);
/// Exponent of a gas spring: between isothermal and adiabatic.
const GAS: (f64, f64) = (1.0, 1.4);
/// Angle in which hysteresis of a hose builds up, over the range of the joint.
const HOSE: (f64, f64) = (0.05, 0.25);

/// Gravity springs: a coil spring in a triangle (A. Klimchik et al., 2013), a gas spring on a crank,
/// and a torsion bar with a preload and friction.
pub(super) fn gravity(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["spring_triangle", "gas_spring", "torsion_bar"];
    let mut fault = Fault::new("gravity_spring", names[order.form], order.joints);
    for &j in order.joints {
        let (middle, half) = (ctx.level.middle[j], ctx.level.half[j].max(0.1));
        let k = 1.5 * amount(ctx, order, j, rng) * rng.sign() / half;
        let centre = middle + half * rng.uniform((-0.8, 0.8));
        let lever = rng.uniform(LEVERS);
        let free = rng.uniform((0.3, 0.8)) * (lever - 1.0);
        let gas = rng.uniform(GAS);
        match order.form {
            0 => fault.torque(j, move |x| {
                // Length between a point on the arm and a fixed point, over the arm's lever; free
                // length L0: torque k·a·b·(1 − L0/L)·sin q, with slope k at the centre.
                let d = x.q - centre;
                let length = (1.0 + lever * lever - 2.0 * lever * d.cos()).sqrt().max(1e-6);
                let slope = 1.0 - free / (lever - 1.0);
                k * (1.0 - free / length) * d.sin() / slope
            }),
            1 => fault.torque(j, move |x| {
                let d = x.q - centre;
                let pressure = (1.0 - 0.25 * (1.0 - d.cos())).max(0.2).powf(-gas);
                k * d.sin() * pressure
            }),
            _ => fault.law(
                j,
                Bouc::new(0.05 * half, 0.7, move |x, z| {
                    k * (x.q - centre) + 0.06 * k.abs() * half * z
                }),
            ),
        }
        fault.truth.tell("stiffness", Some(j), k, order.form == 2);
        fault.truth.tell("centre", Some(j), centre, true);
    }
    fault.same_as(&["cable"]);
    fault
}

/// Cables: with hysteresis, taut only beyond an angle, and twisted by the joint before.
pub(super) fn cable(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["bouc_wen_hose", "taut_beyond", "stiffening"];
    let mut fault = Fault::new("cable", names[order.form], order.joints);
    for &j in order.joints {
        let (middle, half) = (ctx.level.middle[j], ctx.level.half[j].max(0.1));
        let k = 1.5 * amount(ctx, order, j, rng) / half;
        let centre = middle + half * rng.uniform((-0.5, 0.5));
        let slack = half * rng.uniform((0.1, 0.3));
        let distance = half * rng.uniform(HOSE);
        match order.form {
            0 => fault.law(
                j,
                Bouc::new(distance, 0.6, move |x, z| k * (x.q - centre) + 0.2 * k * half * z),
            ),
            1 => fault.torque(j, move |x| {
                // Softly taut on both sides of the slack.
                let soft = 0.15 * half;
                let taut = |d: f64| soft * ((d - slack) / soft).min(40.0).exp().ln_1p();
                k * (taut(x.q - centre) - taut(centre - x.q))
            }),
            _ => fault.torque(j, move |x| {
                let d = (x.q - centre) / half;
                k * half * d * (0.6 + 0.5 * d * d)
            }),
        }
        fault.truth.tell("stiffness", Some(j), k, order.form == 0);
        fault.truth.tell("centre", Some(j), centre, order.form == 0);
    }
    fault.same_as(&["gravity_spring"]);
    fault
}

/// Offsets: Coulomb friction that is more one way, a sensor that drifts, an offset behind a slow filter.
pub(super) fn offset(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["asymmetric_coulomb", "drifting_sensor", "wandering_bias"];
    let mut fault = Fault::new("torque_offset", names[order.form], order.joints);
    let (wave, phase) = (ctx.duration * rng.uniform((0.7, 2.0)), rng.angle());
    for &j in order.joints {
        let c = amount(ctx, order, j, rng) * rng.sign();
        match order.form {
            // Friction of the two directions differs: c with the sign of motion, built up softly.
            0 => fault.law(j, Memory::new(0.01, |x| x.sign, move |_, z| c * z.abs().min(1.0))),
            1 => fault.torque(j, move |x| c * (1.0 - 0.12 * (-x.t / wave).exp())),
            _ => fault.torque(j, move |x| {
                c * (1.0 + 0.08 * (std::f64::consts::TAU * x.t / wave + phase).sin())
            }),
        }
        fault.truth.tell("offset", Some(j), c, true);
    }
    fault
}

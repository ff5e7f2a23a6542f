//! Bodies that are off: payloads, links, the base and the angles.

use super::super::arm::{GRAVITY, box_inertia};
use super::super::dynamics::{down, gravity_torques, jacobian, torques};
use super::super::law::{Law, Oscillator, States, View, states};
use super::friction::SPREAD;
use super::{Context, Fault, Moment, Order};
use crate::examine::worlds::model::{Body, M3, V3};
use crate::examine::worlds::random::Rng;

/// Payload over the rated one at size 1.
const PAYLOAD: f64 = 0.15;
/// Distance of a payload's centre from the flange over the root of its mass \[m/√kg\].
const REACH: (f64, f64) = (0.01, 0.05);
/// A load in soft jaws swings at these frequencies \[Hz\].
const JAWS: (f64, f64) = (8.0, 16.0);
/// Tilt \[rad\] at size 1, and the most.
const TILT: (f64, f64) = (0.03, 0.6);
/// Offset \[rad\] of an angle at size 1, and the most.
const OFFSET: (f64, f64) = (0.03, 0.45);

/// Parameters of a payload. The files have no flange: its frame is that of the last joint.
fn tell_payload(fault: &mut Fault, body: &Body, sharp: bool) {
    let com = body.com;
    fault.truth.tell("mass", None, body.mass, true);
    fault.truth.tell("com_x", None, com.x, sharp);
    fault.truth.tell("com_y", None, com.y, sharp);
    fault.truth.tell("com_z", None, com.z, sharp);
    for (name, (r, c)) in [("inertia_xx", (0, 0)), ("inertia_yy", (1, 1)), ("inertia_zz", (2, 2))] {
        fault.truth.tell(name, None, body.inertia[(r, c)], false);
    }
}

/// Payload: a box, a box in soft jaws, and a box with a hose that weighs more the higher it is lifted.
pub(super) fn payload(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["rigid_box", "soft_jaws", "lifted_hose"];
    let mut fault = Fault::new("payload", names[order.form], &[]);
    let mass = PAYLOAD * ctx.arm.payload * order.size * rng.uniform(SPREAD);
    let away = rng.uniform(REACH) * ctx.arm.payload.sqrt();
    let com = ctx.arm.flange + ctx.arm.flange.normalize() * away + rng.direction() * (0.5 * away);
    let sides = V3::from_fn(|_, _| away * rng.uniform((0.6, 2.0)));
    let body = Body { mass, com, inertia: box_inertia(mass, sides) };
    let last = ctx.arm.count() - 1;
    tell_payload(&mut fault, &body, order.form == 0);
    let hose = if order.form == 2 { 0.5 * mass } else { 0.0 };
    let span = ctx.arm.flange.norm() + ctx.arm.joints.iter().map(|j| j.origin.norm()).sum::<f64>();
    let rigid = move |m: &Moment| {
        let mut tau = torques(std::iter::once((last, &body)), m.pose, (m.v, m.a), &down());
        if hose > 0.0 {
            let rows = jacobian(m.pose, last, &m.pose.flange);
            let weight = hose * GRAVITY * (m.pose.flange.z / span).clamp(0.0, 1.0);
            for j in 0..=last {
                tau[j] += rows[j].z * weight;
            }
        }
        tau
    };
    fault.field = Some(Box::new(rigid));
    if order.form == 1 {
        let (omega, zeta) = (std::f64::consts::TAU * rng.log(JAWS), rng.uniform((0.1, 0.3)));
        for j in 0..=last {
            fault.law(j, Oscillator::new(omega, zeta, |x| x.field));
        }
    } else {
        fault.loads = true;
    }
    if order.form != 1 {
        fault.same_as(&["link_parameters"]);
    }
    fault
}

/// Bodies of links: a lump, a centre that is elsewhere, and a hollow shell.
pub(super) fn links(ctx: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["lump", "moved_centre", "shell"];
    let mut fault = Fault::new("link_parameters", names[order.form], order.joints);
    let mut parts: Vec<(usize, Body)> = Vec::new();
    for &k in order.joints {
        let link = &ctx.arm.bodies[k];
        let share = 0.3 * order.size * rng.uniform(SPREAD);
        let size = (link.inertia.trace() / link.mass.max(1e-9)).sqrt();
        let mass = share * link.mass;
        let aside = rng.direction() * (size * rng.uniform((0.2, 1.0)));
        let place = link.com + aside;
        match order.form {
            1 => {
                // The same mass somewhere else: a lump moves along.
                let moved = Body { mass, com: place, inertia: M3::zeros() };
                let gone = Body { mass: -mass, com: link.com - aside, inertia: M3::zeros() };
                parts.extend([(k, moved), (k, gone)]);
            }
            form => {
                let wide = size * if form == 0 { 0.4 } else { 1.4 };
                let inertia = box_inertia(mass, V3::from_fn(|_, _| wide * rng.uniform((0.5, 1.0))));
                parts.push((k, Body { mass, com: place, inertia }));
            }
        }
        let own = |f: &dyn Fn(&Body) -> f64| -> f64 {
            parts.iter().filter(|(link, _)| *link == k).map(|(_, b)| f(b)).sum()
        };
        let graded = order.joints.len() == 1;
        let values = [
            ("mass", own(&|b| b.mass)),
            ("moment_x", own(&|b| b.mass * b.com.x)),
            ("moment_y", own(&|b| b.mass * b.com.y)),
            ("moment_z", own(&|b| b.mass * b.com.z)),
        ];
        for (name, value) in values {
            // Only combinations of bodies show in torques: nothing of it is graded but at the tip.
            fault.truth.tell(
                name,
                Some(k),
                value,
                graded && k + 1 == ctx.arm.count() && name != "mass",
            );
        }
    }
    let last = order.joints.iter().all(|k| k + 1 == ctx.arm.count());
    fault.field = Some(Box::new(move |m: &Moment| {
        torques(parts.iter().map(|(k, b)| (*k, b)), m.pose, (m.v, m.a), &down())
    }));
    fault.loads = true;
    if last {
        fault.same_as(&["payload"]);
    }
    fault
}

/// Tilt of the base: fixed, of a foundation that gives way under the moment, and slightly conical.
pub(super) fn tilt(_: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["fixed_tilt", "soft_foundation", "turntable_runout"];
    let mut fault = Fault::new("base_tilt", names[order.form], &[]);
    let angle = (TILT.0 * order.size * rng.uniform(SPREAD)).min(TILT.1);
    let direction = rng.angle();
    let form = order.form;
    let bend = 0.3 * angle;
    fault.field = Some(Box::new(move |m: &Moment| {
        let mut lean = V3::new(direction.cos(), direction.sin(), 0.0) * angle;
        if form == 1 {
            // The arm's weight leans the base further to its own side.
            let out = V3::new(m.pose.flange.x, m.pose.flange.y, 0.0);
            lean += out * (bend / (out.norm() + m.pose.flange.z.abs()).max(0.1));
        } else if form == 2 {
            // The turntable's plane wobbles with axis 1.
            lean += V3::new((2.0 * m.q[0]).cos(), (2.0 * m.q[0]).sin(), 0.0) * (0.15 * angle);
        }
        let size = lean.norm().max(1e-12);
        let axis = V3::new(-lean.y, lean.x, 0.0) / size;
        // Rodrigues' formula for a vector at right angles to the axis: the base leans, so that gravity
        // leans the same way in its frame.
        let g = down() * size.cos() - axis.cross(&down()) * size.sin();
        gravity_torques(m.arm, m.pose, &(g - down()))
    }));
    fault.loads = true;
    fault.truth.tell("angle", None, angle, form == 0);
    fault.truth.tell("direction", None, direction, form == 0);
    fault
}

/// An encoder that shows another angle than the joint has.
struct Shown {
    offset: f64,
    wave: f64,
    phase: f64,
    lost: f64,
}

impl Law for Shown {
    fn start(&self, x: &View) -> States {
        states([0.0, x.v.signum()])
    }
    fn rates(&self, x: &View, s: &States) -> States {
        // Lost motion of a belt, taken up within 30 ms after a reversal, twice filtered.
        states([(s[1] - s[0]) / 0.03, (x.sign - s[1]) / 0.03])
    }
    fn bend(&self, x: &View, s: &States) -> f64 {
        -self.offset * (1.0 + self.wave * (x.q - self.phase).sin()) + self.lost * s[0]
    }
}

/// Offset of an angle: fixed, with an eccentric disc, and with lost motion of a belt.
pub(super) fn encoder(_: &Context, order: &Order, rng: &mut Rng) -> Fault {
    let names = ["lost_turns", "eccentric_disc", "slipped_belt"];
    let mut fault = Fault::new("encoder_offset", names[order.form], order.joints);
    for &j in order.joints {
        let size = (OFFSET.0 * order.size * rng.uniform(SPREAD)).min(OFFSET.1);
        let offset = size * rng.sign();
        let form = order.form;
        fault.law(
            j,
            Shown {
                offset,
                wave: if form == 1 { 0.2 } else { 0.0 },
                phase: rng.angle(),
                lost: if form == 2 { 0.05 * size.min(0.02) } else { 0.0 },
            },
        );
        fault.truth.tell("offset", Some(j), offset, form != 1);
    }
    fault
}

//! Random faults of bodies, springs, gravity, contact, angles and compliance.

use super::body::{BodyLaw, SoftForm, SoftLaw};
use super::fault::{Act, Fault, Place, some_joints};
use super::friction::window;
use super::link::{LinkForm, LinkLaw};
use super::spatial::inertia_of;
use crate::examine::worlds::model::{Body, M3, V3};
use crate::examine::worlds::random::Rng;
use std::f64::consts::{PI, TAU};

/// A fault of bodies and surroundings; sizes are usual ones, to be scaled.
pub(super) fn draw(id: &'static str, place: &Place, rng: &mut Rng) -> Option<Fault> {
    match id {
        "payload" => Some(payload(place, rng)),
        "gravity_spring" => Some(balancer(place, rng)),
        "cable" => Some(cable(place, rng)),
        "base_tilt" => Some(tilt(rng)),
        "encoder_offset" => Some(encoder(place, rng)),
        "backlash" => Some(backlash(place, rng)),
        "elasticity" => Some(elasticity(place, rng)),
        "contact" => Some(contact(place, rng)),
        "link_parameters" => Some(lumps(place, rng)),
        _ => None,
    }
}

/// A box of a mass \[kg\] with its centre at a place \[m\].
fn brick(mass: f64, com: V3, size: f64, rng: &mut Rng) -> Body {
    let sides = V3::from_fn(|_, _| size * rng.between(0.5, 1.5));
    let second = M3::from_diagonal(&sides.component_mul(&sides)) * (mass / 12.0);
    Body { mass, com, inertia: inertia_of(&second) }
}

/// A body at the flange, beyond the last link's centre.
pub(super) fn gripped(place: &Place, share: f64, rng: &mut Rng) -> Body {
    let mass = share * place.arm.payload;
    let size = 0.09 * place.arm.payload.cbrt();
    let own = place.arm.bodies.last().map_or_else(V3::zeros, |body| body.com);
    let out = own.try_normalize(1e-6).unwrap_or_else(V3::z) * (size * rng.between(0.8, 2.0));
    let shift = V3::from_fn(|_, _| 0.6 * size * rng.spread(1.0));
    brick(mass, own + out + shift, size, rng)
}

fn payload(place: &Place, rng: &mut Rng) -> Fault {
    let mut body = gripped(place, 0.15, rng);
    let mut bounds = [0.05, 7.0];
    if rng.chance(0.15)
        && let Some(own) = place.arm.bodies.last()
    {
        // A part of the tool is gone: at most half of the last body.
        body = Body { mass: -0.1 * own.mass, com: own.com, inertia: own.inertia * -0.1 };
        bounds = [0.05, 5.0];
    }
    let fault = if body.mass < 0.0 || rng.chance(0.6) {
        Fault::new("payload", "rigid box", &[], vec![Act::Body(BodyLaw::Payload { body })], bounds)
    } else {
        let sway = rng.between(0.02, 0.1) * place.arm.payload.cbrt() * 0.3;
        Fault::new(
            "payload",
            "vessel with liquid",
            &[],
            vec![Act::Body(BodyLaw::Vessel { body, sway })],
            bounds,
        )
    };
    fault.like(&["link_parameters"])
}

fn balancer(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let joint = if rng.chance(0.7) { 1 } else { 2 };
    let stiffness = 0.2 * arm.usual[joint] / arm.span[joint] * rng.sign();
    let centre = arm.middle[joint] + rng.between(-0.8, 0.8) * arm.span[joint];
    let (name, form) = if rng.chance(0.5) {
        let form = LinkForm::Lever { arm: rng.between(2.0, 5.0), free: rng.between(0.5, 0.9) };
        ("helical spring on a lever", form)
    } else {
        ("gas cylinder", LinkForm::Gas { fill: rng.between(0.05, 0.3) })
    };
    let acts = vec![Act::Link(joint, LinkLaw { stiffness, centre, form })];
    Fault::new("gravity_spring", name, &[joint], acts, [0.1, 6.0]).like(&["cable"])
}

fn cable(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    // Hoses hang at the base and at the wrist; springs of axes 2 and 3 are balancers.
    let ends: Vec<usize> = (0..arm.axes()).filter(|joint| !(1..3).contains(joint)).collect();
    let count = rng.pick(&[1, 1, 1, 2, 2, 3]);
    let joints = rng.choose(&ends, count);
    let strands = rng.chance(0.5);
    let share = rng.between(0.4, 0.8);
    let mut acts = Vec::new();
    for joint in &joints {
        let span = arm.span[*joint];
        let centre = arm.middle[*joint] + rng.between(-0.6, 0.6) * span;
        let form = if strands {
            LinkForm::BoucWen { share, distance: span * rng.between(0.1, 0.3) }
        } else {
            LinkForm::Taut { width: span * rng.between(0.3, 0.8) }
        };
        acts.push(Act::Link(
            *joint,
            LinkLaw { stiffness: 0.12 * arm.usual[*joint] / span, centre, form },
        ));
    }
    let name = if strands { "Bouc-Wen strands" } else { "taut at the ends" };
    Fault::new("cable", name, &joints, acts, [0.1, 6.0]).like(&["gravity_spring"])
}

fn tilt(rng: &mut Rng) -> Fault {
    let direction = rng.between(-PI, PI);
    let (name, soft) = if rng.chance(0.5) {
        ("base plate that gives", 0.12)
    } else {
        ("loose foot", 0.3 * rng.sign())
    };
    let law = BodyLaw::Tilt { angle: 0.02, direction, soft };
    Fault::new("base_tilt", name, &[], vec![Act::Body(law)], [0.1, 15.0])
}

fn encoder(place: &Place, rng: &mut Rng) -> Fault {
    // The first axis is vertical: its angle changes no torque.
    let inner: Vec<usize> = (1..place.arm.axes()).collect();
    let count = rng.pick(&[1, 1, 2]);
    let joints = rng.choose(&inner, count);
    let eccentric = rng.chance(0.5);
    let order = if eccentric { 1.0 } else { rng.pick(&[2.0, 4.0]) };
    let wave = if eccentric { 0.002 } else { 0.0008 };
    let act = |joint: &usize| {
        let offset = 0.012 * rng.sign() * rng.between(0.6, 1.5);
        Act::Body(BodyLaw::Offset {
            joint: *joint,
            offset,
            wave,
            order,
            phase: rng.between(0.0, TAU),
        })
    };
    let acts = joints.iter().map(act).collect();
    let name = if eccentric { "eccentric coupling" } else { "interpolation error" };
    Fault::new("encoder_offset", name, &joints, acts, [0.08, 25.0])
}

/// A compliance for some joints, of a law without stiffness and inertia; natural frequency \[Hz\] of the link on its gear.
fn soft(place: &Place, joints: &[usize], frequency: f64, law: SoftLaw) -> Vec<Act> {
    let inertia = place.arm.own_inertia();
    let act = |joint: &usize| {
        let own = inertia[*joint].max(1e-5);
        let stiffness = own * (TAU * frequency).powi(2);
        let form = match law.form {
            // Twice as stiff at twice the usual deflection.
            SoftForm::Hardening { .. } => {
                SoftForm::Hardening { reference: 2.0 * place.arm.usual[*joint] / stiffness }
            }
            other => other,
        };
        let law = SoftLaw { stiffness, inertia: own, form, ..law };
        Act::Body(BodyLaw::Soft { joint: *joint, law })
    };
    joints.iter().map(act).collect()
}

fn backlash(place: &Place, rng: &mut Rng) -> Fault {
    let joints = some_joints(place.arm, rng);
    let (name, form) = if rng.chance(0.5) {
        ("gap with impact damping", SoftForm::Impact)
    } else {
        ("gap with grease cushion", SoftForm::Cushion)
    };
    let law =
        SoftLaw { stiffness: 0.0, gap: 0.002, inertia: 0.0, damping: rng.between(0.25, 0.5), form };
    let acts = soft(place, &joints, rng.between(8.0, 22.0), law);
    Fault::new("backlash", name, &joints, acts, [0.1, 10.0])
}

fn elasticity(place: &Place, rng: &mut Rng) -> Fault {
    let joints = some_joints(place.arm, rng);
    let (name, form) = if rng.chance(0.5) {
        ("spring and damper", SoftForm::Linear)
    } else {
        ("hardening spring", SoftForm::Hardening { reference: 1.0 })
    };
    let law =
        SoftLaw { stiffness: 0.0, gap: 0.0, inertia: 0.0, damping: rng.between(0.08, 0.35), form };
    let acts = soft(place, &joints, rng.between(9.0, 18.0), law);
    Fault::new("elasticity", name, &joints, acts, [0.1, 10.0])
}

fn contact(place: &Place, rng: &mut Rng) -> Fault {
    let force = 3.0 * place.arm.payload.max(1.0);
    let window = window(place, rng);
    let (azimuth, elevation) = (rng.between(-PI, PI), rng.between(-1.3, 1.3));
    let lopsided = rng.chance(0.5);
    let law = BodyLaw::Contact { force, azimuth, elevation, window, lopsided };
    let name = if lopsided { "quick rise, slow release" } else { "squared sine" };
    let mut fault = Fault::new("contact", name, &[], vec![Act::Body(law)], [0.05, 12.0]);
    fault.window = Some(window);
    fault
}

/// One or two links with something on them that the model does not know.
fn lumps(place: &Place, rng: &mut Rng) -> Fault {
    let arm = place.arm;
    let all: Vec<usize> = (1..arm.axes()).collect();
    let count = rng.whole(1, 2);
    let links = rng.choose(&all, count);
    let scaled = rng.chance(0.5);
    let act = |link: &usize| {
        let own = arm.bodies.get(*link).copied().unwrap_or(Body {
            mass: 1.0,
            com: V3::zeros(),
            inertia: M3::identity(),
        });
        let body = if scaled {
            // Another casting: all of the body by a share.
            Body { mass: 0.3 * own.mass, com: own.com, inertia: own.inertia * 0.3 }
        } else {
            let far = 0.25 * arm.payload.powf(0.27);
            let at = own.com + V3::from_fn(|_, _| far * rng.between(-0.7, 0.7));
            brick(0.25 * own.mass, at, 0.15 * arm.payload.cbrt(), rng)
        };
        Act::Body(BodyLaw::Lump { link: *link, body })
    };
    let acts: Vec<Act> = links.iter().map(act).collect();
    let name = if scaled { "denser casting" } else { "added equipment" };
    // Far off: at least a fifth of the body, beyond twice the spread of drawings.
    let fault = Fault::new("link_parameters", name, &links, acts, [0.7, 6.0]);
    if links.contains(&(arm.axes() - 1)) && links.len() == 1 {
        fault.like(&["payload"])
    } else {
        fault
    }
}

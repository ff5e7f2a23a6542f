//! Draws faults of bodies, springs, gears, encoders and forces.

use crate::examine::worlds::model::{MAX, V3};
use std::f64::consts::{PI, TAU};

use super::arm::block;
use super::fault::{Action, Fault, Ground};
use super::rigid::GRAVITY;
use super::structure::{Change, Contact, Encoder, Flex, Wrist};
use super::terms::{Law, Term};
use crate::examine::worlds::random::Rng;

/// Ids drawn here.
pub(super) const IDS: [&str; 11] = [
    "payload",
    "rotor_inertia",
    "gravity_spring",
    "base_tilt",
    "encoder_offset",
    "cable",
    "backlash",
    "elasticity",
    "ripple",
    "wrist_coupling",
    "contact",
];

/// Draws a fault of an id.
pub(super) fn draw(id: &str, ground: &Ground, rng: &mut Rng) -> Fault {
    match id {
        "payload" => payload(ground, rng),
        "link_parameters" => links(ground, rng),
        "rotor_inertia" => rotor(ground, rng),
        "gravity_spring" => spring(ground, rng),
        "base_tilt" => tilt(ground, rng),
        "encoder_offset" => encoder(ground, rng),
        "cable" => cable(ground, rng),
        "backlash" | "elasticity" => gear(id, ground, rng),
        "ripple" => ripple(ground, rng),
        "wrist_coupling" => wrist(ground, rng),
        _ => contact(ground, rng),
    }
}

fn direction(rng: &mut Rng) -> V3 {
    let v = rng.normals();
    v / v.norm().max(1e-6)
}

fn payload(g: &Ground, rng: &mut Rng) -> Fault {
    let size = g.robot.size;
    let mass = size.payload * rng.log_between(0.06, 0.9);
    let form = rng.below(3);
    let name = ["box", "long rod", "half-filled tank"][form];
    // Edges of a load of the density of 1.5 kg/l, or a rod of four times the length.
    let edge = (mass / 1500.0).cbrt();
    let edges = match form {
        1 => V3::new(0.5 * edge, 0.5 * edge, 4.0 * edge),
        _ => V3::new(edge, edge * rng.between(0.6, 1.6), edge * rng.between(0.6, 1.6)),
    };
    let out = g.robot.arm.flange.normalize();
    let com = g.robot.arm.flange
        + out * rng.between(0.2, 0.8) * edge
        + direction(rng) * rng.between(0.0, 0.06) * size.reach;
    let slosh = if form == 2 { 0.15 * edge } else { 0.0 };
    let last = g.n() - 1;
    let change = Change::Add { link: last, body: block(mass, com, edges), slosh, now: V3::zeros() };
    let solid = form != 2;
    Fault::new("payload", name, &[], Action::Body(vec![change]))
        .graded("mass", None, mass)
        .parameter("com_x", None, com.x, solid)
        .parameter("com_y", None, com.y, solid)
        .parameter("com_z", None, com.z, solid)
        .like(&["link_parameters"])
}

fn links(g: &Ground, rng: &mut Rng) -> Fault {
    let wanted = if rng.chance(0.5) { 1 } else { 2 };
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < wanted {
        let i = 1 + rng.below(g.n() - 1);
        if !chosen.contains(&i) {
            chosen.push(i);
        }
    }
    chosen.sort_unstable();
    let mut changes = Vec::new();
    let mut values = Vec::new();
    let far = (3.0 * g.spread.mass).max(0.2);
    for &link in &chosen {
        if let Some(old) = g.robot.arm.bodies.get(link) {
            let mut body = old.clone();
            let more = rng.between(far, far + 0.4);
            let factor = if rng.chance(0.5) { 1.0 + 1.5 * more } else { 1.0 / (1.0 + 1.5 * more) };
            body.mass *= factor;
            body.inertia *= factor;
            body.com += direction(rng) * rng.between(0.03, 0.1) * g.robot.size.reach;
            values.push((link, body.mass - old.mass));
            changes.push(Change::Replace { link, body });
        }
    }
    let form = "other bodies of the links";
    let mut fault = Fault::new("link_parameters", form, &chosen, Action::Body(changes));
    for (link, mass) in values {
        fault = fault.own("mass", Some(link), mass);
    }
    if chosen == [g.n() - 1] { fault.like(&["payload"]) } else { fault }
}

fn rotor(g: &Ground, rng: &mut Rng) -> Fault {
    let i = rng.below(g.n());
    let most = 2.0 * g.robot.arm.rotor[i];
    let size = (g.torque(i, rng) / g.scale.acceleration[i]).clamp(0.05 * most, most);
    let form = rng.below(3);
    let name = ["viscous coupling", "slipping clutch", "rigid"][form];
    let stiff = size / 0.008;
    let limit = 1.6 * size * g.scale.acceleration[i];
    let (value, action) = match form {
        0 => (size, Action::Terms(vec![Term::new(i, Law::Coupling, &[size, stiff])])),
        1 => (size, Action::Terms(vec![Term::new(i, Law::Clutch, &[size, stiff, limit])])),
        _ => {
            let value = if rng.chance(0.3) { -size.min(0.5 * g.robot.arm.rotor[i]) } else { size };
            let mut inertia = [0.0; MAX];
            inertia[i] = value;
            (value, Action::Body(vec![Change::Rotor { inertia }]))
        }
    };
    let fault = Fault::new("rotor_inertia", name, &[i], action).parameter(
        "inertia",
        Some(i),
        value,
        form != 1,
    );
    if i < 2 { fault.like(&["link_parameters"]) } else { fault }
}

fn spring(g: &Ground, rng: &mut Rng) -> Fault {
    let i = if rng.chance(0.8) { 1 } else { g.loaded(rng) };
    let size = 1.5 * g.torque(i, rng) * rng.sign();
    let centre = g.scale.middle[i] + g.scale.width[i] * rng.between(-0.5, 0.5);
    let reach = g.scale.width[i].min(1.2).sin().max(0.1);
    let crank = rng.chance(0.5);
    let term = if crank {
        Term::new(i, Law::Crank, &[2.0 * size / reach, centre, 0.5, rng.between(0.2, 0.4)])
    } else {
        Term::new(i, Law::Gas, &[size / reach, centre, rng.between(0.15, 0.4)])
    };
    let name = if crank { "spring on a crank" } else { "gas spring on a crank" };
    // The slope at the centre is the stiffness.
    let p = term.p;
    let slope =
        if crank { p[0] * (1.0 - p[2] / (1.0 - p[3])) } else { p[0] * (1.0 - p[2]).powf(-1.3) };
    Fault::new("gravity_spring", name, &[i], Action::Terms(vec![term]))
        .own("stiffness", Some(i), slope)
        .graded("centre", Some(i), centre)
        .like(&["cable"])
}

fn tilt(g: &Ground, rng: &mut Rng) -> Fault {
    let angle = rng.log_between(0.008, 0.25);
    let direction = rng.between(-PI, PI);
    let stiff = rng.chance(0.4);
    let soft = if stiff { 0.0 } else { rng.between(0.1, 0.3) };
    let scale = 2.0 * g.scale.load[1];
    let name = if stiff { "leaning base" } else { "leaning base that gives way" };
    let change = Change::Tilt { angle, direction, soft, scale, now: 0.0 };
    Fault::new("base_tilt", name, &[], Action::Body(vec![change]))
        .parameter("angle", None, angle, true)
        .graded("direction", None, direction)
}

fn encoder(g: &Ground, rng: &mut Rng) -> Fault {
    let i = g.loaded(rng);
    let offset = rng.sign() * rng.log_between(0.008, 0.2);
    let wave = rng.chance(0.5);
    let (name, encoder) = if wave {
        let wave = (0.15 * offset, rng.between(0.0, TAU));
        ("offset and eccentricity", Encoder { joint: i, offset, wave, slope: (0.0, 0.0) })
    } else {
        let slope = (0.1 * offset / g.scale.width[i], g.scale.middle[i]);
        ("offset and error of the ratio", Encoder { joint: i, offset, wave: (0.0, 0.0), slope })
    };
    Fault::new("encoder_offset", name, &[i], Action::Encoder(encoder)).graded(
        "offset",
        Some(i),
        offset,
    )
}

fn cable(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(2, rng);
    let form = rng.below(3);
    let name = ["hose with hysteresis", "hardening hose", "hose that is slack at one side"][form];
    let mut terms = Vec::new();
    for &i in &joints {
        let size = 1.5 * g.torque(i, rng);
        let width = g.scale.width[i];
        let centre = g.scale.middle[i] + width * rng.between(-0.4, 0.4);
        let k = size / width;
        terms.push(match form {
            0 => Term::new(i, Law::HoseHysteresis, &[k, centre, 0.15 * size, 0.15 * width]),
            1 => Term::new(i, Law::Hardening, &[0.5 * k, centre, 0.7 * k / (width * width)]),
            _ => Term::new(i, Law::Slack, &[1.5 * k, centre, rng.sign(), 0.1 * width]),
        });
    }
    let values: Vec<(usize, f64, f64)> = terms.iter().map(|t| (t.joint, t.p[0], t.p[1])).collect();
    let mut fault = Fault::new("cable", name, &joints, Action::Terms(terms));
    for (i, k, centre) in values {
        fault = fault.parameter("stiffness", Some(i), k, form == 0);
        fault = fault.parameter("centre", Some(i), centre, form != 2);
    }
    fault.like(&["gravity_spring"])
}

/// An elastic gear or one with a gap.
fn gear(id: &str, g: &Ground, rng: &mut Rng) -> Fault {
    let joint = if id == "elasticity" { rng.below(g.n() - 2) } else { rng.below(g.n() - 1) };
    let inertia = g.robot.arm.pose(&g.scale.middle).mass_matrix()[(joint, joint)];
    let simple = rng.chance(0.5);
    let gap = if id == "backlash" { rng.log_between(0.0008, 0.015) } else { 0.0 };
    // Resonance of the link alone \[rad/s\].
    let wave = TAU * if gap > 0.0 { rng.between(15.0, 25.0) } else { rng.log_between(3.5, 11.0) };
    let stiffness = wave * wave * inertia;
    let hard = if simple { 0.0 } else { rng.between(0.4, 1.0) };
    let damping = 2.0 * rng.between(0.08, 0.2) * stiffness / wave;
    let reference = 1.5 * g.scale.load[joint] / stiffness;
    let flex = Flex { joint, stiffness, hard, reference, damping, gap };
    let name = match (gap > 0.0, simple) {
        (true, true) => "two masses with a gap, Hunt and Crossley damping",
        (true, false) => "two masses with a gap and hardening teeth",
        (false, true) => "two masses with a damped spring",
        (false, false) => "two masses with a hardening flexspline",
    };
    let fault = Fault::new(id, name, &[joint], Action::Flex(flex));
    if gap > 0.0 {
        return fault.graded("gap", Some(joint), gap).parameter(
            "stiffness",
            Some(joint),
            stiffness,
            simple,
        );
    }
    fault.parameter("stiffness", Some(joint), stiffness, simple)
}

fn ripple(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(2, rng);
    let form = rng.below(3);
    let name = ["two harmonics", "washed out by speed", "grows with the load"][form];
    let mut fault = Fault::new("ripple", name, &joints, Action::Nothing);
    let mut terms = Vec::new();
    for i in joints {
        // At most a third of the samples per wave at twice the rms speed.
        let most = (TAU * g.rate / (6.0 * g.scale.rate[i])).clamp(6.0, 400.0);
        let order = rng.log_between(3.0, most).round().max(2.0);
        let (size, phase) = (1.4 * g.torque(i, rng), rng.between(0.0, TAU));
        let law = [Law::Harmonics, Law::WashedRipple, Law::LoadedRipple][form];
        let p = match form {
            0 => [size, phase, order, rng.between(0.2, 0.45), rng.between(0.0, TAU)],
            1 => [size, phase, order, 1.5 * g.scale.rate[i], 0.0],
            _ => [0.6 * size, phase, order, 0.8 / g.scale.load[i], 0.0],
        };
        terms.push(Term::new(i, law, &p));
        fault = fault
            .parameter("amplitude", Some(i), p[0], form == 0)
            .graded("phase", Some(i), phase)
            .graded("order", Some(i), order);
    }
    Fault { action: Action::Terms(terms), ..fault }
}

fn wrist(g: &Ground, rng: &mut Rng) -> Fault {
    let coupling = rng.sign() * rng.log_between(0.08, 1.0);
    let loaded = rng.chance(0.5);
    let load = if loaded { rng.between(0.03, 0.12) } else { 0.0 };
    let name =
        if loaded { "bristles and friction of the load" } else { "bristles of the real gear" };
    let joints = [g.n() - 2, g.n() - 1];
    let action = Action::Wrist(Wrist { coupling, load });
    Fault::new("wrist_coupling", name, &joints, action).graded("coupling", None, coupling)
}

fn contact(g: &Ground, rng: &mut Rng) -> Fault {
    let force = g.robot.size.payload * GRAVITY * rng.log_between(0.15, 1.5);
    let (azimuth, elevation) = (rng.between(-PI, PI), rng.between(-1.4, 1.4));
    let direction =
        V3::new(elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin());
    let from = rng.between(0.1, 0.55) * g.period;
    let to = from + rng.between(0.12, 0.35) * g.period;
    let shape = rng.below(3) as u8;
    let name = ["haversine", "hard contact, slow release", "chattering"][usize::from(shape)];
    let mu = rng.between(0.0, 0.15);
    let contact = Contact { direction, force, window: (from, to), shape, mu };
    let sharp = shape == 1;
    Fault::new("contact", name, &[], Action::Contact(contact))
        .within(from, to)
        .graded("force", None, force)
        .parameter("t_start_s", None, from, sharp)
        .parameter("t_end_s", None, to, sharp)
        .graded("azimuth", None, azimuth)
        .graded("elevation", None, elevation)
}

//! Draws faults of bodies, springs, gears, encoders and forces.

use crate::examine::worlds::api::single;
use crate::examine::worlds::model::V3;
use std::f64::consts::{PI, TAU};

use super::arm::block;
use super::fault::{Action, Fault, Ground};
use super::rigid::GRAVITY;
use super::structure::{Change, Contact, Encoder, Flex, Wrist};
use super::terms::Term;
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
            let mut body = *old;
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

/// A disc behind a viscous coupling or a clutch that slips, and a rigid one.
fn rotor(g: &Ground, rng: &mut Rng) -> Fault {
    let i = rng.below(g.n());
    let most = 2.0 * g.robot.arm.rotor[i];
    let size = (g.torque(i, rng) / g.scale.acceleration[i]).clamp(0.05 * most, most);
    let form = rng.below(3);
    let name = ["viscous coupling", "slipping clutch", "rigid"][form];
    let fault = if form == 2 {
        let value = if rng.chance(0.3) { -size.min(0.5 * g.robot.arm.rotor[i]) } else { size };
        let change = Change::Rotor { inertia: single(i, value) };
        Fault::new("rotor_inertia", name, &[i], Action::Body(vec![change])).graded(
            "inertia",
            Some(i),
            value,
        )
    } else {
        let stiff = size / 0.008;
        let limit = if form == 1 { 1.6 * size * g.scale.acceleration[i] } else { f64::INFINITY };
        Fault::terms("rotor_inertia", name, &[i], |i| {
            let term = Term::new(i, move |x, states| {
                let slip = x.v - states[0];
                // Implicit in the disc's own speed: stable for every stiffness of the coupling.
                let torque = stiff * slip / (1.0 + x.now.dt * stiff / size);
                let torque = torque.clamp(-limit, limit);
                states[0] += x.now.dt * torque / size;
                (0.0, torque)
            });
            (term, vec![("inertia", size, form == 0)])
        })
    };
    if i < 2 { fault.like(&["link_parameters"]) } else { fault }
}

/// A spring on a crank, and a gas spring; the slope at the centre is the stiffness.
fn spring(g: &Ground, rng: &mut Rng) -> Fault {
    let i = if rng.chance(0.8) { 1 } else { g.loaded(rng) };
    let size = 1.5 * g.torque(i, rng) * rng.sign();
    let centre = g.scale.middle[i] + g.scale.width[i] * rng.between(-0.5, 0.5);
    let reach = g.scale.width[i].min(1.2).sin().max(0.1);
    let (name, slope, term) = if rng.chance(0.5) {
        let (k, arm) = (2.0 * size / reach, rng.between(0.2, 0.4));
        let term = Term::smooth(i, move |x| {
            let d = x.q - centre;
            let length = (1.0 + arm * arm - 2.0 * arm * d.cos()).max(1e-6).sqrt();
            k * d.sin() * (1.0 - 0.5 / length)
        });
        ("spring on a crank", k * (1.0 - 0.5 / (1.0 - arm)), term)
    } else {
        let (k, fill) = (size / reach, rng.between(0.15, 0.4));
        let term = Term::smooth(i, move |x| {
            let d = x.q - centre;
            k * d.sin() * (1.0 - fill * d.cos()).max(0.05).powf(-1.3)
        });
        ("gas spring on a crank", k * (1.0 - fill).powf(-1.3), term)
    };
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

/// A hose with friction inside (Dahl), one that hardens, and one that is taut beyond an angle.
fn cable(g: &Ground, rng: &mut Rng) -> Fault {
    let joints = g.joints(2, rng);
    let form = rng.below(3);
    let name = ["hose with hysteresis", "hardening hose", "hose that is slack at one side"][form];
    let fault = Fault::terms("cable", name, &joints, |i| {
        let size = 1.5 * g.torque(i, rng);
        let width = g.scale.width[i];
        let centre = g.scale.middle[i] + width * rng.between(-0.4, 0.4);
        let k = size / width * [1.0, 0.5, 1.5][form];
        let side = if form == 2 { rng.sign() } else { 1.0 };
        let (cubic, soft) = (0.7 * size / width.powi(3), 0.1 * width);
        let term = Term::new(i, move |x, states| {
            let d = x.q - centre;
            let torque = match form {
                0 => {
                    let step = x.now.dt / (0.15 * width);
                    states[0] = (states[0] + step * x.v) / (1.0 + step * x.v.abs());
                    k * d + 0.15 * size * states[0]
                }
                1 => k * d + cubic * d * d * d,
                _ => side * k * 0.5 * (side * d + (d * d + soft * soft).sqrt()),
            };
            (0.0, torque)
        });
        (term, vec![("stiffness", k, form == 0), ("centre", centre, form != 2)])
    });
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
    Fault::terms("ripple", name, &joints, |i| {
        // At most a third of the samples per wave at twice the rms speed.
        let most = (TAU * g.rate / (6.0 * g.scale.rate[i])).clamp(6.0, 400.0);
        let order = rng.log_between(3.0, most).round().max(2.0);
        let (size, phase) = (1.4 * g.torque(i, rng), rng.between(0.0, TAU));
        let size = if form == 2 { 0.6 * size } else { size };
        let (share, other) =
            if form == 0 { (rng.between(0.2, 0.45), rng.between(0.0, TAU)) } else { (0.0, 0.0) };
        let (fast, loaded) = (1.5 * g.scale.rate[i], 0.8 / g.scale.load[i]);
        let term = Term::smooth(i, move |x| {
            let wave = (order * x.q - phase).cos();
            match form {
                0 => size * (wave + share * (2.0 * order * x.q - other).cos()),
                1 => size * wave / (1.0 + (x.v / fast).powi(2)),
                _ => size * (1.0 + loaded * x.load.abs()) * wave,
            }
        });
        let told = [("amplitude", size, form == 0), ("phase", phase, true), ("order", order, true)];
        (term, told.to_vec())
    })
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

//! Geometry of random arms: architectures, frames and bodies.

use super::rigid::{Arm, GRAVITY, about, from_rpy, joined};
use crate::examine::worlds::model::{Body, Joint, M3, MAX, V3};
use crate::examine::worlds::random::Rng;

/// How an arm is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Build {
    /// Industrial elbow arm with a spherical wrist.
    Elbow,
    /// Elbow arm whose wrist axes do not meet, or are inclined.
    OffsetWrist,
    /// Cobot: three parallel axes, harmonic drives.
    Cobot,
    /// Seven axes: shoulder, elbow, wrist.
    Seven,
}

impl Build {
    /// Whether its gears are harmonic drives.
    pub(super) fn harmonic(self) -> bool {
        matches!(self, Self::Cobot | Self::Seven)
    }
}

/// A joint in frames that are all parallel to the base at angle 0.
struct Place {
    origin: V3,
    axis: V3,
}

/// Main dimensions of an arm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    /// Payload \[kg\].
    pub(super) payload: f64,
    /// Reach \[m\].
    pub(super) reach: f64,
    /// Mass of all moving links \[kg\].
    pub(super) mass: f64,
}

/// Reach \[m\] of an arm for 1 kg, and the power with which it grows with the payload
/// (data sheets: 0.5 m at 0.5 kg, 1.4 m at 20 kg, 2.8 m at 300 kg).
const REACH: (f64, f64) = (0.62, 0.27);
/// Moving mass per kg of payload at 1 kg \[kg\] and its power (7 kg at 1 kg, 1,000 kg at 200 kg).
const MASS: (f64, f64) = (6.5, 0.93);
/// Cobots are lighter by this.
const LIGHT: f64 = 0.65;
/// Radius of a link as a share of the reach.
const SLENDER: (f64, f64) = (0.035, 0.06);

/// Draws the size for a payload.
pub(super) fn size(payload: f64, build: Build, rng: &mut Rng) -> Size {
    let reach = REACH.0 * payload.powf(REACH.1) * rng.between(0.85, 1.2);
    let light = if build.harmonic() { LIGHT } else { 1.0 };
    let mass = MASS.0 * payload.powf(MASS.1) * light * rng.between(0.8, 1.25);
    Size { payload, reach, mass }
}

fn v(x: f64, y: f64, z: f64) -> V3 {
    V3::new(x, y, z)
}

/// Row and flange for a reach of 1 m.
fn places(build: Build, rng: &mut Rng) -> (Vec<Place>, V3) {
    let (x, y, z) = (v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0), v(0.0, 0.0, 1.0));
    let mut u = |low: f64, high: f64| rng.between(low, high);
    let list = match build {
        Build::Elbow | Build::OffsetWrist => {
            let offset = build == Build::OffsetWrist;
            let slant = u(0.6, 1.2);
            let inclined = offset && u(0.0, 1.0) < 0.5;
            let five = if inclined { v(slant.cos(), slant.sin(), 0.0) } else { y };
            let aside = if offset && !inclined { u(0.05, 0.12) } else { 0.0 };
            vec![
                (v(0.0, 0.0, u(0.12, 0.2)), z),
                (v(u(0.05, 0.15), 0.0, u(0.1, 0.18)), y),
                (v(0.0, 0.0, u(0.36, 0.46)), y),
                (v(u(0.08, 0.16), 0.0, u(0.0, 0.08)), x),
                (v(u(0.26, 0.34), 0.0, 0.0), five),
                (v(u(0.05, 0.08), aside, 0.0), x),
            ]
        }
        Build::Cobot => {
            let shoulder = u(0.1, 0.16);
            vec![
                (v(0.0, 0.0, u(0.1, 0.16)), z),
                (v(0.0, shoulder, u(0.04, 0.08)), y),
                (v(0.0, -shoulder * u(0.7, 1.0), u(0.42, 0.5)), y),
                (v(0.0, u(0.0, 0.03), u(0.36, 0.43)), y),
                (v(0.0, u(0.09, 0.13), 0.0), x),
                (v(0.0, 0.0, u(0.08, 0.11)), y),
            ]
        }
        Build::Seven => {
            let elbow = if u(0.0, 1.0) < 0.5 { 0.0 } else { u(0.05, 0.1) };
            vec![
                (v(0.0, 0.0, u(0.1, 0.16)), z),
                (v(0.0, 0.0, u(0.14, 0.2)), y),
                (v(0.0, 0.0, u(0.18, 0.24)), z),
                (v(elbow, 0.0, u(0.18, 0.24)), -y),
                (v(-elbow, 0.0, u(0.18, 0.24)), z),
                (v(0.0, 0.0, u(0.18, 0.22)), y),
                (v(elbow, 0.0, u(0.05, 0.09)), z),
            ]
        }
    };
    let flange = match build {
        Build::Cobot => y * u(0.06, 0.1),
        Build::Seven => z * u(0.06, 0.1),
        _ => x * u(0.02, 0.05),
    };
    (list.into_iter().map(|(origin, axis)| Place { origin, axis }).collect(), flange)
}

/// Share of the moving mass in each body, base to flange.
fn shares(n: usize) -> &'static [f64] {
    if n == MAX {
        &[0.2, 0.19, 0.17, 0.16, 0.12, 0.1, 0.035]
    } else {
        &[0.27, 0.28, 0.22, 0.12, 0.075, 0.03]
    }
}

/// A cylinder of a mass along a segment.
fn cylinder(mass: f64, from: V3, to: V3, radius: f64) -> Body {
    let along = to - from;
    let length = along.norm();
    let unit = if length > 1e-6 { along / length } else { v(0.0, 0.0, 1.0) };
    let axial = unit * unit.transpose();
    let across = (3.0 * radius * radius + length * length) / 12.0;
    let inertia = (M3::identity() - axial) * across + axial * (0.5 * radius * radius);
    Body { mass, com: (from + to) * 0.5, inertia: inertia * mass }
}

/// A box of a mass and edges \[m\] about a centre.
pub(super) fn block(mass: f64, com: V3, edges: V3) -> Body {
    let s = edges.component_mul(&edges) * (mass / 12.0);
    let inertia = M3::from_diagonal(&v(s.y + s.z, s.x + s.z, s.x + s.y));
    Body { mass, com, inertia }
}

/// A body along its link: tube, own gear, and motor of the next joint.
fn body(mass: f64, to: V3, radius: f64, rng: &mut Rng) -> Body {
    let mut jitter = |scale: f64| rng.normals() * scale;
    let tube = cylinder(0.5 * mass, jitter(0.3 * radius), to + jitter(0.3 * radius), radius);
    let edges = v(1.0, 1.0, 1.0) * (2.0 * radius) + jitter(0.2 * radius).abs();
    let gear = block(0.22 * mass, jitter(0.3 * radius), edges);
    let motor = block(0.28 * mass, to * 0.85 + jitter(0.5 * radius), edges * 0.8);
    joined(&joined(&tube, &gear), &motor)
}

/// Draws an arm without rotors: frames, bodies with a tool on the flange, gravity.
pub(super) fn arm(build: Build, size: &Size, rng: &mut Rng) -> Arm {
    let (places, flange) = places(build, rng);
    let n = places.len();
    let along_z = rng.chance(0.5);
    let tool = if rng.chance(0.6) { rng.between(0.1, 0.7) * size.payload } else { 0.0 };
    let mut before = M3::identity();
    if build.harmonic() && rng.chance(0.15) {
        let angle = rng.pick(&[std::f64::consts::PI, std::f64::consts::FRAC_PI_2]);
        before = about(&v(1.0, 0.0, 0.0), -angle);
    }
    let mut arm = Arm {
        joints: Vec::new(),
        bodies: Vec::new(),
        gravity: v(0.0, 0.0, -GRAVITY),
        rotor: [0.0; MAX],
        flange: V3::zeros(),
    };
    for (i, place) in places.iter().enumerate() {
        let turn = if along_z { towards(&place.axis) } else { M3::identity() };
        let rpy = rpy_of(&(before.transpose() * turn));
        let origin = rounded(before.transpose() * place.origin * size.reach);
        let axis = rounded(turn.transpose() * place.axis);
        let rotation = from_rpy(&rpy);
        arm.joints.push(Joint { origin, rpy, rotation, axis: axis.normalize() });
        let to = places.get(i + 1).map_or(flange, |next| next.origin) * size.reach;
        let thick = rng.between(SLENDER.0, SLENDER.1) * (1.2 - 0.1 * i as f64) * size.reach;
        let mass = shares(n).get(i).copied().unwrap_or(0.05) * size.mass * rng.between(0.85, 1.15);
        let mut own = body(mass, turn.transpose() * to, thick, rng);
        if i + 1 == n && tool > 0.0 {
            let edge = v(rng.between(0.6, 1.4), rng.between(0.6, 1.4), rng.between(0.6, 1.4))
                * thick
                * 2.0;
            let at = rng.normals() * (0.25 * thick);
            let out = turn.transpose() * flange * size.reach;
            own = joined(&own, &block(tool, out * (1.0 + thick / out.norm()) + at, edge));
        }
        arm.bodies.push(own);
        before = turn;
    }
    arm.flange = before.transpose() * flange * size.reach;
    arm
}

/// A rotation that turns z onto an axis.
fn towards(axis: &V3) -> M3 {
    let z = v(0.0, 0.0, 1.0);
    let cross = z.cross(axis);
    if cross.norm() < 1e-9 {
        let flip = if axis.z < 0.0 { std::f64::consts::PI } else { 0.0 };
        return about(&v(1.0, 0.0, 0.0), flip);
    }
    about(&cross.normalize(), z.dot(axis).clamp(-1.0, 1.0).acos())
}

/// Roll, pitch, yaw of a rotation.
fn rpy_of(r: &M3) -> V3 {
    let (roll, pitch, yaw) = nalgebra::Rotation3::from_matrix_unchecked(*r).euler_angles();
    v(roll, pitch, yaw)
}

/// Rounds to 1 µm, as data sheets and drawings do.
fn rounded(value: V3) -> V3 {
    value.map(|x| (x * 1e6).round() / 1e6)
}

//! Faults of bodies, gravity, contact, angles and compliance: they change what the links need.

use super::arm::Arm;
use super::law::{Memory, Parameter};
use super::motion::{STEP, Track};
use super::spatial::{Extra, Point, flange, inverse, joined, tilted};
use crate::examine::worlds::model::{Body, Row, V3};
use std::f64::consts::PI;

/// A law of the arm's bodies or surroundings.
#[derive(Clone, Copy, Debug)]
pub(super) enum BodyLaw {
    /// A rigid body at the flange, last joint's frame.
    Payload { body: Body },
    /// A vessel at the flange: its centre goes by `sway` \[m\] towards the ground.
    Vessel { body: Body, sway: f64 },
    /// Outside: a body at the flange in a part of each period \[s\].
    Gripped { body: Body, from: f64, to: f64 },
    /// A change of a link's body.
    Lump { link: usize, body: Body },
    /// Outside: a mass that slides along a rail of a link (frame of its joint) as gravity pulls.
    Sliding { link: usize, mass: f64, from: V3, rail: V3 },
    /// Base that leans: angle and direction \[rad\]; `soft` is its change with axis 1, share.
    Tilt { angle: f64, direction: f64, soft: f64 },
    /// A force \[N\] on the flange in the base frame within a window \[s\] of each period.
    Contact { force: f64, azimuth: f64, elevation: f64, window: [f64; 2], lopsided: bool },
    /// True less logged angle \[rad\]: `offset + wave cos(order q − phase)`.
    Offset { joint: usize, offset: f64, wave: f64, order: f64, phase: f64 },
    /// Compliance of a joint's gear.
    Soft { joint: usize, law: SoftLaw },
}

/// A gear that gives: `M δ̈ + damping + restoring(δ) = load`, the link at `q − δ`.
#[derive(Clone, Copy, Debug)]
pub(super) struct SoftLaw {
    /// Stiffness \[Nm/rad\], of small deflections or at a side of the gap.
    pub(super) stiffness: f64,
    /// Gap \[rad\]; 0 for none.
    pub(super) gap: f64,
    /// Inertia of the link about the joint \[kg m²\].
    pub(super) inertia: f64,
    pub(super) damping: f64,
    pub(super) form: SoftForm,
}

/// Forms of compliance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SoftForm {
    /// Linear spring with viscous damping.
    Linear,
    /// Stiffer with the deflection, twice at `reference` \[rad\]: harmonic drives (T. Tuttle, 1992).
    Hardening { reference: f64 },
    /// Gap with damping that grows with the depth of contact (K. Hunt, F. Crossley, 1975).
    Impact,
    /// Gap filled with grease, damping also within it (M. Nordin, 1997).
    Cushion,
}

impl SoftLaw {
    /// Restoring torque \[Nm\] and damping coefficient \[Nm s/rad\] at a deflection.
    fn restoring(&self, delta: f64) -> (f64, f64) {
        let viscous = 2.0 * self.damping * (self.stiffness * self.inertia).sqrt();
        let half = 0.5 * self.gap;
        let depth = delta - delta.clamp(-half, half);
        match self.form {
            SoftForm::Linear => (self.stiffness * delta, viscous),
            SoftForm::Hardening { reference } => {
                let r = delta / reference;
                (self.stiffness * delta * (1.0 + r * r), viscous)
            }
            SoftForm::Impact => {
                let share = (depth.abs() / (0.1 * self.gap)).min(1.0);
                (self.stiffness * depth, viscous * (0.05 + share))
            }
            SoftForm::Cushion => {
                (self.stiffness * depth, viscous * if depth == 0.0 { 0.6 } else { 1.0 })
            }
        }
    }

    /// Deflections \[rad\] over a period of loads \[Nm\], settled.
    fn deflections(&self, loads: &[f64]) -> Vec<f64> {
        // Steps of at most a twelfth of the natural period keep the integration stable.
        let stiffest = if let SoftForm::Hardening { .. } = self.form { 4.0 } else { 1.0 };
        let omega = (stiffest * self.stiffness / self.inertia).sqrt();
        let parts = (2.0 * omega * STEP).ceil().clamp(1.0, 40.0);
        let h = STEP / parts;
        let mean = loads.iter().sum::<f64>() / loads.len().max(1) as f64;
        let mut delta = mean / self.stiffness + 0.5 * self.gap * mean.signum();
        let mut rate = 0.0;
        let mut out = vec![0.0; loads.len()];
        for _ in 0..2 {
            for (out, load) in out.iter_mut().zip(loads) {
                for _ in 0..parts as usize {
                    let (torque, viscous) = self.restoring(delta);
                    // Implicit in the damping.
                    rate = (rate + h * (load - torque) / self.inertia)
                        / (1.0 + h * viscous / self.inertia);
                    delta += h * rate;
                }
                *out = delta;
            }
        }
        out
    }
}

/// The shape of a push over its window, x from 0 to 1; its largest value is 1.
fn push_shape(x: f64, lopsided: bool) -> f64 {
    if !(0.0..=1.0).contains(&x) {
        return 0.0;
    }
    if lopsided {
        // Quick contact, slow release: x^½-like rise, both ends zero; the most at x = 1/4.
        let y = x.powf(0.5);
        (PI * y).sin()
    } else {
        (PI * x).sin().powi(2)
    }
}

/// All body laws of a case, applied to a track.
pub(super) struct Bodies<'a> {
    arm: &'a Arm,
    laws: &'a [BodyLaw],
    links: Vec<Body>,
}

impl<'a> Bodies<'a> {
    pub(super) fn new(arm: &'a Arm, laws: &'a [BodyLaw]) -> Self {
        let mut links = arm.bodies.clone();
        let last = links.len().saturating_sub(1);
        for law in laws {
            let (link, body) = match law {
                BodyLaw::Payload { body } => (last, body),
                BodyLaw::Lump { link, body } => (*link, body),
                _ => continue,
            };
            if let Some(own) = links.get_mut(link) {
                *own = joined(own, body);
            }
        }
        Self { arm, laws, links }
    }

    /// The link-side motion of a track: offsets of encoders, then compliance.
    pub(super) fn motion(&self, track: &Track) -> Vec<Point> {
        let mut points = track.points.clone();
        for law in self.laws {
            if let BodyLaw::Offset { joint, offset, wave, order, phase } = law {
                for point in &mut points {
                    let x = order * point.q[*joint] - phase;
                    let (v, a) = (point.v[*joint], point.a[*joint]);
                    point.q[*joint] += offset + wave * x.cos();
                    point.v[*joint] -= wave * order * x.sin() * v;
                    point.a[*joint] -= wave * order * (x.sin() * a + order * x.cos() * v * v);
                }
            }
        }
        let soft: Vec<(usize, SoftLaw)> = self
            .laws
            .iter()
            .filter_map(|law| {
                if let BodyLaw::Soft { joint, law } = law { Some((*joint, *law)) } else { None }
            })
            .collect();
        if !soft.is_empty() {
            let rigid = self.torques(&points);
            for (joint, law) in soft {
                let loads: Vec<f64> = rigid.iter().map(|row| row[joint]).collect();
                bend(&mut points, joint, &law.deflections(&loads));
            }
        }
        points
    }

    /// Torques \[Nm\] of the links for a link-side motion, at the joints.
    pub(super) fn torques(&self, points: &[Point]) -> Vec<Row> {
        let mut memory = [0.0; 4];
        let twice = self.laws.iter().any(|law| matches!(law, BodyLaw::Sliding { .. }));
        if twice {
            for point in points {
                let _ = self.torque(point, 0.0, &mut memory);
            }
        }
        points
            .iter()
            .enumerate()
            .map(|(k, at)| self.torque(at, k as f64 * STEP, &mut memory))
            .collect()
    }

    /// Torques \[Nm\] at one state, `phase` \[s\] into the period.
    fn torque(&self, at: &Point, phase: f64, memory: &mut Memory) -> Row {
        let mut gravity = tilted(0.0, 0.0);
        let mut extra = Extra::default();
        let last = self.arm.axes().saturating_sub(1);
        for law in self.laws {
            match law {
                BodyLaw::Vessel { body, sway } => {
                    let (_, axes) = flange(&self.arm.joints, &at.q);
                    let down = axes.transpose() * -V3::z();
                    extra.body = Some((last, Body { com: body.com + down * *sway, ..*body }));
                }
                BodyLaw::Gripped { body, from, to } if (*from..*to).contains(&phase) => {
                    extra.body = Some((last, *body));
                }
                BodyLaw::Sliding { link, mass, from, rail } => {
                    let before = self.arm.joints.get(..=*link).unwrap_or_default();
                    let (_, axes) = flange(before, &at.q);
                    // It runs to the lower end with 0.6 m/s at most, sticks below 17 degrees.
                    let pull = -(axes.transpose() * V3::z()).dot(&rail.normalize());
                    let rate = if pull.abs() > 0.3 { 0.6 * pull / rail.norm() } else { 0.0 };
                    memory[0] = (memory[0] + STEP * rate).clamp(-1.0, 1.0);
                    let com = from + rail * memory[0];
                    extra.body = Some((
                        *link,
                        Body { mass: *mass, com, inertia: nalgebra::Matrix3::zeros() },
                    ));
                }
                BodyLaw::Tilt { angle, direction, soft } => {
                    gravity =
                        tilted(angle * (1.0 + soft * (at.q[0] - direction).cos()), *direction);
                }
                BodyLaw::Contact { force, azimuth, elevation, window: [from, to], lopsided } => {
                    let size = force * push_shape((phase - from) / (to - from), *lopsided);
                    let (flat, up) = (elevation.cos(), elevation.sin());
                    let towards = V3::new(flat * azimuth.cos(), flat * azimuth.sin(), up);
                    extra.push = Some(towards * size);
                }
                _ => {}
            }
        }
        inverse(&self.arm.joints, &self.links, at, &gravity, &extra)
    }
}

/// Takes cyclic deflections \[rad\] off a joint's motion.
fn bend(points: &mut [Point], joint: usize, delta: &[f64]) {
    let count = delta.len();
    let at = |k: usize| delta.get(k % count.max(1)).copied().unwrap_or(0.0);
    for (k, point) in points.iter_mut().enumerate() {
        let (before, now, after) = (at(k + count - 1), at(k), at(k + 1));
        point.q[joint] -= now;
        point.v[joint] -= (after - before) / (2.0 * STEP);
        point.a[joint] -= (after - 2.0 * now + before) / (STEP * STEP);
    }
}

/// Grows a body by a factor; its centre stays.
fn grown(body: &Body, factor: f64) -> Body {
    Body { mass: body.mass * factor, com: body.com, inertia: body.inertia * factor }
}

impl BodyLaw {
    /// The law with a fault `factor` times as large.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        let mut law = *self;
        match &mut law {
            Self::Payload { body }
            | Self::Vessel { body, .. }
            | Self::Gripped { body, .. }
            | Self::Lump { body, .. } => {
                *body = grown(body, factor);
            }
            Self::Sliding { mass, .. } => *mass *= factor,
            Self::Tilt { angle, .. } => *angle *= factor,
            Self::Contact { force, .. } => *force *= factor,
            Self::Offset { offset, wave, .. } => {
                *offset *= factor;
                *wave *= factor;
            }
            Self::Soft { law, .. } => {
                if law.gap > 0.0 {
                    law.gap *= factor;
                } else {
                    law.stiffness /= factor;
                    if let SoftForm::Hardening { reference } = &mut law.form {
                        *reference *= factor;
                    }
                }
            }
        }
        law
    }

    /// Its joint, if it has one, and its parameters by the library's names.
    pub(super) fn parameters(&self) -> (Option<usize>, Vec<Parameter>) {
        let of = |body: &Body, centre: bool| {
            vec![
                ("mass", body.mass, true),
                ("com_x", body.com.x, centre),
                ("com_y", body.com.y, centre),
                ("com_z", body.com.z, centre),
            ]
        };
        match self {
            Self::Payload { body } => (None, of(body, true)),
            Self::Vessel { body, .. } => (None, of(body, false)),
            Self::Gripped { body, .. } => (None, vec![("mass", body.mass, false)]),
            Self::Lump { link, body } => {
                let moment = body.com * body.mass;
                let list = vec![
                    ("mass", body.mass, true),
                    ("moment_x", moment.x, true),
                    ("moment_y", moment.y, true),
                    ("moment_z", moment.z, true),
                ];
                (Some(*link), list)
            }
            Self::Sliding { mass, .. } => (None, vec![("mass", *mass, false)]),
            Self::Tilt { angle, direction, .. } => {
                (None, vec![("angle", *angle, true), ("direction", *direction, true)])
            }
            Self::Contact { force, azimuth, elevation, window, .. } => {
                let list = vec![
                    ("force", *force, true),
                    ("azimuth", *azimuth, true),
                    ("elevation", *elevation, true),
                    ("t_start_s", window[0], true),
                    ("t_end_s", window[1], true),
                ];
                (None, list)
            }
            Self::Offset { joint, offset, .. } => (Some(*joint), vec![("offset", *offset, true)]),
            Self::Soft { joint, law } => {
                if law.gap > 0.0 {
                    (
                        Some(*joint),
                        vec![("gap", law.gap, true), ("stiffness", law.stiffness, false)],
                    )
                } else {
                    (Some(*joint), vec![("stiffness", law.stiffness, law.form == SoftForm::Linear)])
                }
            }
        }
    }
}

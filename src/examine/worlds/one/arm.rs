//! An arm: geometry, bodies, friction, motors and limits.

use crate::examine::worlds::model::{Body, Joint, M3, Row, Sheet, Spread, V3};
use crate::examine::worlds::random::Rng;

/// Gravity \[m/s²\].
pub(super) const GRAVITY: f64 = 9.81;
/// Smallest factor of a quantity that is off: a body does not vanish.
const LEAST_FACTOR: f64 = 0.2;
/// Significant digits of all numbers of a model, as in a person's file.
const DIGITS: i32 = 7;

/// An arm; friction, rotors \[kg m²\] and losses \[W/(Nm)²\] at the joints.
#[derive(Clone, Debug)]
pub(super) struct Arm {
    pub(super) joints: Vec<Joint>,
    pub(super) bodies: Vec<Body>,
    /// Flange in the frame of the last joint \[m\].
    pub(super) flange: V3,
    /// Rated payload \[kg\].
    pub(super) payload: f64,
    pub(super) coulomb: Row,
    pub(super) viscous: Row,
    pub(super) ratio: Row,
    pub(super) rotor: Row,
    /// Limits of angles \[rad\], rates \[rad/s\] and torques \[Nm\].
    pub(super) lower: Row,
    pub(super) upper: Row,
    pub(super) velocity: Row,
    pub(super) effort: Row,
    /// What the planner uses at most \[rad/s²\].
    pub(super) acceleration: Row,
    pub(super) loss: Row,
    /// Power of the cabinet \[W\].
    pub(super) base_w: f64,
    /// Share of the braking power that is given back.
    pub(super) regeneration: f64,
}

impl Arm {
    pub(super) fn count(&self) -> usize {
        self.joints.len()
    }

    pub(super) fn sheet(&self, name: String) -> Sheet<'_> {
        Sheet {
            name,
            joints: &self.joints,
            bodies: &self.bodies,
            lower: &self.lower,
            upper: &self.upper,
            velocity: &self.velocity,
            torque: &self.effort,
            coulomb: &self.coulomb,
            viscous: &self.viscous,
            ratio: &self.ratio,
            rotor: &self.rotor,
            loss: &self.loss,
            base_w: self.base_w,
            regeneration: self.regeneration,
        }
    }
}

/// A number with few digits.
pub(super) fn neat(x: f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return 0.0;
    }
    let digits = DIGITS - 1 - (x.abs().log10().floor() as i32);
    let scale = 10_f64.powi(digits.clamp(-DIGITS, 15));
    (x * scale).round() / scale
}

/// Inertia \[kg m²\] of a box with the sides \[m\] and the mass \[kg\].
pub(super) fn box_inertia(mass: f64, sides: V3) -> M3 {
    let s = sides.component_mul(&sides);
    M3::from_diagonal(&V3::new(s.y + s.z, s.x + s.z, s.x + s.y)) * (mass / 12.0)
}

pub(super) fn factor(rng: &mut Rng, deviation: f64) -> f64 {
    (1.0 + rng.spread(deviation)).max(LEAST_FACTOR)
}

/// A body that is off. The second moments are stretched, so that the inertia stays that of a body.
fn off(body: &Body, spread: Spread, rng: &mut Rng) -> Body {
    let mass = factor(rng, spread.mass);
    let com = body.com + V3::from_fn(|_, _| rng.spread(spread.com));
    let second = M3::identity() * (0.5 * body.inertia.trace()) - body.inertia;
    // Half of the inertia's spread is common to the axes, the other half is not.
    let common = rng.spread(spread.inertia);
    let stretch = V3::from_fn(|_, _| {
        let own = rng.spread(spread.inertia);
        (1.0 + 0.5_f64.sqrt() * (common + own)).max(LEAST_FACTOR).sqrt()
    });
    let stretch = M3::from_diagonal(&stretch);
    let second = stretch * second * stretch;
    let inertia = M3::identity() * second.trace() - second;
    Body { mass: body.mass * mass, com, inertia }
}

/// The real robot: the nominal one with its parameters off.
pub(super) fn real(nominal: &Arm, spread: Spread, rng: &mut Rng) -> Arm {
    let mut arm = nominal.clone();
    arm.bodies = nominal.bodies.iter().map(|body| off(body, spread, rng)).collect();
    for j in 0..arm.count() {
        arm.rotor[j] *= factor(rng, spread.inertia);
        arm.coulomb[j] *= factor(rng, spread.friction);
        arm.viscous[j] *= factor(rng, spread.friction);
    }
    arm
}

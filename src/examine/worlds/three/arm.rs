//! An arm: geometry, bodies, limits, friction, motors.

use super::spatial::{Extra, GRAVITY, Point, inertia_of, inverse, second_moments};
use crate::examine::worlds::model::{Body, Joint, M3, MAX, Row, Sheet, Spread, V3};
use crate::examine::worlds::random::Rng;

/// An arm, nominal or real. All motor values are at the joint, that is behind the gear.
#[derive(Clone, Debug)]
pub(super) struct Arm {
    pub(super) name: String,
    /// Payload \[kg\] for which it is built.
    pub(super) payload: f64,
    pub(super) joints: Vec<Joint>,
    pub(super) bodies: Vec<Body>,
    /// Limits of angles \[rad\], rates \[rad/s\], of the planner's accelerations \[rad/s²\] and of
    /// torques \[Nm\].
    pub(super) lower: Row,
    pub(super) upper: Row,
    pub(super) speed: Row,
    pub(super) acceleration: Row,
    pub(super) torque: Row,
    /// Coulomb \[Nm\] and viscous friction \[Nm s/rad\].
    pub(super) coulomb: Row,
    pub(super) viscous: Row,
    pub(super) ratio: Row,
    /// Reflected rotor inertias \[kg m²\].
    pub(super) rotor: Row,
    /// Copper loss \[W/(Nm)²\].
    pub(super) loss: Row,
    /// Power of the cabinet at rest \[W\].
    pub(super) base: f64,
    /// Share of the braking power that is given back.
    pub(super) regeneration: f64,
    /// Middle and half width of the poses in which it works \[rad\].
    pub(super) middle: Row,
    pub(super) span: Row,
    /// Rms torques \[Nm\] of usual motions.
    pub(super) usual: Row,
}

/// Rate \[rad/s\] below which the plain friction model is at rest: rounding errors of a profile's end.
const REST: f64 = 1e-7;
/// Smallest factor on a second moment: a body stays a body.
const LEAST_FACTOR: f64 = 0.2;

impl Arm {
    pub(super) fn axes(&self) -> usize {
        self.joints.len()
    }

    pub(super) fn sheet(&self) -> Sheet<'_> {
        Sheet {
            name: self.name.clone(),
            joints: &self.joints,
            bodies: &self.bodies,
            lower: &self.lower,
            upper: &self.upper,
            velocity: &self.speed,
            torque: &self.torque,
            coulomb: &self.coulomb,
            viscous: &self.viscous,
            ratio: &self.ratio,
            rotor: &self.rotor,
            loss: &self.loss,
            base_w: self.base,
            regeneration: self.regeneration,
        }
    }

    /// Torques \[Nm\] of the rigid links.
    pub(super) fn rigid(&self, at: &Point) -> Row {
        inverse(&self.joints, &self.bodies, at, &V3::new(0.0, 0.0, -GRAVITY), &Extra::default())
    }

    /// Torques \[Nm\] of the plain model: links, Coulomb and viscous friction, and rotors if asked.
    pub(super) fn model(&self, at: &Point, rotors: bool) -> Row {
        let mut torques = self.rigid(at);
        for (i, torque) in torques.iter_mut().enumerate().take(self.axes()) {
            let sign = if at.v[i].abs() > REST { at.v[i].signum() } else { 0.0 };
            *torque += self.coulomb[i] * sign + self.viscous[i] * at.v[i];
            if rotors {
                *torque += self.rotor[i] * at.a[i];
            }
        }
        torques
    }

    /// Inertia \[kg m²\] of the links about each joint at the middle pose.
    pub(super) fn own_inertia(&self) -> Row {
        let mut out = [0.0; MAX];
        let rest = Point { q: self.middle, ..Point::default() };
        for (i, value) in out.iter_mut().enumerate().take(self.axes()) {
            let mut moved = rest;
            moved.a[i] = 1.0;
            *value =
                inverse(&self.joints, &self.bodies, &moved, &V3::zeros(), &Extra::default())[i];
        }
        out
    }

    /// A real arm of this nominal one.
    pub(super) fn real(&self, spread: &Spread, rng: &mut Rng) -> Self {
        let mut real = self.clone();
        for body in &mut real.bodies {
            *body = varied(body, spread, rng);
        }
        for i in 0..real.axes() {
            real.rotor[i] *= 1.0 + rng.spread(spread.inertia);
            real.coulomb[i] *= 1.0 + rng.spread(spread.friction);
            real.viscous[i] *= 1.0 + rng.spread(spread.friction);
        }
        real
    }
}

/// A body whose mass, centre and inertia are off; it can still exist.
fn varied(body: &Body, spread: &Spread, rng: &mut Rng) -> Body {
    let eigen = second_moments(body).symmetric_eigen();
    let factors = V3::from_fn(|_, _| (1.0 + rng.spread(spread.inertia)).max(LEAST_FACTOR));
    let values = eigen.eigenvalues.component_mul(&factors);
    let second = eigen.eigenvectors * M3::from_diagonal(&values) * eigen.eigenvectors.transpose();
    Body {
        mass: body.mass * (1.0 + rng.spread(spread.mass)),
        com: body.com + V3::from_fn(|_, _| rng.spread(spread.com)),
        inertia: inertia_of(&second),
    }
}

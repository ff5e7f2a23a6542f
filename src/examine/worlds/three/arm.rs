//! An arm: geometry, bodies, limits, friction, motors.

use crate::rng::Rng;
use crate::spatial::{Axes, Body, Extra, GRAVITY, Joint, M3, MAX, Point, V3, inverse};

/// An arm, nominal or real. All motor values are at the joint, that is behind the gear.
#[derive(Clone, Debug)]
pub struct Arm {
    /// Name in the model file.
    pub name: String,
    /// Payload \[kg\] for which it is built.
    pub payload: f64,
    /// Joints.
    pub joints: Vec<Joint>,
    /// Bodies of the links.
    pub bodies: Vec<Body>,
    /// Lower limits \[rad\].
    pub lower: Axes,
    /// Upper limits \[rad\].
    pub upper: Axes,
    /// Largest rates \[rad/s\].
    pub speed: Axes,
    /// Largest accelerations \[rad/s²\] of its path planner.
    pub acceleration: Axes,
    /// Torque limits \[Nm\].
    pub torque: Axes,
    /// Coulomb friction \[Nm\].
    pub coulomb: Axes,
    /// Viscous friction \[Nm s/rad\].
    pub viscous: Axes,
    /// Gear ratios.
    pub ratio: Axes,
    /// Reflected rotor inertias \[kg m²\].
    pub rotor: Axes,
    /// Copper loss \[W/(Nm)²\].
    pub loss: Axes,
    /// Power of the cabinet at rest \[W\].
    pub base: f64,
    /// Share of the braking power that is given back.
    pub regeneration: f64,
    /// Middle of the poses in which it works \[rad\].
    pub middle: Axes,
    /// Half width of these poses \[rad\].
    pub span: Axes,
    /// Rms torques \[Nm\] of usual motions.
    pub usual: Axes,
}

/// How far parameters of a real arm are from the nominal ones: standard deviations.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    /// Mass, share.
    pub mass: f64,
    /// Centre of mass \[m\].
    pub com: f64,
    /// Inertias and rotors, share.
    pub inertia: f64,
    /// Friction, share.
    pub friction: f64,
}

/// Identified on this robot.
pub const COMMISSIONED: Spread = Spread { mass: 0.01, com: 0.003, inertia: 0.03, friction: 0.05 };
/// From drawings.
pub const CAD: Spread = Spread { mass: 0.10, com: 0.015, inertia: 0.20, friction: 0.25 };

/// Rate \[rad/s\] below which the plain friction model is at rest: rounding errors of a profile's end.
const REST: f64 = 1e-7;
/// Smallest factor on a second moment: a body stays a body.
const LEAST_FACTOR: f64 = 0.2;

impl Arm {
    /// Joints.
    #[must_use]
    pub fn axes(&self) -> usize {
        self.joints.len()
    }

    /// Torques \[Nm\] of the rigid links.
    #[must_use]
    pub fn rigid(&self, at: &Point) -> Axes {
        inverse(&self.joints, &self.bodies, at, &V3::new(0.0, 0.0, -GRAVITY), &Extra::default())
    }

    /// Torques \[Nm\] of the plain model: links, Coulomb and viscous friction, and rotors if asked.
    #[must_use]
    pub fn model(&self, at: &Point, rotors: bool) -> Axes {
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
    #[must_use]
    pub fn own_inertia(&self) -> Axes {
        let mut out = [0.0; MAX];
        let rest = Point { q: self.middle, ..Point::default() };
        for (i, value) in out.iter_mut().enumerate().take(self.axes()) {
            let mut moved = rest;
            moved.a[i] = 1.0;
            *value = inverse(&self.joints, &self.bodies, &moved, &V3::zeros(), &Extra::default())[i];
        }
        out
    }

    /// A real arm of this nominal one.
    #[must_use]
    pub fn real(&self, spread: &Spread, rng: &mut Rng) -> Self {
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
    let eigen = body.second_moments().symmetric_eigen();
    let factors = V3::from_fn(|_, _| (1.0 + rng.spread(spread.inertia)).max(LEAST_FACTOR));
    let values = eigen.eigenvalues.component_mul(&factors);
    let second = eigen.eigenvectors * M3::from_diagonal(&values) * eigen.eigenvectors.transpose();
    Body {
        mass: body.mass * (1.0 + rng.spread(spread.mass)),
        com: body.com + V3::from_fn(|_, _| rng.spread(spread.com)),
        inertia: Body::inertia_of(&second),
    }
}

//! An arm: geometry, bodies, friction, motors and limits.

use crate::rng::Rng;
use nalgebra::{Matrix3, Vector3};

/// Most joints of an arm.
pub const MAX: usize = 7;
/// Gravity \[m/s²\].
pub const GRAVITY: f64 = 9.81;
/// A number for each joint.
pub type Row = [f64; MAX];
/// A vector.
pub type V3 = Vector3<f64>;
/// A matrix.
pub type M3 = Matrix3<f64>;

/// Smallest factor of a quantity that is off: a body does not vanish.
const LEAST_FACTOR: f64 = 0.2;
/// Significant digits of all numbers of a model, as in a person's file.
const DIGITS: i32 = 7;

/// A joint's frame in the frame of the joint before.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its origin \[m\].
    pub origin: V3,
    /// Roll, pitch and yaw \[rad\], as in a URDF.
    pub rpy: [f64; 3],
    /// The same as a matrix.
    pub rotation: M3,
    /// Axis in its own frame.
    pub axis: V3,
}

/// A rigid body in the frame of its joint.
#[derive(Clone, Debug)]
pub struct Body {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\].
    pub com: V3,
    /// Inertia about the centre of mass \[kg m²\].
    pub inertia: M3,
}

/// An arm.
#[derive(Clone, Debug)]
pub struct Arm {
    /// Joints from the base.
    pub joints: Vec<Joint>,
    /// Bodies, one for each joint.
    pub bodies: Vec<Body>,
    /// Flange in the frame of the last joint \[m\].
    pub flange: V3,
    /// Rated payload \[kg\].
    pub payload: f64,
    /// Coulomb friction \[Nm\].
    pub coulomb: Row,
    /// Viscous friction \[Nm s/rad\].
    pub viscous: Row,
    /// Gear ratio.
    pub ratio: Row,
    /// Inertia of the rotor at the joint \[kg m²\].
    pub rotor: Row,
    /// Lower limit of the angle \[rad\].
    pub lower: Row,
    /// Upper limit of the angle \[rad\].
    pub upper: Row,
    /// Limit of the speed \[rad/s\].
    pub velocity: Row,
    /// What the planner uses at most \[rad/s²\].
    pub acceleration: Row,
    /// Limit of the torque \[Nm\].
    pub effort: Row,
    /// Copper loss at the joint \[W/(Nm)²\].
    pub loss: Row,
    /// Power of the cabinet \[W\].
    pub base_w: f64,
    /// Share of the braking power that is given back.
    pub regeneration: f64,
}

impl Arm {
    /// Number of joints.
    pub fn count(&self) -> usize {
        self.joints.len()
    }
}

/// Spread of a robot's parameters about the nominal ones, one standard deviation each.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    /// Name of the trust in the options.
    pub trust: &'static str,
    /// Of a mass, relative.
    pub mass: f64,
    /// Of a centre of mass \[m\], each axis.
    pub com: f64,
    /// Of an inertia and a rotor, relative.
    pub inertia: f64,
    /// Of friction, relative.
    pub friction: f64,
}

/// Parameters identified on the robot.
pub const COMMISSIONED: Spread =
    Spread { trust: "commissioned", mass: 0.01, com: 0.003, inertia: 0.03, friction: 0.05 };
/// Parameters from drawings.
pub const CAD: Spread =
    Spread { trust: "cad", mass: 0.1, com: 0.015, inertia: 0.2, friction: 0.25 };

/// A number with few digits.
pub fn neat(x: f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return 0.0;
    }
    let digits = DIGITS - 1 - (x.abs().log10().floor() as i32);
    let scale = 10_f64.powi(digits.clamp(-DIGITS, 15));
    (x * scale).round() / scale
}

/// Rotation of roll, pitch and yaw.
pub fn rotation(rpy: [f64; 3]) -> M3 {
    *nalgebra::Rotation3::from_euler_angles(rpy[0], rpy[1], rpy[2]).matrix()
}

/// Inertia \[kg m²\] of a box with the sides \[m\] and the mass \[kg\]; it satisfies the triangle
/// inequality.
pub fn box_inertia(mass: f64, sides: V3) -> M3 {
    let s = sides.component_mul(&sides);
    let twelfth = mass / 12.0;
    M3::from_diagonal(&V3::new(s.y + s.z, s.x + s.z, s.x + s.y)) * twelfth
}

/// A factor about 1.
pub fn factor(rng: &mut Rng, deviation: f64) -> f64 {
    (1.0 + deviation * rng.normal()).max(LEAST_FACTOR)
}

/// A body that is off. The second moments are stretched, so that the inertia stays that of a body.
fn off(body: &Body, spread: Spread, rng: &mut Rng) -> Body {
    let mass = factor(rng, spread.mass);
    let com = body.com + V3::from_fn(|_, _| spread.com * rng.normal());
    let second = M3::identity() * (0.5 * body.inertia.trace()) - body.inertia;
    let common = spread.inertia * rng.normal();
    let stretch = V3::from_fn(|_, _| {
        // Half of the inertia's spread is common to the axes, the other half is not.
        (1.0 + 0.5_f64.sqrt() * (common + spread.inertia * rng.normal())).max(LEAST_FACTOR).sqrt()
    });
    let stretch = M3::from_diagonal(&stretch);
    let second = stretch * second * stretch;
    let inertia = M3::identity() * second.trace() - second;
    Body { mass: body.mass * mass, com, inertia }
}

/// The real robot: the nominal one with its parameters off.
pub fn real(nominal: &Arm, spread: Spread, rng: &mut Rng) -> Arm {
    let mut arm = nominal.clone();
    arm.bodies = nominal.bodies.iter().map(|body| off(body, spread, rng)).collect();
    for j in 0..arm.count() {
        arm.rotor[j] *= factor(rng, spread.inertia);
        arm.coulomb[j] *= factor(rng, spread.friction);
        arm.viscous[j] *= factor(rng, spread.friction);
    }
    arm
}

//! Robots, loads and states for tests of kinematics and dynamics.

#![allow(
    dead_code,
    clippy::allow_attributes,
    reason = "each test uses its part of this module; an expectation would fail in the others"
)]

use joulepath::arm::dynamics::Load;
use joulepath::arm::robot::{MAX_DOF, Model, find, from_toml};
use nalgebra::{Isometry3, Matrix3, Vector3};
use proptest::prelude::*;

/// Three joints in general position, a tool frame in general position, rotors.
const SKEW: &str = include_str!("../../fixtures/dynamics/skew.toml");
/// Seven joints in general position.
const SEVEN: &str = include_str!("../../fixtures/dynamics/seven.toml");
/// A pendulum.
const ONE: &str = "name = \"one\"\n[limits]\nposition = [[-3.0, 3.0]]\n\
    [[joint]]\norigin = [0.0, 0.0, 1.0]\naxis = [0.0, 1.0, 0.2]\n\
    [[link]]\nmass = 2.0\ncom = [0.3, 0.1, -0.4]\ninertia = [0.1, 0.2, 0.15, 0.01, 0.0, 0.0]\n";
/// A robot of the catalogue with forearm rods.
const RODS: &str = "extends = \"IRB1600-10/1.45\"\nname = \"rods\"\n\
    [kinematics]\ncoupling = \"parallelogram\"\n";
/// A robot of the catalogue with a coupled wrist and all friction laws.
const WRIST: &str = "extends = \"IRB1600-10/1.45\"\nname = \"wrist\"\n\
    [wrist]\ncoupling = 0.8\n\
    [friction]\ncoulomb_asymmetry = [1.0, -2.0, 0.5, 0.3, 0.2, 0.1]\n\
    stribeck = { stiction = [9.0, 6.0, 3.0, 2.0, 2.0, 1.0], \
    velocity = [0.1, 0.1, 0.1, 0.2, 0.2, 0.2] }\n\
    viscous_asymmetry = { asymmetry = [3.0, 2.0, -1.0, 0.2, 0.1, 0.1] }\n\
    load_friction = { mu = [0.05, 0.06, 0.07, 0.08, 0.09, 0.1] }\n";

/// A robot of the catalogue on a slope: gravity has a component perpendicular to the first axis.
const TILTED: &str = "extends = \"IRB1600-10/1.45\"\nname = \"tilted\"\n\
    [kinematics]\nbase = { origin = [0.1, 0.2, 0.3], rpy = [0.4, -0.7, 0.2] }\n";

/// Number of robots.
pub(crate) const ROBOTS: usize = 7;

/// All of them.
pub(crate) fn robots() -> [Model; ROBOTS] {
    let robot = |name: &str, text: &str| from_toml(name, text).expect("a robot of the tests");
    [
        find("IRB1600-10/1.45").expect("in the catalogue"),
        robot("skew.toml", SKEW),
        robot("rods.toml", RODS),
        robot("wrist.toml", WRIST),
        robot("seven.toml", SEVEN),
        robot("one.toml", ONE),
        robot("tilted.toml", TILTED),
    ]
}

/// A load in general position.
pub(crate) fn load() -> Load {
    Load {
        mass: 8.0,
        com: Vector3::new(0.05, -0.02, 0.15),
        inertia: Matrix3::new(0.1, 0.01, 0.02, 0.01, 0.12, -0.01, 0.02, -0.01, 0.09),
    }
}

/// Positions, velocities and accelerations.
pub(crate) fn states() -> impl Strategy<Value = [[f64; MAX_DOF]; 3]> {
    let values = |size: f64| prop::array::uniform7(-size..size);
    (values(3.0), values(4.0), values(20.0)).prop_map(|(q, qd, qdd)| [q, qd, qdd])
}

/// The larger distance of two poses: of the positions \[m\], or of the orientations \[rad\].
pub(crate) fn pose_distance(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    (a.translation.vector - b.translation.vector).norm().max(a.rotation.angle_to(&b.rotation))
}

/// Whether joint angles agree except for whole turns.
pub(crate) fn same_angles(a: &[f64; 6], b: &[f64; 6], tolerance: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| {
        let d = (a - b).rem_euclid(std::f64::consts::TAU);
        d.min(std::f64::consts::TAU - d) < tolerance
    })
}

/// The largest absolute value, at least 1.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(1.0, |m: f64, x| m.max(x.abs()))
}

//! A robot model: arm, friction, motors and limits; nominal and true.

use nalgebra::{Matrix3, Vector3};

use crate::arm::{Build, Size, arm, block, size};
use crate::rigid::{Arm, Joints, MAX};
use crate::rng::Rng;

/// A model in the sense of the nominal robot file, with what motions need.
#[derive(Clone, Debug)]
pub struct Robot {
    /// Bodies and rotors.
    pub arm: Arm,
    /// Architecture.
    pub build: Build,
    /// Main dimensions.
    pub size: Size,
    /// Coulomb friction \[Nm\].
    pub coulomb: Joints,
    /// Viscous friction \[Nm s/rad\].
    pub viscous: Joints,
    /// Gear ratio.
    pub ratio: Joints,
    /// Copper loss \[W/(Nm)²\] at the joint.
    pub loss: Joints,
    /// Power of controller and fans \[W\].
    pub base_w: f64,
    /// Share of braking power given back.
    pub regeneration: f64,
    /// Lower limits \[rad\].
    pub low: Joints,
    /// Upper limits \[rad\].
    pub high: Joints,
    /// Largest speed \[rad/s\].
    pub speed: Joints,
    /// Largest acceleration of motions \[rad/s²\]; not in the robot file.
    pub acceleration: Joints,
    /// Largest torque \[Nm\].
    pub torque: Joints,
}

/// How much of a nominal model is believed: standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Name in the options.
    pub name: &'static str,
    /// Of the mass, relative.
    pub mass: f64,
    /// Of the centre of mass \[m\].
    pub com: f64,
    /// Of inertias and rotors, relative.
    pub inertia: f64,
    /// Of friction, relative.
    pub friction: f64,
}

/// Identified on this robot.
pub const COMMISSIONED: Spread =
    Spread { name: "commissioned", mass: 0.01, com: 0.003, inertia: 0.03, friction: 0.05 };
/// From drawings.
pub const CAD: Spread = Spread { name: "cad", mass: 0.1, com: 0.015, inertia: 0.2, friction: 0.25 };

/// States by which torque levels are judged.
const SAMPLES: usize = 160;
/// Reserve of the torque limit over the largest sampled torque.
const RESERVE: f64 = 1.5;
/// Where the rated payload is beside the flange, share of the reach along each axis, and its density
/// \[kg/m³\].
const ASIDE: f64 = 0.04;
const DENSITY: f64 = 1500.0;
/// Payloads \[kg\].
const PAYLOAD: (f64, f64) = (0.5, 300.0);

/// Draws a nominal robot.
pub fn draw(six_only: bool, rng: &mut Rng) -> Robot {
    let build = if !six_only && rng.chance(0.2) {
        Build::Seven
    } else {
        rng.pick(&[Build::Cobot, Build::Cobot, Build::Elbow, Build::OffsetWrist], Build::Elbow)
    };
    let size = size(rng.log_range(PAYLOAD.0, PAYLOAD.1), build, rng);
    let mut robot = Robot {
        arm: arm(build, &size, rng),
        build,
        size,
        coulomb: [0.0; MAX],
        viscous: [0.0; MAX],
        ratio: [1.0; MAX],
        loss: [0.0; MAX],
        base_w: 0.0,
        regeneration: 0.0,
        low: [0.0; MAX],
        high: [0.0; MAX],
        speed: [0.0; MAX],
        acceleration: [0.0; MAX],
        torque: [0.0; MAX],
    };
    set_limits(&mut robot, rng);
    set_motors(&mut robot, rng);
    set_friction(&mut robot, rng);
    robot
}

/// Typical ranges \[rad\] of the joints, and their speeds \[rad/s\] for a reach of 1 m.
fn ranges(build: Build) -> [(f64, f64, f64); MAX] {
    match build {
        Build::Elbow | Build::OffsetWrist => [
            (-2.9, 2.9, 2.6),
            (-1.2, 2.2, 2.3),
            (-2.6, 1.1, 2.8),
            (-3.3, 3.3, 5.0),
            (-2.1, 2.1, 5.0),
            (-6.0, 6.0, 7.0),
            (0.0, 0.0, 0.0),
        ],
        Build::Cobot => [
            (-3.1, 3.1, 2.4),
            (-2.3, 2.3, 2.2),
            (-2.6, 2.6, 2.8),
            (-3.0, 3.0, 3.6),
            (-3.0, 3.0, 3.6),
            (-6.2, 6.2, 4.0),
            (0.0, 0.0, 0.0),
        ],
        Build::Seven => [
            (-2.9, 2.9, 2.0),
            (-2.0, 2.0, 1.8),
            (-2.9, 2.9, 2.0),
            (-2.0, 2.0, 2.1),
            (-2.9, 2.9, 2.6),
            (-2.0, 2.0, 2.6),
            (-3.0, 3.0, 3.0),
        ],
    }
}

fn set_limits(robot: &mut Robot, rng: &mut Rng) {
    let slow = robot.size.reach.powf(-0.45).clamp(0.6, 1.4);
    let ramp = rng.range(0.22, 0.5) * robot.size.reach.sqrt();
    for (i, (low, high, speed)) in ranges(robot.build).into_iter().enumerate().take(robot.arm.n()) {
        robot.low[i] = (low * rng.range(0.9, 1.05) * 100.0).round() / 100.0;
        robot.high[i] = (high * rng.range(0.9, 1.05) * 100.0).round() / 100.0;
        robot.speed[i] = (speed * slow * rng.range(0.85, 1.15) * 100.0).round() / 100.0;
        let shorter = if i > 2 { 0.7 } else { 1.0 };
        robot.acceleration[i] = robot.speed[i] / (ramp * shorter);
    }
}

/// Rms link torques with inertia and weight \[Nm\], largest, and median of the diagonal of the mass
/// matrix \[kg m²\], over random states.
fn levels(robot: &Robot, rng: &mut Rng) -> (Joints, Joints, Joints) {
    let n = robot.arm.n();
    let (mut squares, mut most, mut diagonal) = ([0.0; MAX], [0.0_f64; MAX], [0.0; MAX]);
    for _ in 0..SAMPLES {
        let (mut q, mut qd, mut qdd) = ([0.0; MAX], [0.0; MAX], [0.0; MAX]);
        for i in 0..n {
            q[i] = rng.range(robot.low[i], robot.high[i]);
            qd[i] = robot.speed[i] * rng.range(-1.0, 1.0);
            qdd[i] = robot.acceleration[i] * rng.range(-1.0, 1.0);
        }
        let pose = robot.arm.pose(&q);
        let tau = robot.arm.inverse(&pose, &qd, &qdd);
        let mass = pose.mass_matrix();
        for i in 0..n {
            let all = tau[i] + robot.arm.rotor[i] * qdd[i];
            squares[i] += all * all / SAMPLES as f64;
            most[i] = most[i].max(all.abs());
            diagonal[i] += mass[(i, i)] / SAMPLES as f64;
        }
    }
    (squares.map(f64::sqrt), most, diagonal)
}

fn set_motors(robot: &mut Robot, rng: &mut Rng) {
    let n = robot.arm.n();
    let (_, _, diagonal) = levels(robot, rng);
    for i in 0..n {
        let wrist = i + 3 >= n;
        let share = if wrist { rng.range(0.7, 2.2) } else { rng.range(0.2, 0.7) };
        robot.arm.rotor[i] = share * diagonal[i];
        if wrist && i > 3 {
            // The motors of the wrist are of one family.
            let before = robot.arm.rotor[i - 1];
            robot.arm.rotor[i] = robot.arm.rotor[i].clamp(0.2 * before, before);
        }
        let harmonic = [100.0, 120.0, 160.0, 100.0, 80.0, 101.0];
        robot.ratio[i] = if robot.build.harmonic() {
            rng.pick(&harmonic, 100.0)
        } else if i < 3 {
            (rng.range(90.0, 220.0) * 10.0).round() / 10.0
        } else {
            (rng.range(45.0, 110.0) * 10.0).round() / 10.0
        };
    }
}

fn set_friction(robot: &mut Robot, rng: &mut Rng) {
    let n = robot.arm.n();
    let (rms, _, _) = levels(robot, rng);
    // Motors are made for the rated payload, a little aside of the flange.
    let mut loaded = robot.clone();
    if let Some(last) = loaded.arm.bodies.last_mut() {
        let aside = Vector3::repeat(ASIDE * robot.size.reach);
        let edges = Vector3::repeat((robot.size.payload / DENSITY).cbrt());
        *last = last.with(&block(robot.size.payload, robot.arm.flange + aside, edges));
    }
    let (_, most, _) = levels(&loaded, rng);
    let rough = if robot.build.harmonic() { rng.range(0.1, 0.28) } else { rng.range(0.05, 0.18) };
    for i in 0..n {
        let whole = rough * rng.range(0.7, 1.3) * rms[i];
        let dry = rng.range(0.35, 0.75);
        robot.coulomb[i] = whole * dry;
        robot.viscous[i] = whole * (1.0 - dry) / (0.5 * robot.speed[i]);
        robot.torque[i] = round_up(RESERVE * (most[i] + 2.0 * whole));
        // Copper loss at the rms torque: 3 to 12 % of the power at half speed.
        let power = rms[i] * 0.5 * robot.speed[i];
        robot.loss[i] = rng.range(0.03, 0.12) * power / (rms[i] * rms[i]);
    }
    robot.base_w = (rng.range(60.0, 120.0) * robot.size.payload.powf(0.2)).round();
    robot.regeneration = rng.pick(&[0.0, 0.5, 0.7, 0.8, 0.9, 0.6], 0.7);
}

/// The next larger number of two digits.
fn round_up(x: f64) -> f64 {
    let unit = 10f64.powf(x.log10().floor() - 1.0);
    (x / unit).ceil() * unit
}

/// A robot that differs from its nominal model by the spread.
pub fn perturbed(nominal: &Robot, spread: &Spread, rng: &mut Rng) -> Robot {
    let mut robot = nominal.clone();
    let n = nominal.arm.n();
    for body in &mut robot.arm.bodies {
        body.mass *= factor(spread.mass, rng);
        body.com += Vector3::new(rng.normal(), rng.normal(), rng.normal()) * spread.com;
        // Second moments Σ = ½ tr(I) 1 − I are stretched: the result is the inertia of a body.
        let second = Matrix3::identity() * (0.5 * body.inertia.trace()) - body.inertia;
        let mut stretch = Matrix3::<f64>::identity();
        for (r, c) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
            let value = 0.5 * spread.inertia * rng.normal().clamp(-2.5, 2.5);
            stretch[(r, c)] += if r == c { value } else { 0.3 * value };
        }
        let second = stretch * second * stretch.transpose();
        body.inertia = Matrix3::identity() * second.trace() - second;
    }
    for i in 0..n {
        robot.arm.rotor[i] *= factor(spread.inertia, rng);
        robot.coulomb[i] *= factor(spread.friction, rng);
        robot.viscous[i] *= factor(spread.friction, rng);
        robot.loss[i] *= factor(spread.inertia.max(0.05), rng);
    }
    robot.base_w *= factor(spread.friction.min(0.05), rng);
    robot
}

/// A positive factor about 1.
fn factor(sd: f64, rng: &mut Rng) -> f64 {
    (1.0 + sd * rng.normal().clamp(-2.5, 2.5)).max(0.2)
}

//! A robot model: arm, friction, motors and limits; nominal and true.

use super::arm::{Build, Size, arm, block, size};
use super::rigid::{Arm, joined};
use crate::examine::worlds::model::{M3, MAX, Row, Sheet, Spread, V3};
use crate::examine::worlds::random::Rng;

/// A model in the sense of the nominal robot file, with what motions need.
#[derive(Clone, Debug)]
pub(super) struct Robot {
    pub(super) arm: Arm,
    pub(super) build: Build,
    pub(super) size: Size,
    /// Coulomb friction \[Nm\].
    pub(super) coulomb: Row,
    /// Viscous friction \[Nm s/rad\].
    pub(super) viscous: Row,
    pub(super) ratio: Row,
    /// Copper loss \[W/(Nm)²\] at the joint.
    pub(super) loss: Row,
    /// Power of controller and fans \[W\].
    pub(super) base_w: f64,
    /// Share of braking power given back.
    pub(super) regeneration: f64,
    /// Lower limits \[rad\].
    pub(super) low: Row,
    /// Upper limits \[rad\].
    pub(super) high: Row,
    /// Largest speed \[rad/s\].
    pub(super) speed: Row,
    /// Largest acceleration of motions \[rad/s²\]; not in the robot file.
    pub(super) acceleration: Row,
    /// Largest torque \[Nm\].
    pub(super) torque: Row,
}

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

impl Robot {
    pub(super) fn sheet(&self) -> Sheet<'_> {
        Sheet {
            name: format!("{:?}-{:.1}kg", self.build, self.size.payload).to_lowercase(),
            joints: &self.arm.joints,
            bodies: &self.arm.bodies,
            lower: &self.low,
            upper: &self.high,
            velocity: &self.speed,
            torque: &self.torque,
            coulomb: &self.coulomb,
            viscous: &self.viscous,
            ratio: &self.ratio,
            rotor: &self.arm.rotor,
            loss: &self.loss,
            base_w: self.base_w,
            regeneration: self.regeneration,
        }
    }
}

pub(super) fn draw(six_only: bool, rng: &mut Rng) -> Robot {
    let build = if !six_only && rng.chance(0.2) {
        Build::Seven
    } else {
        rng.pick(&[Build::Cobot, Build::Cobot, Build::Elbow, Build::OffsetWrist])
    };
    let size = size(rng.log_between(PAYLOAD.0, PAYLOAD.1), build, rng);
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
    let ramp = rng.between(0.22, 0.5) * robot.size.reach.sqrt();
    for (i, (low, high, speed)) in ranges(robot.build).into_iter().enumerate().take(robot.arm.n()) {
        robot.low[i] = (low * rng.between(0.9, 1.05) * 100.0).round() / 100.0;
        robot.high[i] = (high * rng.between(0.9, 1.05) * 100.0).round() / 100.0;
        robot.speed[i] = (speed * slow * rng.between(0.85, 1.15) * 100.0).round() / 100.0;
        let shorter = if i > 2 { 0.7 } else { 1.0 };
        robot.acceleration[i] = robot.speed[i] / (ramp * shorter);
    }
}

/// Rms link torques with inertia and weight \[Nm\], largest, and median of the diagonal of the mass
/// matrix \[kg m²\], over random states.
fn levels(robot: &Robot, rng: &mut Rng) -> (Row, Row, Row) {
    let n = robot.arm.n();
    let (mut squares, mut most, mut diagonal) = ([0.0; MAX], [0.0_f64; MAX], [0.0; MAX]);
    for _ in 0..SAMPLES {
        let (mut q, mut qd, mut qdd) = ([0.0; MAX], [0.0; MAX], [0.0; MAX]);
        for i in 0..n {
            q[i] = rng.between(robot.low[i], robot.high[i]);
            qd[i] = robot.speed[i] * rng.between(-1.0, 1.0);
            qdd[i] = robot.acceleration[i] * rng.between(-1.0, 1.0);
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
        let share = if wrist { rng.between(0.7, 2.2) } else { rng.between(0.2, 0.7) };
        robot.arm.rotor[i] = share * diagonal[i];
        if wrist && i > 3 {
            // The motors of the wrist are of one family.
            let before = robot.arm.rotor[i - 1];
            robot.arm.rotor[i] = robot.arm.rotor[i].clamp(0.2 * before, before);
        }
        let harmonic = [100.0, 120.0, 160.0, 100.0, 80.0, 101.0];
        robot.ratio[i] = if robot.build.harmonic() {
            rng.pick(&harmonic)
        } else if i < 3 {
            (rng.between(90.0, 220.0) * 10.0).round() / 10.0
        } else {
            (rng.between(45.0, 110.0) * 10.0).round() / 10.0
        };
    }
}

fn set_friction(robot: &mut Robot, rng: &mut Rng) {
    let n = robot.arm.n();
    let (rms, _, _) = levels(robot, rng);
    // Motors are made for the rated payload, a little aside of the flange.
    let mut loaded = robot.clone();
    if let Some(last) = loaded.arm.bodies.last_mut() {
        let aside = V3::repeat(ASIDE * robot.size.reach);
        let edges = V3::repeat((robot.size.payload / DENSITY).cbrt());
        *last = joined(last, &block(robot.size.payload, robot.arm.flange + aside, edges));
    }
    let (_, most, _) = levels(&loaded, rng);
    let rough =
        if robot.build.harmonic() { rng.between(0.1, 0.28) } else { rng.between(0.05, 0.18) };
    for i in 0..n {
        let whole = rough * rng.between(0.7, 1.3) * rms[i];
        let dry = rng.between(0.35, 0.75);
        robot.coulomb[i] = whole * dry;
        robot.viscous[i] = whole * (1.0 - dry) / (0.5 * robot.speed[i]);
        robot.torque[i] = round_up(RESERVE * (most[i] + 2.0 * whole));
        // Copper loss at the rms torque: 3 to 12 % of the power at half speed.
        let power = rms[i] * 0.5 * robot.speed[i];
        robot.loss[i] = rng.between(0.03, 0.12) * power / (rms[i] * rms[i]);
    }
    robot.base_w = (rng.between(60.0, 120.0) * robot.size.payload.powf(0.2)).round();
    robot.regeneration = rng.pick(&[0.0, 0.5, 0.7, 0.8, 0.9, 0.6]);
}

/// The next larger number of two digits.
fn round_up(x: f64) -> f64 {
    let unit = 10f64.powf(x.log10().floor() - 1.0);
    (x / unit).ceil() * unit
}

/// A robot that differs from its nominal model by the spread.
pub(super) fn perturbed(nominal: &Robot, spread: &Spread, rng: &mut Rng) -> Robot {
    let mut robot = nominal.clone();
    let n = nominal.arm.n();
    for body in &mut robot.arm.bodies {
        body.mass *= factor(spread.mass, rng);
        body.com += rng.normals() * spread.com;
        // Second moments Σ = ½ tr(I) 1 − I are stretched: the result is the inertia of a body.
        let second = M3::identity() * (0.5 * body.inertia.trace()) - body.inertia;
        let mut stretch = M3::identity();
        for (r, c) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
            let value = 0.5 * spread.inertia * rng.normal().clamp(-2.5, 2.5);
            stretch[(r, c)] += if r == c { value } else { 0.3 * value };
        }
        let second = stretch * second * stretch.transpose();
        body.inertia = M3::identity() * second.trace() - second;
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

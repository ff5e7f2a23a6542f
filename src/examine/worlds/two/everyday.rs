//! What every robot has beyond its model: friction of a real gear, and a smooth error of the torque.
//!
//! Friction: a bristle state with the Stribeck curve of a lubricated gear, bent viscous friction and
//! unevenness (C. Canudas de Wit et al., IEEE T-AC 40, 1995; M. Iskandar, S. Wolf, Dynamic friction
//! model with thermal and load dependency, ICRA 2019). Smooth error: a draw of a Gaussian process in
//! its weight-space form, sums of rational-quadratic kernels (C. Rasmussen, C. Williams, Gaussian
//! Processes for Machine Learning, 2006).

use crate::examine::worlds::model::{MAX, Row};
use std::f64::consts::TAU;

use super::robot::Robot;
use crate::examine::worlds::random::Rng;

/// Kernels per joint.
const KERNELS: usize = 14;
/// Median of the smooth error relative to the rms torque, and its spread (natural logarithm).
const ERROR: (f64, f64) = (0.006, 0.6);
/// Bounds of the smooth error relative to the rms torque.
const ERROR_BOUNDS: (f64, f64) = (0.002, 0.03);

/// Levels of a motion by joint, against which sizes are measured.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    /// Rms of the torque \[Nm\].
    pub(super) torque: Row,
    /// Largest torque through the gear \[Nm\].
    pub(super) peak: Row,
    /// Rms of the torque through the gear \[Nm\].
    pub(super) load: Row,
    /// Largest speed \[rad/s\].
    pub(super) speed: Row,
    /// Rms of the speed \[rad/s\].
    pub(super) rate: Row,
    /// Rms of the acceleration \[rad/s²\].
    pub(super) acceleration: Row,
    /// Middle of the angles \[rad\].
    pub(super) middle: Row,
    /// Half of the range of the angles \[rad\].
    pub(super) width: Row,
}

/// Levels of rows of angles, rates and accelerations.
pub(super) fn scale(robot: &Robot, rows: &[(Row, Row, Row)]) -> Scale {
    let zero = [0.0; MAX];
    let (mut low, mut high) = ([f64::INFINITY; MAX], [f64::NEG_INFINITY; MAX]);
    let (mut s, count) = ([zero; 6], rows.len().max(1) as f64);
    for (q, v, a) in rows {
        let load = robot.arm.torques(q, v, a);
        for i in 0..robot.arm.n() {
            let friction = robot.coulomb[i] * (v[i] * 40.0).tanh() + robot.viscous[i] * v[i];
            let all = load[i] + robot.arm.rotor[i] * a[i] + friction;
            s[0][i] += all * all / count;
            s[1][i] = s[1][i].max(all.abs());
            s[2][i] += load[i] * load[i] / count;
            s[3][i] = s[3][i].max(v[i].abs());
            s[4][i] += v[i] * v[i] / count;
            s[5][i] += a[i] * a[i] / count;
            low[i] = low[i].min(q[i]);
            high[i] = high[i].max(q[i]);
        }
    }
    let mut out = Scale {
        torque: s[0].map(|x| x.sqrt().max(1e-4)),
        peak: s[1],
        load: s[2].map(|x| x.sqrt().max(1e-4)),
        speed: s[3].map(|x| x.max(0.02)),
        rate: s[4].map(|x| x.sqrt().max(0.01)),
        acceleration: s[5].map(|x| x.sqrt().max(0.02)),
        middle: zero,
        width: [1.0; MAX],
    };
    for i in 0..robot.arm.n() {
        out.middle[i] = 0.5 * (low[i] + high[i]);
        out.width[i] = (0.5 * (high[i] - low[i])).max(0.05);
    }
    out
}

/// A kernel: centre in four coordinates and weight.
type Kernel = ([f64; 4], f64);

/// The smooth error of one joint.
#[derive(Clone, Debug)]
struct Smooth {
    other: usize,
    centre: [f64; 4],
    length: [f64; 4],
    shape: f64,
    kernels: Vec<Kernel>,
}

impl Smooth {
    fn at(&self, i: usize, q: &Row, v: &Row, load: &Row) -> f64 {
        let raw = [q[i], q[self.other], v[i], load[i]];
        let mut x = [0.0; 4];
        for (k, value) in raw.iter().enumerate() {
            x[k] = (value - self.centre[k]) / self.length[k];
        }
        let mut sum = 0.0;
        for (centre, weight) in &self.kernels {
            let square: f64 = x.iter().zip(centre).map(|(a, b)| (a - b) * (a - b)).sum();
            let root = 1.0 / (1.0 + self.shape * square);
            sum += weight * root * root;
        }
        sum
    }
}

/// Friction of a joint beyond the parameters of the model.
#[derive(Clone, Debug)]
pub(super) struct Gear {
    /// Stribeck level relative to Coulomb friction, its speed \[rad/s\] and power.
    stribeck: (f64, f64, f64),
    /// Share of viscous friction that is lost at the largest speed.
    bend: f64,
    speed: f64,
    /// Waves over the angle: amplitude, waves per rad, phase.
    waves: [(f64, f64, f64); 3],
    side: f64,
    /// Angle in which 1/e of the bristle force is left to build up \[rad\].
    pub(super) distance: f64,
}

/// Friction factors of one log: they differ from day to day and from cycle to cycle.
#[derive(Clone, Debug)]
pub(super) struct Day {
    dry: Row,
    wet: Row,
    /// Relative loss of viscous friction at the end of warming up, and its time constant \[s\].
    warming: (f64, f64),
    cycles: Vec<Row>,
}

/// All everyday deviations of a robot that are the same in all logs.
#[derive(Clone, Debug)]
pub(super) struct Everyday {
    smooth: Vec<Smooth>,
    pub(super) gears: Vec<Gear>,
    /// Constant offset of the torque \[Nm\].
    pub(super) offset: Row,
}

impl Everyday {
    /// Draws the deviations; `rows` are rows of the motions.
    pub(super) fn draw(
        robot: &Robot,
        rows: &[(Row, Row, Row)],
        scale: &Scale,
        rng: &mut Rng,
    ) -> Self {
        let n = robot.arm.n();
        let loads: Vec<Row> = rows.iter().map(|(q, v, a)| robot.arm.torques(q, v, a)).collect();
        let (mut smooth, mut gears, mut offset) = (Vec::new(), Vec::new(), [0.0; MAX]);
        for i in 0..n {
            smooth.push(draw_smooth(i, n, (rows, &loads), scale, rng));
            gears.push(draw_gear(robot.speed[i], rng));
            offset[i] = 0.004 * rng.normal() * scale.torque[i];
        }
        Self { smooth, gears, offset }
    }

    /// The smooth error of all joints \[Nm\].
    pub(super) fn error(&self, q: &Row, v: &Row, load: &Row) -> Row {
        let mut out = self.offset;
        for (i, smooth) in self.smooth.iter().enumerate() {
            out[i] += smooth.at(i, q, v, load);
        }
        out
    }
}

fn draw_smooth(
    i: usize,
    n: usize,
    data: (&[(Row, Row, Row)], &[Row]),
    scale: &Scale,
    rng: &mut Rng,
) -> Smooth {
    let (rows, loads) = data;
    let other = (i + 1 + rng.below(n - 1)) % n;
    let stretch = |rng: &mut Rng| rng.between(0.5, 1.4);
    let mut smooth = Smooth {
        other,
        centre: [scale.middle[i], scale.middle[other], 0.0, 0.0],
        length: [
            scale.width[i] * stretch(rng),
            scale.width[other] * stretch(rng),
            scale.speed[i] * stretch(rng),
            1.5 * scale.load[i] * stretch(rng),
        ],
        shape: rng.between(0.25, 0.5),
        kernels: Vec::new(),
    };
    for _ in 0..KERNELS {
        let centre = [rng.normal(), rng.normal(), 0.7 * rng.normal(), rng.normal()];
        smooth.kernels.push((centre, rng.normal()));
    }
    let sum: f64 =
        rows.iter().zip(loads).map(|((q, v, _), load)| smooth.at(i, q, v, load).powi(2)).sum();
    let rms = (sum / rows.len().max(1) as f64).sqrt().max(1e-9);
    let wanted = (ERROR.0 * (ERROR.1 * rng.normal()).exp()).clamp(ERROR_BOUNDS.0, ERROR_BOUNDS.1);
    for (_, weight) in &mut smooth.kernels {
        *weight *= wanted * scale.torque[i] / rms;
    }
    smooth
}

fn draw_gear(speed: f64, rng: &mut Rng) -> Gear {
    let mut wave =
        |most: f64| (rng.between(0.003, most), rng.between(0.5, 5.0), rng.between(0.0, TAU));
    let waves = [wave(0.02), wave(0.015), wave(0.01)];
    Gear {
        stribeck: (
            rng.between(-0.02, 0.08),
            speed * rng.between(0.01, 0.05),
            rng.between(0.6, 1.6),
        ),
        bend: rng.between(-0.03, 0.15),
        speed,
        waves,
        side: 0.012 * rng.normal(),
        distance: rng.log_between(3e-5, 2e-4),
    }
}

impl Gear {
    /// Relative unevenness at an angle.
    pub(super) fn uneven(&self, q: f64) -> f64 {
        self.waves.iter().map(|(size, rate, phase)| size * (rate * q + phase).cos()).sum()
    }

    /// Levels of Coulomb friction (relative) and of viscous friction (relative) at a speed.
    pub(super) fn levels(&self, v: f64, uneven: f64) -> (f64, f64) {
        let (stiction, speed, power) = self.stribeck;
        let slow = v.abs() / speed;
        let peak = if slow > 12.0 { 0.0 } else { stiction * (-slow.powf(power)).exp() };
        let side = self.side * (v / speed).clamp(-1.0, 1.0);
        let bent = 1.0 - self.bend * v.abs() / (self.speed + v.abs());
        (1.0 + peak + uneven + side, bent)
    }
}

/// Share by which friction differs between logs, and between cycles.
const DAYS: f64 = 0.015;
const CYCLES: f64 = 0.006;

impl Day {
    /// Draws the factors of one log with a number of cycles.
    pub(super) fn draw(n: usize, cycles: usize, rng: &mut Rng) -> Self {
        let (mut dry, mut wet) = ([1.0; MAX], [1.0; MAX]);
        let warm = 0.012 * rng.normal();
        for i in 0..n {
            dry[i] += DAYS * rng.normal() * 0.7;
            wet[i] += DAYS * rng.normal() + warm;
        }
        let mut list = Vec::new();
        let mut now = [0.0; MAX];
        for _ in 0..=cycles {
            for x in &mut now {
                *x = 0.7 * *x + 0.7 * CYCLES * rng.normal();
            }
            list.push(now);
        }
        let warming = (rng.between(0.0, 0.015), rng.between(60.0, 600.0));
        Self { dry, wet, warming, cycles: list }
    }

    /// Factors of Coulomb and viscous friction of a joint at a time of the log and in a cycle.
    pub(super) fn factors(&self, i: usize, time: f64, cycle: usize) -> (f64, f64) {
        let own = self.cycles.get(cycle).map_or(0.0, |c| c[i]);
        let warm = 1.0 - self.warming.0 * (1.0 - (-time.max(0.0) / self.warming.1).exp());
        (self.dry[i] * (1.0 + own), self.wet[i] * (1.0 + own) * warm)
    }
}

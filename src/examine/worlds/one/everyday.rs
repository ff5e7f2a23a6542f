//! Everyday deviations: what every robot has, also before a fault, and what no finding is.

use super::arm::Arm;
use super::friction::Bank;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;

/// Median and log-deviation of the smooth error over the rms torque; cut at its bounds.
const ERROR: (f64, f64) = (0.006, 0.7);
/// Bounds of the smooth error over the rms torque.
const ERROR_BOUNDS: (f64, f64) = (0.002, 0.03);
/// Functions in a sum of the smooth error.
const FUNCTIONS: usize = 10;
/// Length over which random Fourier features vary: angle \[rad\], and speed and load over their peaks
/// (A. Rahimi, B. Recht, Random features for large-scale kernel machines, 2007).
const LENGTHS: [f64; 4] = [1.2, 1.4, 1.2, 1.2];
/// Width of radial functions in the same scaled coordinates.
const RADIUS: (f64, f64) = (0.8, 2.0);
/// Share of the smooth error that is there without load; the rest grows with it up to twice its rms.
const IDLE: f64 = 0.3;
/// Delay of the torque path at low frequency \[s\].
const LAG: (f64, f64) = (0.001, 0.005);
/// Damping of the two filters: Bessel and Butterworth of second order.
const DAMPING: [f64; 2] = [0.866, 0.707];
/// Unevenness of friction over the angle, relative.
const UNEVEN: f64 = 0.03;
/// Share by which viscous friction bends at the largest speed.
const BENT: f64 = 0.08;
/// Friction forwards over backwards, less 1.
const ASYMMETRY: f64 = 0.012;
/// Offset over the rms torque.
const OFFSET: f64 = 0.004;
/// Noise over the rms torque.
const NOISE: (f64, f64) = (0.003, 0.02);
/// Correlation time of the noise \[s\].
const NOISE_TIME: (f64, f64) = (0.001, 0.02);
/// Friction changes from day to day by this share.
const DAY: (f64, f64) = (0.01, 0.03);
/// Friction changes from cycle to cycle by this share.
const CYCLE: (f64, f64) = (0.001, 0.006);

/// Levels of a motion, by joint.
#[derive(Clone, Debug, Default)]
pub(super) struct Level {
    /// Rms torque of the motor \[Nm\].
    pub(super) torque: Row,
    /// Largest torque \[Nm\].
    pub(super) peak: Row,
    /// Rms torque of the links \[Nm\].
    pub(super) load: Row,
    /// Largest speed \[rad/s\].
    pub(super) speed: Row,
    /// Largest acceleration \[rad/s²\].
    pub(super) acceleration: Row,
    /// Middle of the angles \[rad\].
    pub(super) middle: Row,
    /// Half of their range \[rad\].
    pub(super) half: Row,
}

/// A smooth function of four numbers.
#[derive(Clone, Debug)]
struct Smooth {
    other: usize,
    radial: Option<f64>,
    terms: Vec<([f64; 4], f64, f64)>,
    size: f64,
}

impl Smooth {
    /// A random one of rms `size` \[Nm\] about.
    fn new(joint: usize, count: usize, size: f64, rng: &mut Rng) -> Self {
        let other = (joint + 1 + rng.below(count.max(2) - 1)) % count.max(1);
        let radial = rng.chance(0.4).then(|| rng.uniform(RADIUS));
        let terms = (0..FUNCTIONS)
            .map(|_| {
                let mut w = [0.0; 4];
                for (k, x) in w.iter_mut().enumerate() {
                    *x = if radial.is_some() {
                        1.2 * rng.spread(1.0)
                    } else {
                        rng.spread(1.0) / LENGTHS[k]
                    };
                }
                (w, rng.angle(), rng.spread(1.0))
            })
            .collect();
        Self { other, radial, terms, size }
    }

    fn at(&self, x: &[f64; 4]) -> f64 {
        let mut sum = 0.0;
        for (w, phase, weight) in &self.terms {
            sum += weight
                * self.radial.map_or_else(
                    || (w[0] * x[0] + w[1] * x[1] + w[2] * x[2] + w[3] * x[3] + phase).cos(),
                    |radius| {
                        let d: f64 = (0..4).map(|k| (x[k] - w[k]) * (x[k] - w[k])).sum();
                        (-0.5 * d / (radius * radius)).exp()
                    },
                );
        }
        self.size * sum * (2.0 / FUNCTIONS as f64).sqrt()
    }
}

/// Everyday deviations of one joint.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    smooth: Smooth,
    pub(super) bank: Bank,
    /// Bend of viscous friction at the largest speed.
    pub(super) bent: f64,
    /// Largest speed \[rad/s\].
    pub(super) top: f64,
    pub(super) asymmetry: f64,
    uneven: [(f64, f64, f64); 3],
    /// Natural frequency \[rad/s\] of the filter of the torque.
    pub(super) omega: f64,
    pub(super) zeta: f64,
    /// Constant offset \[Nm\].
    pub(super) offset: f64,
    /// Deviation of the noise \[Nm\].
    pub(super) noise: f64,
}

/// Everyday deviations of a robot.
#[derive(Clone, Debug)]
pub(super) struct Everyday {
    pub(super) joints: Vec<Joint>,
    /// Correlation time of the noise \[s\].
    pub(super) noise_time: f64,
    /// Relative change of friction between days.
    pub(super) day: f64,
    /// Relative change of friction between cycles.
    pub(super) cycle: f64,
}

/// What differs from day to day.
#[derive(Clone, Debug)]
pub(super) struct Day {
    pub(super) coulomb: Row,
    pub(super) viscous: Row,
    /// Key of the changes from cycle to cycle.
    pub(super) key: u64,
}

impl Everyday {
    /// A random set for an arm and the level of its motion.
    pub(super) fn new(arm: &Arm, level: &Level, rng: &mut Rng) -> Self {
        let count = arm.count();
        let zeta = DAMPING[rng.below(DAMPING.len())];
        let omega = 2.0 * zeta / rng.log(LAG);
        let common = ERROR.0 * (0.5 * ERROR.1 * rng.spread(1.0)).exp();
        let noise = rng.log(NOISE);
        let joints = (0..count)
            .map(|j| {
                let share = common * (ERROR.1 * rng.spread(1.0)).exp();
                let size = share.clamp(ERROR_BOUNDS.0, ERROR_BOUNDS.1) * level.torque[j];
                let mut uneven = [(0.0, 0.0, 0.0); 3];
                for (k, wave) in uneven.iter_mut().enumerate() {
                    let order = [1.0, 2.0, 3.0 + rng.below(6) as f64][k];
                    *wave = (order, UNEVEN * 0.6 * rng.spread(1.0), rng.angle());
                }
                Joint {
                    smooth: Smooth::new(j, count, size, rng),
                    bank: Bank::everyday(level.speed[j].max(0.05), rng),
                    bent: BENT * rng.spread(1.0),
                    top: level.speed[j].max(0.05),
                    asymmetry: ASYMMETRY * rng.spread(1.0),
                    uneven,
                    omega,
                    zeta,
                    offset: OFFSET * rng.spread(1.0) * level.torque[j],
                    noise: noise * rng.uniform((0.7, 1.4)) * level.torque[j],
                }
            })
            .collect();
        Self {
            joints,
            noise_time: rng.log(NOISE_TIME),
            day: rng.uniform(DAY),
            cycle: rng.log(CYCLE),
        }
    }

    pub(super) fn day(&self, rng: &mut Rng) -> Day {
        let (mut coulomb, mut viscous) = ([1.0; MAX], [1.0; MAX]);
        // Temperature moves all joints together; viscous friction follows it most.
        let common = rng.spread(1.0);
        for j in 0..MAX {
            coulomb[j] += self.day * (0.4 * common + 0.6 * rng.spread(1.0));
            viscous[j] += self.day * (0.8 * common + 0.6 * rng.spread(1.0));
        }
        Day { coulomb, viscous, key: rng.bits() }
    }

    /// Smooth error \[Nm\] of each joint.
    pub(super) fn error(&self, motion: (&Row, &Row, &Row), level: &Level) -> Row {
        let (q, v, load) = motion;
        let mut out = [0.0; MAX];
        for (j, joint) in self.joints.iter().enumerate() {
            let k = joint.smooth.other;
            let x = [
                q[j] - level.middle[j],
                q[k] - level.middle[k],
                v[j] / level.speed[j].max(1e-6),
                load[j] / level.peak[j].max(1e-9),
            ];
            let share = load[j].abs() / level.load[j].max(1e-9);
            out[j] = joint.smooth.at(&x) * (IDLE + (1.0 - IDLE) * share.min(2.0));
        }
        out
    }

    /// Factor of Coulomb friction over the angle, each joint.
    pub(super) fn uneven(&self, q: &Row) -> Row {
        let mut out = [1.0; MAX];
        for (j, joint) in self.joints.iter().enumerate() {
            for (order, size, phase) in joint.uneven {
                out[j] += size * (order * q[j] + phase).cos();
            }
        }
        out
    }
}

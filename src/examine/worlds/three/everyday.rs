//! What every robot has beyond its model, which is no finding.

use super::arm::Arm;
use super::motor::Motor;
use super::spatial::Point;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;

/// Neurons of a joint's random feature function.
const NEURONS: usize = 6;
/// Inputs of a neuron: own angle, another joint's angle, own rate, load, another joint's rate, bias.
const INPUTS: usize = 6;

/// One tanh of a random projection (A. Rahimi, B. Recht, Random features, 2007).
#[derive(Clone, Copy, Debug)]
struct Neuron {
    weights: [f64; INPUTS],
    out: f64,
}

/// Habits of one joint.
#[derive(Clone, Debug)]
pub(super) struct Habit {
    neurons: Vec<Neuron>,
    /// The other joint that it sees.
    other: usize,
    /// Size of the smooth error \[Nm\].
    error: f64,
    /// Widths \[rad/s\] of the two tanh of Coulomb friction, and the share of the first.
    fast: f64,
    slow: f64,
    mix: f64,
    /// Stribeck part: share of Coulomb friction, speed \[rad/s\], power.
    rise: f64,
    speed: f64,
    power: f64,
    /// Bend of viscous friction over the speed range, share.
    bend: f64,
    /// Unevenness over the angle: share, waves per radian, phase.
    uneven: f64,
    waves: f64,
    phase: f64,
    /// Share by which forwards is more than backwards.
    asymmetry: f64,
    /// Loss per torque through the gear.
    load: f64,
    /// Share of the bristle, and its distance \[rad\].
    bristle: f64,
    distance: f64,
    /// Change of viscous friction over the gear's temperature, and time constant \[s\].
    thermal: f64,
    warming: f64,
    /// Largest rate \[rad/s\].
    fastest: f64,
    /// Standard deviation of friction from cycle to cycle.
    cycle: f64,
    /// Constant offset of the logged torque \[Nm\].
    pub(super) offset: f64,
    /// White and coloured noise \[Nm\], and quantum \[Nm\].
    pub(super) white: f64,
    /// Coloured noise \[Nm\].
    pub(super) coloured: f64,
    /// Quantum of the logged torque \[Nm\].
    pub(super) quantum: f64,
    /// Quantum of the logged angle \[rad\].
    pub(super) step: f64,
    pub(super) motor: Motor,
}

/// Habits of a robot and of its logger.
#[derive(Clone, Debug)]
pub(super) struct Everyday {
    pub(super) joints: Vec<Habit>,
    /// Lag of the torque path \[s\] and its order.
    pub(super) lag: f64,
    pub(super) order: usize,
    /// How much later than the position the torque is sampled \[s\].
    pub(super) late: f64,
    /// Correlation time of the coloured noise \[s\].
    pub(super) colour: f64,
    /// Jitter of the time stamps, share of the sampling period.
    pub(super) jitter: f64,
}

/// What differs from day to day.
#[derive(Clone, Debug)]
pub(super) struct Day {
    pub(super) friction: Row,
    /// Gear temperature at the start of the log, by joint: about 1.
    pub(super) warmth: Row,
}

impl Day {
    pub(super) fn new(rng: &mut Rng) -> Self {
        let mut day = Self { friction: [1.0; MAX], warmth: [1.0; MAX] };
        let common = rng.spread(0.01);
        for (friction, warmth) in day.friction.iter_mut().zip(&mut day.warmth) {
            *friction += common + rng.spread(0.01);
            *warmth += rng.spread(0.08);
        }
        day
    }
}

/// Friction of one motor before what varies with time \[Nm\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Dry {
    /// Part of the sign: the torque at full sign.
    pub(super) level: f64,
    pub(super) smooth: f64,
    pub(super) viscous: f64,
    pub(super) load: f64,
}

impl Everyday {
    pub(super) fn new(arm: &Arm, rng: &mut Rng) -> Self {
        // The arm's share, then each joint's about it: mostly below 1.5 %.
        let common = rng.log_between(0.003, 0.015);
        let joints = (0..arm.axes()).map(|i| habit(arm, i, common, rng)).collect();
        Self {
            joints,
            lag: rng.log_between(0.0008, 0.005),
            order: rng.whole(1, 3),
            late: rng.between(-0.0005, 0.0015),
            colour: rng.log_between(0.01, 0.1),
            jitter: if rng.chance(0.6) { rng.log_between(0.002, 0.04) } else { 0.0 },
        }
    }
}

fn habit(arm: &Arm, i: usize, common: f64, rng: &mut Rng) -> Habit {
    let usual = arm.usual[i];
    let others: Vec<usize> = (0..arm.axes()).filter(|k| *k != i).collect();
    let neurons: Vec<Neuron> = (0..NEURONS)
        .map(|_| Neuron {
            weights: [
                rng.normal(),
                0.7 * rng.normal(),
                0.8 * rng.normal(),
                0.5 * rng.normal(),
                0.4 * rng.normal(),
                0.8 * rng.normal(),
            ],
            out: rng.normal(),
        })
        .collect();
    let turn = std::f64::consts::TAU / arm.ratio[i].max(1.0);
    let noise = usual * rng.log_between(0.002, 0.015);
    let shared = rng.between(0.3, 0.8);
    let bits = rng.whole(13, 19);
    Habit {
        neurons,
        other: others.get(rng.below(others.len())).copied().unwrap_or(i),
        error: usual * (common * rng.log_between(0.5, 2.0)).clamp(0.002, 0.03) * 0.6,
        fast: rng.log_between(0.003, 0.012),
        slow: rng.between(0.02, 0.06) * arm.speed[i],
        mix: rng.between(0.85, 0.97),
        rise: rng.between(0.0, 0.08),
        speed: rng.log_between(0.01, 0.1),
        power: rng.between(0.7, 2.0),
        bend: rng.between(-0.03, 0.12),
        uneven: rng.between(0.005, 0.04),
        waves: rng.between(0.5, 4.0),
        phase: rng.between(0.0, 6.0),
        asymmetry: rng.spread(0.015),
        load: rng.log_between(0.001, 0.006),
        bristle: rng.between(0.05, 0.3),
        distance: rng.log_between(5e-5, 6e-4),
        thermal: rng.between(0.03, 0.1),
        warming: rng.log_between(300.0, 3000.0),
        fastest: arm.speed[i],
        cycle: rng.log_between(0.002, 0.01),
        offset: usual * rng.spread(0.006),
        white: noise * (1.0 - shared),
        coloured: noise * shared,
        quantum: if rng.chance(0.7) {
            arm.torque[i] / f64::exp2(rng.whole(10, 14) as f64)
        } else {
            0.0
        },
        step: if rng.chance(0.7) { turn / f64::exp2(bits as f64) } else { 0.0 },
        motor: Motor::new(arm, i, rng),
    }
}

impl Habit {
    /// The smooth error \[Nm\] at a state.
    pub(super) fn smooth(&self, i: usize, at: &Point, arm: &Arm, load: f64) -> f64 {
        let o = self.other;
        let inputs = [
            (at.q[i] - arm.middle[i]) / arm.span[i].max(0.1),
            (at.q[o] - arm.middle[o]) / arm.span[o].max(0.1),
            at.v[i] / (0.4 * arm.speed[i]),
            load / arm.usual[i],
            at.v[o] / (0.4 * arm.speed[o]),
            1.0,
        ];
        let mut sum = 0.0;
        for neuron in &self.neurons {
            let x: f64 = neuron.weights.iter().zip(inputs).map(|(w, x)| w * x).sum();
            sum += neuron.out * x.tanh();
        }
        self.error * sum
    }

    /// Friction before what varies with time, of Coulomb and viscous friction of the real arm.
    pub(super) fn dry(&self, coulomb: f64, viscous: f64, rate: f64, angle: f64, load: f64) -> Dry {
        let size = rate.abs();
        let direction = (rate / self.fast).tanh();
        // A half of the rise is in the mean of usual rates already.
        let stribeck = self.rise * (1.0 / (1.0 + (size / self.speed).powf(self.power)) - 0.2);
        let place =
            self.uneven * (self.waves * angle + (angle - self.phase).sin() - self.phase).cos();
        let level = coulomb * (1.0 + stribeck + place + self.asymmetry * direction);
        let smooth = self.mix * direction + (1.0 - self.mix) * (rate / self.slow).tanh();
        let bent = 1.0 - self.bend * (size / self.fastest - 0.4);
        Dry {
            level,
            smooth,
            viscous: viscous * rate * bent,
            load: self.load * load.abs() * direction,
        }
    }

    /// Total friction \[Nm\]; moves the bristle (`memory[0]`) and the gear's temperature (`memory[1]`).
    pub(super) fn friction(
        &self,
        dry: &Dry,
        rate: f64,
        dt: f64,
        factor: f64,
        memory: &mut [f64; 2],
    ) -> f64 {
        /// Time in which a bristle at rest relaxes \[s\].
        const RELAX: f64 = 0.3;
        let sign = rate.signum();
        let keep = (-rate.abs() * dt / self.distance).exp();
        memory[0] = sign + (memory[0] - sign) * keep;
        if rate.abs() < 1e-5 {
            memory[0] *= 1.0 - dt / RELAX;
        }
        // Heat: about 1 in usual work.
        let heat = 2.0 * rate.abs() / self.fastest + 0.4;
        memory[1] += (heat - memory[1]) * dt / self.warming;
        let direction = (1.0 - self.bristle) * dry.smooth + self.bristle * memory[0];
        let thin = 1.0 - self.thermal * (memory[1] - 1.0);
        factor * (dry.level * direction + dry.viscous * thin + dry.load)
    }

    /// Factor of friction in one cycle.
    pub(super) fn cycle(&self, rng: &mut Rng) -> f64 {
        1.0 + rng.spread(self.cycle)
    }
}

//! The way of the torque from the motor to the log: the drive's filter, and faults of it.

use super::terms::{Now, TICK};
use crate::examine::worlds::model::{MAX, Row};

/// Delayed mean: a ring of the last values.
#[derive(Clone, Debug)]
struct Ring {
    values: Vec<Row>,
    head: usize,
}

impl Ring {
    fn new(length: usize) -> Self {
        Self { values: vec![[0.0; MAX]; length.max(1)], head: 0 }
    }

    fn push(&mut self, x: Row) {
        self.head = (self.head + 1) % self.values.len();
        if let Some(place) = self.values.get_mut(self.head) {
            *place = x;
        }
    }

    /// The value so many steps ago.
    fn ago(&self, steps: usize) -> Row {
        let count = self.values.len();
        let at = (self.head + count - steps.min(count - 1)) % count;
        self.values.get(at).copied().unwrap_or([0.0; MAX])
    }

    fn fill(&mut self, x: Row) {
        self.values.fill(x);
    }
}

/// The healthy path: poles, then a moving average, then a delay.
#[derive(Clone, Debug)]
pub(super) struct Path {
    /// Time constants of up to two poles; 0: none \[s\].
    pub(super) poles: [f64; 2],
    state: [Row; 2],
    sum: Row,
    ring: Ring,
    steps: (usize, usize),
}

impl Path {
    /// A path for a step \[s\].
    pub(super) fn new(poles: [f64; 2], mean: f64, delay: f64, dt: f64) -> Self {
        let steps = ((mean / dt).round().max(1.0) as usize, (delay / dt).round() as usize);
        let ring = Ring::new(steps.0 + steps.1 + 1);
        Self { poles, state: [[0.0; MAX]; 2], sum: [0.0; MAX], ring, steps }
    }

    /// Starts in the steady state.
    pub(super) fn fill(&mut self, x: Row) {
        self.state = [x; 2];
        self.ring.fill(x);
        self.sum = x.map(|value| value * self.steps.0 as f64);
    }

    /// Steps the path.
    pub(super) fn step(&mut self, x: &Row, dt: f64) -> Row {
        let mut now = *x;
        for (state, pole) in self.state.iter_mut().zip(self.poles) {
            if pole > 0.0 {
                for (s, value) in state.iter_mut().zip(&now) {
                    *s += dt * (value - *s) / (pole + dt);
                }
                now = *state;
            }
        }
        let (width, delay) = self.steps;
        self.ring.push(now);
        let (newest, oldest) = (self.ring.ago(delay), self.ring.ago(delay + width));
        let mut out = [0.0; MAX];
        for i in 0..MAX {
            self.sum[i] += newest[i] - oldest[i];
            out[i] = self.sum[i] / width as f64;
        }
        out
    }
}

/// Kinds of faults of the path; p0, p1, … are their parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Gain with drift, as magnets warm: 1 + p0·(1 + p1·(1 − exp(−t/p2))).
    WarmingGain,
    /// Gain that is different for both signs of the current: 1 + p0 + p1·tanh(τ/p2).
    SidedGain,
    /// Saturation of iron, Langevin-like: τ·(1 + p0·x²·(1 + x²)/2), x = |τ|/p1.
    Fourth,
    /// Above a knee p1: τ + p0·(|τ| − p1)·sign.
    Knee,
    /// Logged p1·tan(τ/p1), clipped at a right angle's 85 %.
    Tangent,
    /// Flux weakening: τ·(1 + p0·(|v|/p1 − 1)) above p1.
    BaseSpeed,
    /// τ·√(1 + p0·((v/p1)² − 1)) above p1: voltage ellipse.
    Ellipse,
    /// Sign turned, gain 1 + p0.
    Flipped,
    /// Sign turned, and p0 Nm added by the zero of the sensor.
    FlippedZero,
    /// Apparent p0·a + p1·v, smoothed with p2 s.
    Observer,
    /// Apparent p0·a + p1·v that saturates at p2 Nm.
    BoundedObserver,
    /// Delay p0 as an all-pass of first order (Padé).
    AllPass,
    /// A value held for 2·p0.
    Hold,
    /// Delay p0 that changes by a share p1, with a period p2.
    Wander,
    /// Two poles: p0 and p1.
    TwoPoles,
    /// Moving average over 2·p0.
    Average,
    /// Butterworth of second order with the time constant p0.
    Butterworth,
    /// Outside: clipped at p0 Nm.
    Clip,
    /// Outside: 0 below p0 Nm.
    DeadBand,
    /// Outside: hum: 1 + p0·sin(2π·p1·t).
    Hum,
    /// Outside: noise of p0 Nm that depends on the angle: (½ + ½·sin(q − p1))⁴.
    PlacedNoise,
    /// Outside: hysteresis of the sensor: play of half width p0 Nm.
    Play,
    /// Outside: a sample that is repeated for p0 s, at random, on the average every p1 s.
    Frozen,
}

/// A fault of the path at some joints.
#[derive(Clone, Debug)]
pub(super) struct Sensor {
    /// Kind.
    pub(super) kind: Kind,
    /// Row that have it.
    pub(super) joints: [bool; MAX],
    /// Parameters, by joint.
    pub(super) p: [[f64; 3]; MAX],
    x: [Row; 2],
    ring: Ring,
    clock: Row,
}

/// Longest delay of a fault \[s\].
const LONGEST: f64 = 0.12;

impl Sensor {
    /// A fault at rest; `p` by joint.
    pub(super) fn new(kind: Kind, joints: [bool; MAX], p: [[f64; 3]; MAX]) -> Self {
        Self { kind, joints, p, x: [[0.0; MAX]; 2], ring: Ring::new(1), clock: [0.0; MAX] }
    }

    /// Starts in the steady state.
    pub(super) fn fill(&mut self, x: Row, dt: f64) {
        self.x = [x, [0.0; MAX]];
        self.ring = Ring::new(if self.remembers() { (LONGEST / dt) as usize } else { 1 });
        self.ring.fill(x);
        if self.kind == Kind::Observer {
            self.x[0] = [0.0; MAX];
        }
    }

    fn remembers(&self) -> bool {
        matches!(self.kind, Kind::Wander | Kind::Average)
    }

    /// Changes the torques \[Nm\].
    pub(super) fn step(&mut self, tau: &mut Row, now: &Now) {
        if self.remembers() {
            self.ring.push(*tau);
        }
        for i in 0..MAX {
            if self.joints[i] {
                tau[i] = match self.kind {
                    Kind::AllPass
                    | Kind::Hold
                    | Kind::Wander
                    | Kind::TwoPoles
                    | Kind::Average
                    | Kind::Butterworth => self.dynamic(tau[i], i, now),
                    Kind::Observer | Kind::BoundedObserver => self.observer(tau[i], i, now),
                    Kind::Play | Kind::Frozen => self.odd(tau[i], i, now),
                    _ => self.fixed(tau[i], i, now),
                };
            }
        }
    }

    /// Laws without memory.
    fn fixed(&self, tau: f64, i: usize, now: &Now) -> f64 {
        let p = &self.p[i];
        let speed = now.v[i].abs();
        match self.kind {
            Kind::WarmingGain => {
                tau * (1.0 + p[0] * (1.0 + p[1] * (1.0 - (-now.t.max(0.0) / p[2]).exp())))
            }
            Kind::SidedGain => tau * (1.0 + p[0] + p[1] * (tau / p[2]).tanh()),
            Kind::Fourth => {
                // Beyond the peak of the logs the iron is full.
                let square = (tau / p[1]).powi(2).min(1.6);
                tau * (1.0 + 0.5 * p[0] * square * (1.0 + square))
            }
            Kind::Knee => tau + p[0] * (tau.abs() - p[1]).max(0.0).copysign(tau),
            Kind::Tangent => {
                let x = (tau / p[1]).clamp(-1.33, 1.33);
                p[1] * x.tan()
            }
            Kind::BaseSpeed => tau * (1.0 + p[0] * (speed / p[1] - 1.0).max(0.0)),
            Kind::Ellipse => tau * (1.0 + p[0] * ((speed / p[1]).powi(2) - 1.0).max(0.0)).sqrt(),
            Kind::Flipped => -tau * (1.0 + p[0]),
            Kind::FlippedZero => p[0] - tau,
            Kind::Clip => tau.clamp(-p[0], p[0]),
            Kind::DeadBand => (tau.abs() - p[0]).max(0.0).copysign(tau),
            Kind::Hum => tau * (1.0 + p[0] * (std::f64::consts::TAU * p[1] * now.t).sin()),
            _ => {
                let place = (0.5 + 0.5 * (now.q[i] - p[1]).sin()).powi(4);
                tau + p[0] * place * 3.46 * (now.chance[i] - 0.5)
            }
        }
    }

    /// Apparent torques of an observer.
    fn observer(&mut self, tau: f64, i: usize, now: &Now) -> f64 {
        let p = self.p[i];
        let extra = p[0] * now.a[i] + p[1] * now.v[i];
        if self.kind == Kind::BoundedObserver {
            return tau + p[2] * (extra / p[2]).tanh();
        }
        self.x[0][i] += now.dt * (extra - self.x[0][i]) / (p[2] + now.dt);
        tau + self.x[0][i]
    }

    /// Delays and filters.
    fn dynamic(&mut self, tau: f64, i: usize, now: &Now) -> f64 {
        let (p, dt) = (self.p[i], now.dt);
        match self.kind {
            Kind::AllPass => {
                // Low pass of half the delay, twice, less the signal.
                self.x[0][i] += dt * (tau - self.x[0][i]) / (0.5 * p[0] + 0.5 * dt);
                2.0 * self.x[0][i] - tau
            }
            Kind::Hold => {
                self.clock[i] += dt;
                if self.clock[i] >= 2.0 * p[0] {
                    self.clock[i] -= 2.0 * p[0];
                    self.x[0][i] = tau;
                }
                self.x[0][i]
            }
            Kind::Wander => {
                let wave = 1.0 + p[1] * (std::f64::consts::TAU * now.t / p[2]).sin();
                let steps = (p[0] * wave / dt).max(0.0);
                let (whole, share) = (steps as usize, steps.fract());
                (1.0 - share) * self.ring.ago(whole)[i] + share * self.ring.ago(whole + 1)[i]
            }
            Kind::TwoPoles => {
                self.x[0][i] += dt * (tau - self.x[0][i]) / (p[0] + dt);
                let (first, second) = (self.x[0][i], &mut self.x[1][i]);
                if now.t < -2.0 {
                    *second = first;
                }
                *second += dt * (first - *second) / (p[1] + dt);
                *second
            }
            Kind::Average => {
                // The state is the running sum less the mean at the start.
                let width = ((2.0 * p[0] / dt).round() as usize).max(1);
                let (new, old) = (self.ring.ago(0)[i], self.ring.ago(width)[i]);
                self.x[0][i] += (new - old) / width as f64;
                self.x[0][i]
            }
            _ => {
                let (w, rate) = (1.0 / p[0], self.x[1][i]);
                let next = rate
                    + dt * (w * w * (tau - self.x[0][i]) - std::f64::consts::SQRT_2 * w * rate);
                self.x[1][i] = next;
                self.x[0][i] += dt * next;
                self.x[0][i]
            }
        }
    }

    /// Laws that no library has.
    fn odd(&mut self, tau: f64, i: usize, now: &Now) -> f64 {
        let p = self.p[i];
        if self.kind == Kind::Play {
            self.x[0][i] = self.x[0][i].clamp(tau - p[0], tau + p[0]);
            return self.x[0][i];
        }
        self.clock[i] -= now.dt;
        if self.clock[i] < 0.0 {
            self.x[0][i] = tau;
            if now.chance[i] < TICK / p[1] {
                self.clock[i] = p[0];
            }
        }
        self.x[0][i]
    }
}

//! Laws of faults that add a torque at one joint: `τ = level·s + smooth`.
//!
//! `s` is the bristle state of the joint, between −1 and 1: a sign that takes some angle to turn.

use crate::examine::worlds::model::{MAX, Row};

/// What a law may depend on, at one instant.
#[derive(Clone, Debug)]
pub(super) struct Now {
    /// Time of the log \[s\].
    pub(super) t: f64,
    /// Time within the period \[s\].
    pub(super) phase: f64,
    /// Step \[s\].
    pub(super) dt: f64,
    /// Angles of the motors \[rad\].
    pub(super) q: Row,
    /// Rates \[rad/s\].
    pub(super) v: Row,
    /// Accelerations, smoothed \[rad/s²\].
    pub(super) a: Row,
    /// Torques through the gears \[Nm\].
    pub(super) load: Row,
    /// Bristle states.
    pub(super) s: Row,
    /// Everyday factors of Coulomb friction.
    pub(super) dry: Row,
    /// Everyday factors of viscous friction.
    pub(super) wet: Row,
    /// Uniform random number of the 4 ms tick, by joint.
    pub(super) chance: Row,
}

/// Parameters of a law.
pub(super) type Parameters = [f64; 7];

/// A law at a joint.
#[derive(Clone, Debug)]
pub(super) struct Term {
    /// Joint from 0.
    pub(super) joint: usize,
    /// Its law.
    pub(super) law: Law,
    /// Its parameters; their meaning is given with the law as p0, p1, …
    pub(super) p: Parameters,
    /// Its states.
    pub(super) x: [f64; 3],
}

/// The laws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Law {
    /// Friction of the healthy gear, scaled: p0·dry·s + p1·wet·v.
    Wear,
    /// Dry friction that smooths out in the speed: p0·tanh(v/p2) + p1·v.
    Tanh,
    /// Level that grows with the logarithm of the speed: (p0 + p1·ln(1 + |v|/p2))·s.
    Logarithmic,
    /// A. Tustin 1947: p0·exp(−|v|/p1)·s.
    Tustin,
    /// D. Hess, A. Soom 1990: p0/(1 + (v/p1)²)·s.
    Lorentz,
    /// C. Makkar et al. 2005: p0·(tanh(v/p2) − tanh(v/p1)).
    Makkar,
    /// P. Carreau 1972, shear thinning: p0·v·(1 + (v/p1)²)^((p2 − 1)/2).
    Carreau,
    /// H. Eyring 1936: p0·asinh(v/p1).
    Eyring,
    /// Churning of oil above a speed: p0·max(|v| − p1, 0)²·s.
    Churning,
    /// p0·(√(v² + p1²) − p1): round at rest.
    RoundAsymmetry,
    /// p0·|v|^p1: another power in both directions.
    PowerAsymmetry,
    /// p0·(√(τ² + p1²) − p1)·s.
    RoundLoad,
    /// Hertzian contact: p0·|τ|^p1·s.
    HertzLoad,
    /// p0·p1·tanh(|τ|/p1)·s.
    FullLoad,
    /// |τ|·(p1 + (p0 − p1)/(1 + exp(−τ·v/p2)))·s: motoring p0, generating p1.
    BlendedEfficiency,
    /// |τ|·(p0 or p1)·(1 + p2/(|τ| + p2))·s: gears lose more at part load.
    PartLoad,
    /// (p0·s + p1·v)·(p4·exp(−t/p2) + (1 − p4)·exp(−t/p3)): grease, then housing.
    TwoStage,
    /// (p0·s + p1·v)/(1 + t/p2)².
    Hyperbolic,
    /// A temperature heated by the own motion: θ′ = (p3·|v| + 1 − θ)/p2, (p0·s + p1·v)·(1 − θ) from θ = 0.
    HeatBalance,
    /// R. von Mises' bump: p0·exp(p2·(cos(q − p1) − 1))·s.
    Mises,
    /// A rough half: p0·(1 + tanh((q − p1)/p2))·s.
    RoughHalf,
    /// Triangles over the angle: p0·(2/π)·asin(cos(p2·(q − p1)))·s.
    Triangle,
    /// p0·(cos(p2·q − p1) + p3·cos(2·p2·q − p4)).
    Harmonics,
    /// p0·cos(p2·q − p1)/(1 + (v/p3)²): washed out by speed.
    WashedRipple,
    /// p0·(p3·|τ| + 1)·cos(p2·q − p1): grows with the load.
    LoadedRipple,
    /// p0·(q − p1) with friction inside the hose: + p2·z, z′ = (v − |v|·z)/p3 (Dahl).
    HoseHysteresis,
    /// p0·(q − p1) + p2·(q − p1)³.
    Hardening,
    /// Taut only beyond p1 in the direction p2: p0·softplus.
    Slack,
    /// Crank of a balancer: p0·sin(q − p1)·(1 − p2/√(1 + p3² − 2·p3·cos(q − p1))).
    Crank,
    /// Gas spring on a crank: p0·sin(q − p1)·(1 − p2·cos(q − p1))^−1.3.
    Gas,
    /// p0·(1 − exp(−…)) between p1 and p2 with flanks of p3 s, ·s.
    Release,
    /// p0·(1 + p3·cos(p4·q))·s between p1 and p2.
    Judder,
    /// p0/(1 + |v|/p3)·s between p1 and p2.
    Fade,
    /// p0·(1 + p1·sin(p2·t + p3)).
    DriftingOffset,
    /// p0·s²: the offset of Coulomb friction that is not the same in both directions.
    SidedCoulomb,
    /// A disc of p0 kg m² behind a viscous coupling: p1·(v − w), p0·w′ = the same.
    Coupling,
    /// A disc of p0 kg m² behind a clutch that slips at p2 Nm.
    Clutch,
    /// Outside: p0·(1 + tanh((q_other − p2)/p3))·s, other joint p1.
    CrossFriction,
    /// Outside: p0·v_other·|v|/p2, other joint p1.
    CrossDrag,
    /// Outside: oscillator of p0 kg m², p1 rad/s, damping p2, driven by the joint's acceleration.
    Mode,
    /// Outside: p0·a³/p1³.
    CubedAcceleration,
    /// Outside: a broken tooth: p0·exp(−((q − p1 mod p3)/p2)²)·s.
    Tooth,
    /// Outside: friction p0·s that switches on and off, after p1 s in the mean.
    Telegraph,
    /// Outside: breakaway that grows with rest: x′ = 1/p1 at rest, falls with angle p2; p0·ln(1 + x)·s.
    Dwell,
}

/// Share of a window with soft flanks \[s\].
fn window(now: &Now, from: f64, to: f64, flank: f64) -> f64 {
    let up = ((now.phase - from) / flank).clamp(0.0, 1.0);
    let down = ((to - now.phase) / flank).clamp(0.0, 1.0);
    up.min(down)
}

/// Flank of windows whose law has none of its own \[s\].
const FLANK: f64 = 0.03;
/// Speed below which a joint rests \[rad/s\].
const REST: f64 = 0.005;
/// Step of the tick on which random switches are drawn \[s\].
pub(super) const TICK: f64 = 0.004;

impl Term {
    /// A law with parameters and states at 0.
    pub(super) fn new(joint: usize, law: Law, p: &[f64]) -> Self {
        let mut all = [0.0; 7];
        for (to, from) in all.iter_mut().zip(p) {
            *to = *from;
        }
        Self { joint, law, p: all, x: [0.0; 3] }
    }

    /// `(level, smooth)` \[Nm\]; steps the states.
    pub(super) fn at(&mut self, now: &Now) -> (f64, f64) {
        let i = self.joint.min(MAX - 1);
        let (v, s) = (now.v[i], now.s[i]);
        let p = &self.p;
        match self.law {
            Law::Wear => (p[0] * now.dry[i], p[1] * now.wet[i] * v),
            Law::Tanh => (0.0, p[0] * (v / p[2]).tanh() + p[1] * v),
            Law::Logarithmic => (p[0] + p[1] * (v.abs() / p[2]).ln_1p(), 0.0),
            Law::Tustin => (p[0] * (-v.abs() / p[1]).exp(), 0.0),
            Law::Lorentz => (p[0] / (1.0 + (v / p[1]).powi(2)), 0.0),
            Law::Makkar => (0.0, p[0] * ((v / p[2]).tanh() - (v / p[1]).tanh())),
            Law::Carreau => (0.0, p[0] * v * (1.0 + (v / p[1]).powi(2)).powf(0.5 * (p[2] - 1.0))),
            Law::Eyring => (0.0, p[0] * (v / p[1]).asinh()),
            Law::Churning => (p[0] * (v.abs() - p[1]).max(0.0).powi(2), 0.0),
            Law::RoundAsymmetry => (0.0, p[0] * ((v * v + p[1] * p[1]).sqrt() - p[1])),
            Law::PowerAsymmetry => (0.0, p[0] * v.abs().powf(p[1])),
            Law::RoundLoad
            | Law::HertzLoad
            | Law::FullLoad
            | Law::BlendedEfficiency
            | Law::PartLoad => (self.by_load(now.load[i], v), 0.0),
            Law::TwoStage | Law::Hyperbolic | Law::HeatBalance => {
                let left = self.cold(now, v);
                (self.p[0] * left, self.p[1] * v * left)
            }
            Law::Mises | Law::RoughHalf | Law::Triangle => (self.rough(now.q[i]), 0.0),
            Law::Release | Law::Judder | Law::Fade => (self.brake(now, i), 0.0),
            Law::DriftingOffset => (0.0, p[0] * (1.0 + p[1] * (p[2] * now.t + p[3]).sin())),
            Law::SidedCoulomb => (p[0] * s, 0.0),
            Law::Coupling | Law::Clutch => (0.0, self.disc(now, v)),
            Law::CrossFriction | Law::CrossDrag | Law::Tooth | Law::Telegraph | Law::Dwell => {
                self.odd_friction(now, i)
            }
            Law::Mode | Law::CubedAcceleration => (0.0, self.odd_inertia(now, i)),
            _ => (0.0, self.by_angle(now, i)),
        }
    }

    /// Loss by the torque through the gear.
    fn by_load(&self, load: f64, v: f64) -> f64 {
        let (p, size) = (&self.p, load.abs());
        match self.law {
            Law::RoundLoad => p[0] * (size.hypot(p[1]) - p[1]),
            Law::HertzLoad => p[0] * size.powf(p[1]),
            Law::FullLoad => p[0] * p[1] * (size / p[1]).tanh(),
            Law::PartLoad => {
                let share = if load * v > 0.0 { p[0] } else { p[1] };
                size * share * (1.0 + p[2] / (size + p[2]))
            }
            _ => size * (p[1] + (p[0] - p[1]) / (1.0 + (-load * v / p[2]).exp())),
        }
    }

    /// What is left of the cold share of friction.
    fn cold(&mut self, now: &Now, v: f64) -> f64 {
        let (p, t) = (&self.p, now.t.max(0.0));
        match self.law {
            Law::TwoStage => p[4] * (-t / p[2]).exp() + (1.0 - p[4]) * (-t / p[3]).exp(),
            Law::Hyperbolic => (1.0 + t / p[2]).powi(-2),
            _ => {
                if now.t > 0.0 {
                    let heat = p[3] * v.abs() + 1.0 - self.x[0];
                    self.x[0] = (self.x[0] + now.dt * heat / p[2]).min(1.0);
                }
                1.0 - self.x[0]
            }
        }
    }

    /// Friction over the angle.
    fn rough(&self, q: f64) -> f64 {
        let p = &self.p;
        match self.law {
            Law::Mises => p[0] * (p[2] * ((q - p[1]).cos() - 1.0)).exp(),
            Law::RoughHalf => p[0] * (1.0 + ((q - p[1]) / p[2]).tanh()),
            _ => p[0] * std::f64::consts::FRAC_2_PI * (p[2] * (q - p[1])).cos().asin(),
        }
    }

    /// Drag of a brake.
    fn brake(&self, now: &Now, i: usize) -> f64 {
        let p = &self.p;
        match self.law {
            Law::Release => {
                let w = window(now, p[1], p[2] + 3.0 * p[3], 3.0 * p[3]);
                p[0] * w * w * (3.0 - 2.0 * w)
            }
            Law::Judder => {
                p[0] * (1.0 + p[3] * (p[4] * now.q[i]).cos()) * window(now, p[1], p[2], FLANK)
            }
            _ => p[0] / (1.0 + now.v[i].abs() / p[3]) * window(now, p[1], p[2], FLANK),
        }
    }

    /// A disc behind a coupling.
    fn disc(&mut self, now: &Now, v: f64) -> f64 {
        let p = self.p;
        let slip = v - self.x[0];
        // Implicit in the disc's own speed: stable for every stiffness of the coupling.
        let mut torque = p[1] * slip / (1.0 + now.dt * p[1] / p[0]);
        if self.law == Law::Clutch {
            torque = torque.clamp(-p[2], p[2]);
        }
        self.x[0] += now.dt * torque / p[0];
        torque
    }

    /// Torques over the angle.
    fn by_angle(&mut self, now: &Now, i: usize) -> f64 {
        let p = self.p;
        let (q, v) = (now.q[i], now.v[i]);
        let d = q - p[1];
        match self.law {
            Law::Harmonics => {
                p[0] * ((p[2] * q - p[1]).cos() + p[3] * (2.0 * p[2] * q - p[4]).cos())
            }
            Law::WashedRipple => p[0] * (p[2] * q - p[1]).cos() / (1.0 + (v / p[3]).powi(2)),
            Law::LoadedRipple => p[0] * (1.0 + p[3] * now.load[i].abs()) * (p[2] * q - p[1]).cos(),
            Law::HoseHysteresis => {
                let step = now.dt / p[3];
                self.x[0] = (self.x[0] + step * v) / (1.0 + step * v.abs());
                p[0] * d + p[2] * self.x[0]
            }
            Law::Hardening => p[0] * d + p[2] * d * d * d,
            Law::Slack => p[2] * p[0] * soft(p[2] * d, p[3]),
            Law::Crank => {
                let length = (1.0 + p[3] * p[3] - 2.0 * p[3] * d.cos()).max(1e-6).sqrt();
                p[0] * d.sin() * (1.0 - p[2] / length)
            }
            _ => p[0] * d.sin() * (1.0 - p[2] * d.cos()).max(0.05).powf(-1.3),
        }
    }

    /// Frictions that no library has: `(level, smooth)`.
    fn odd_friction(&mut self, now: &Now, i: usize) -> (f64, f64) {
        let p = self.p;
        let other = (p[1] as usize).min(MAX - 1);
        match self.law {
            Law::CrossFriction => (p[0] * (1.0 + ((now.q[other] - p[2]) / p[3]).tanh()), 0.0),
            Law::CrossDrag => (0.0, p[0] * now.v[other] * now.v[i].abs() / p[2]),
            Law::Tooth => {
                let d = (now.q[i] - p[1] + 0.5 * p[3]).rem_euclid(p[3]) - 0.5 * p[3];
                (p[0] * (-(d / p[2]).powi(2)).exp(), 0.0)
            }
            Law::Telegraph => {
                if now.t > self.x[1] + TICK {
                    self.x[1] = now.t;
                    if now.chance[i] < TICK / p[1] {
                        self.x[0] = 1.0 - self.x[0];
                    }
                }
                (p[0] * self.x[0], 0.0)
            }
            _ => {
                let rate = if now.v[i].abs() < REST { 1.0 / p[1] } else { 0.0 };
                self.x[0] = (self.x[0] + now.dt * rate) / (1.0 + now.dt * now.v[i].abs() / p[2]);
                (p[0] * self.x[0].ln_1p(), 0.0)
            }
        }
    }

    /// Torques of acceleration that no library has.
    fn odd_inertia(&mut self, now: &Now, i: usize) -> f64 {
        let p = self.p;
        match self.law {
            Law::Mode => {
                let force = p[1] * p[1] * self.x[0] + 2.0 * p[2] * p[1] * self.x[1];
                self.x[1] -= now.dt * (force + now.a[i]);
                self.x[0] += now.dt * self.x[1];
                -p[0] * force
            }
            _ => p[0] * (now.a[i] / p[1]).clamp(-2.0, 2.0).powi(3),
        }
    }
}

/// A ramp that is round over a width.
fn soft(x: f64, width: f64) -> f64 {
    0.5 * (x + (x * x + width * width).sqrt())
}

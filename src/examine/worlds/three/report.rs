//! Faults of motors and of what the drive reports: from the torque at the motor to the logged one.

use super::law::{Memory, Now, Parameter, softplus};
use crate::examine::worlds::random::hashed;
use std::f64::consts::TAU;

/// A law of one motor.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReportLaw {
    /// Size: an error as a share, or a torque \[Nm\], or an inertia \[kg m²\]; grows with the fault.
    pub(super) size: f64,
    /// A second size, scaled with the first.
    pub(super) second: f64,
    /// Form.
    pub(super) form: ReportForm,
}

/// Forms; e is the size, x = |τ|/limit, w the rate.
#[derive(Clone, Copy, Debug)]
pub(super) enum ReportForm {
    /// Magnets warmer than believed: `τ(1 + e(0.9 + 0.2(1−exp(−t/time))))`.
    WarmMagnets { time: f64 },
    /// Part of the magnets weak: `τ(1 + e(1 + 0.2 cos(order q)))`.
    WeakPole { order: f64 },
    /// Frölich's curve of the flux: `τ/(1−b x)`, b = e/(1+e).
    Froelich { limit: f64 },
    /// `τ sqrt(1+((1+e)²−1)x⁴)`: current of the cross axis.
    CrossAxis { limit: f64 },
    /// `τ sqrt(1+((1+e)²−1)y²)`, y = (|w|−from)⁺/(most−from): weakening current in quadrature.
    Quadrature { from: f64, most: f64 },
    /// `τ(1+e softplus((|w|−from)/width)/softplus(most))`: soft start of the weakening.
    SoftWeakening { from: f64, most: f64, width: f64 },
    /// Torque while it moves only, the same both ways: `e tanh²(w/0.01)`, as asymmetric friction.
    Asymmetry,
    /// Sensor's zero that wanders: `e(1+0.15 sin(2π t/time))`.
    Zero { time: f64 },
    /// `−τ − dead tanh(τ/(2 dead))`: another phase order, with the inverter's dead time.
    PhaseOrder { dead: f64 },
    /// `−gain τ`: the current transformer is turned, of slightly another ratio.
    Turned { gain: f64 },
    /// Two waves of the gear: `e (cos(order q−phase) + 0.35 cos(2 order q−2 phase+1))`.
    Waves { order: f64, phase: f64 },
    /// A wave that grows with the load: `e (0.7+0.3 |L|/usual) cos(order q−phase)`.
    LoadedWave { order: f64, phase: f64, usual: f64 },
    /// `e ẅ₁ + b w`, the acceleration after a lag \[s\]: feedforward in the reported value.
    Feedforward { lag: f64 },
    /// `e (w − w₁)/lag + b w₁`: washed-out rate of a speed observer.
    Observer { lag: f64 },
    /// Outside: output of the controller is cut softly at a level \[Nm\] (the level is the size).
    Cut { level: f64 },
    /// Outside: the current sensor also sees another joint's motor: `e` times its torque.
    Crosstalk { other: usize },
    /// Outside: torque noise over a part of the angles only.
    Rattle { centre: f64, seed: u64 },
}

impl ReportLaw {
    /// The reported torque \[Nm\] of motor `i` for a torque.
    pub(super) fn reported(&self, torque: f64, i: usize, now: &Now, memory: &mut Memory) -> f64 {
        let e = self.size;
        let (w, q) = (now.v[i], now.q[i]);
        match self.form {
            ReportForm::WarmMagnets { time } => {
                torque * (1.0 + e * (0.9 + 0.2 * (1.0 - (-now.time / time).exp())))
            }
            ReportForm::WeakPole { order } => torque * (1.0 + e * (1.0 + 0.2 * (order * q).cos())),
            ReportForm::Froelich { limit } => {
                let x = (torque.abs() / limit).min(1.0);
                torque / (1.0 - e / (1.0 + e) * x)
            }
            ReportForm::CrossAxis { limit } => {
                let x = (torque.abs() / limit).min(1.0);
                torque * (1.0 + ((1.0 + e).powi(2) - 1.0) * x.powi(4)).max(0.01).sqrt()
            }
            ReportForm::Quadrature { from, most } => {
                let y = ((w.abs() - from) / (most - from)).max(0.0);
                torque * (1.0 + ((1.0 + e).powi(2) - 1.0) * y * y).max(0.01).sqrt()
            }
            ReportForm::SoftWeakening { from, most, width } => {
                torque
                    * (1.0
                        + e * softplus((w.abs() - from) / width) / softplus((most - from) / width))
            }
            ReportForm::Asymmetry => torque + e * (w / 0.01).tanh().powi(2),
            ReportForm::Zero { time } => torque + e * (1.0 + 0.15 * (TAU * now.time / time).sin()),
            ReportForm::PhaseOrder { dead } => -torque - dead * (0.5 * torque / dead).tanh(),
            ReportForm::Turned { gain } => -gain * torque,
            ReportForm::Waves { order, phase } => {
                let x = order * q - phase;
                torque + e * (x.cos() + 0.35 * (2.0 * x + 1.0).cos())
            }
            ReportForm::LoadedWave { order, phase, usual } => {
                torque + e * (0.7 + 0.3 * now.load[i].abs() / usual) * (order * q - phase).cos()
            }
            ReportForm::Feedforward { lag } => {
                let gain = 1.0 - (-now.dt / lag).exp();
                memory[0] += (now.a[i] - memory[0]) * gain;
                torque + e * memory[0] + self.second * w
            }
            ReportForm::Observer { lag } => {
                let gain = 1.0 - (-now.dt / lag).exp();
                memory[0] += (w - memory[0]) * gain;
                torque + e * (w - memory[0]) / lag + self.second * memory[0]
            }
            ReportForm::Cut { level } => {
                // The level falls as the fault grows; the corner has the order 8.
                let bound = level / e;
                torque / (1.0 + (torque / bound).powi(8)).powf(0.125)
            }
            ReportForm::Crosstalk { other } => torque + e * now.load[other],
            ReportForm::Rattle { centre, seed } => {
                let here = (4.0 * ((q - centre).cos() - 1.0)).exp();
                // Slots of 8 ms: wide band for every sampling rate.
                torque
                    + e * here * hashed(seed, (now.time / 0.008) as u64) * (w / 0.02).tanh().abs()
            }
        }
    }

    /// Its parameters by the library's names.
    pub(super) fn parameters(&self) -> Vec<Parameter> {
        let e = self.size;
        match self.form {
            ReportForm::WarmMagnets { .. } | ReportForm::WeakPole { .. } => {
                vec![("error", e, true)]
            }
            ReportForm::Froelich { .. } => vec![("error", e, true), ("exponent", 1.0, false)],
            ReportForm::CrossAxis { .. } => vec![("error", e, true), ("exponent", 4.0, false)],
            ReportForm::Quadrature { from, .. } | ReportForm::SoftWeakening { from, .. } => {
                vec![("error", e, true), ("velocity", from, false)]
            }
            ReportForm::Asymmetry | ReportForm::Zero { .. } => vec![("offset", e, true)],
            ReportForm::PhaseOrder { .. } | ReportForm::Turned { .. } => {
                vec![("flipped", 1.0, true)]
            }
            ReportForm::Waves { order, phase } => {
                let phase = phase.rem_euclid(TAU);
                vec![("amplitude", e, true), ("order", order, true), ("phase", phase, false)]
            }
            ReportForm::LoadedWave { order, phase, .. } => {
                let phase = phase.rem_euclid(TAU);
                vec![("amplitude", e, false), ("order", order, true), ("phase", phase, true)]
            }
            ReportForm::Feedforward { .. } => {
                vec![("inertia", e, true), ("viscous", self.second, true)]
            }
            ReportForm::Observer { .. } => {
                vec![("inertia", e, false), ("viscous", self.second, false)]
            }
            ReportForm::Cut { level } => vec![("level", level / e, false)],
            ReportForm::Crosstalk { .. } | ReportForm::Rattle { .. } => vec![("size", e, false)],
        }
    }
}

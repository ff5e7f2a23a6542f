//! Faults of friction and rotors, in motor coordinates.
//!
//! A law has up to two sizes (torques, or a distance) which grow with the fault, and a form.

use super::law::{Memory, Now, Parameter, sign, softplus, step, stop};
use crate::examine::worlds::random::hashed;
use std::f64::consts::FRAC_2_PI;

/// A law of one motor.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrictionLaw {
    /// Sizes: see the form.
    pub(super) sizes: [f64; 2],
    /// Form.
    pub(super) form: FrictionForm,
}

/// Forms; `sizes` are named a and b, the rate w, the load L, the rounded sign s.
#[derive(Clone, Copy, Debug)]
pub(super) enum FrictionForm {
    /// `a (m tanh(w/fast) + (1−m) tanh(w/slow)) + b w`: tanh mixture (C. Makkar et al., 2005).
    Mixture { fast: f64, slow: f64, mix: f64 },
    /// `a z + b w/(1+|w|/knee)^0.4`, z a stop of the distance: shear-thinning grease.
    Grease { knee: f64, distance: f64 },
    /// `a s/(1+(|w|/speed)^power)` (D. Hess, A. Soom, J. Tribology 112, 1990).
    Rational { speed: f64, power: f64 },
    /// `a (tanh(w/fast) − tanh(w/slow))` (C. Makkar et al., AIM 2005).
    Makkar { fast: f64, slow: f64 },
    /// `a w/(1+(w/knee)²)^power`: Carreau fluid.
    Carreau { knee: f64, power: f64 },
    /// `a asinh(w/knee)`: Eyring fluid.
    Eyring { knee: f64 },
    /// `a softplus((|w|−from)/width) s`: churning above a rate.
    Churning { from: f64, width: f64 },
    /// `a w tanh(w/speed)`.
    Asymmetric { speed: f64 },
    /// `2a w⁺/(1+w⁺/knee)^0.3`: a seal that drags forwards only.
    OneWay { knee: f64 },
    /// `a |L| s (1 + share/(1+(|w|/speed)²))` (P. Hamon et al., 2010, with boundary lubrication).
    LoadBoundary { share: f64, speed: f64 },
    /// `a ref (|L|/ref)^power s`: Hertz contact of rolling bodies.
    LoadHertz { reference: f64, power: f64 },
    /// `(b + (a−b) σ(L w/width)) |L| s`: smooth change between driving and driven.
    Efficiency { width: f64 },
    /// The same with a hard change, larger at low rates: `(1 + 0.4/(1+|w|/speed))`.
    Mesh { speed: f64 },
    /// `(a s + b w)·(e^{−κθ}−e^{−κ})/(1−e^{−κ})`, θ̇ = (1−θ)/time, faster when the joint runs.
    Thermal { time: f64, kappa: f64, speed: f64 },
    /// `(a s + b w)/(1+t/time)^1.5`: conduction into a large housing.
    Housing { time: f64 },
    /// `a exp(κ(cos(q−phase)−1)) s`: a tight place (von Mises).
    TightSpot { phase: f64, kappa: f64 },
    /// Triangular wave over the turn, a its amplitude.
    Triangle { phase: f64 },
    /// `coulomb (mean z − s)`, three stops of the distances a/2, a, 2a (F. Al-Bender et al., GMS, 2005).
    MaxwellSlip { coulomb: f64 },
    /// `coulomb ((1+β) z₁ − β z₂ − s)`, distances a and 5a (P.-A. Bliman, M. Sorine, 1995).
    Bliman { coulomb: f64, beta: f64 },
    /// Disc with runout: `a (1+0.25 cos(order q−phase)) tanh(w/0.02)`.
    Disc { order: f64, phase: f64 },
    /// Lining that glazes: `a (0.8 + 0.45/(1+|w|/speed)) s`.
    Lining { speed: f64 },
    /// `a ẇ + b sin(order q + phase)`: another rotor with a little unbalance.
    Unbalance { order: f64, phase: f64 },
    /// a times the acceleration after a lag \[s\]: a disc on a soft coupling.
    SoftDisc { lag: f64 },
    /// Outside: friction depends on another joint's angle: `a (½+½tanh(3cos(q_o−phase))) s`.
    OtherAngle { other: usize, phase: f64 },
    /// Outside: friction jumps between two levels at random, slots of a length \[s\].
    Switching { slot: f64, seed: u64 },
    /// Outside: `a (ẇ/reference)³`, at most for 1.6 times the reference.
    CubedAcceleration { reference: f64 },
    /// Outside: `a w w_o/reference²`: a spinning tool's gyroscopic torque.
    Gyroscope { other: usize, reference: f64 },
}

impl FrictionLaw {
    /// Torque \[Nm\] that motor `i` needs more; `phase` counts from the window's start.
    pub(super) fn torque(&self, i: usize, now: &Now, memory: &mut Memory) -> f64 {
        let [a, b] = self.sizes;
        let (w, q, load) = (now.v[i], now.q[i], now.load[i]);
        let s = sign(w);
        match self.form {
            FrictionForm::Mixture { fast, slow, mix } => {
                a * (mix * (w / fast).tanh() + (1.0 - mix) * (w / slow).tanh()) + b * w
            }
            FrictionForm::Grease { knee, distance } => {
                memory[0] = stop(memory[0], w * now.dt / distance);
                a * memory[0] + b * w / (1.0 + w.abs() / knee).powf(0.4)
            }
            FrictionForm::Rational { speed, power } => {
                a * s / (1.0 + (w.abs() / speed).powf(power))
            }
            FrictionForm::Makkar { fast, slow } => a * ((w / fast).tanh() - (w / slow).tanh()),
            FrictionForm::Carreau { knee, power } => a * w / (1.0 + (w / knee).powi(2)).powf(power),
            FrictionForm::Eyring { knee } => a * (w / knee).asinh(),
            FrictionForm::Churning { from, width } => a * softplus((w.abs() - from) / width) * s,
            FrictionForm::Asymmetric { speed } => a * w * (w / speed).tanh(),
            FrictionForm::OneWay { knee } => {
                let forwards = w.max(0.0);
                2.0 * a * forwards / (1.0 + forwards / knee).powf(0.3)
            }
            FrictionForm::LoadBoundary { share, speed } => {
                a * load.abs() * s * (1.0 + share / (1.0 + (w / speed).powi(2)))
            }
            FrictionForm::LoadHertz { reference, power } => {
                a * reference * (load.abs() / reference).powf(power) * s
            }
            FrictionForm::Efficiency { width } => {
                (b + (a - b) * step(load * w / width)) * load.abs() * s
            }
            FrictionForm::Mesh { speed } => {
                let share = if load * w > 0.0 { a } else { b };
                share * (1.0 + 0.4 / (1.0 + w.abs() / speed)) * load.abs() * s
            }
            FrictionForm::Thermal { time, kappa, speed } => {
                let heating = 0.4 + 0.6 * (w.abs() / speed).min(1.0);
                memory[0] += (1.0 - memory[0]) * heating * now.dt / time;
                let factor = ((-kappa * memory[0]).exp() - (-kappa).exp()) / (1.0 - (-kappa).exp());
                (a * s + b * w) * factor
            }
            FrictionForm::Housing { time } => (a * s + b * w) / (1.0 + now.time / time).powf(1.5),
            _ => self.further(i, now, memory, [w, q, s]),
        }
    }

    /// The other half of the forms; `of` is rate, angle and sign.
    fn further(&self, i: usize, now: &Now, memory: &mut Memory, of: [f64; 3]) -> f64 {
        let [a, b] = self.sizes;
        let [w, q, s] = of;
        match self.form {
            FrictionForm::TightSpot { phase, kappa } => {
                a * (kappa * ((q - phase).cos() - 1.0)).exp() * s
            }
            FrictionForm::Triangle { phase } => {
                a * FRAC_2_PI * (0.999 * (q - phase).cos()).asin() * s
            }
            FrictionForm::MaxwellSlip { coulomb } => {
                let mut sum = 0.0;
                for (state, factor) in memory.iter_mut().zip([0.5, 1.0, 2.0]) {
                    *state = stop(*state, w * now.dt / (a * factor));
                    sum += *state / 3.0;
                }
                coulomb * (sum - s)
            }
            FrictionForm::Bliman { coulomb, beta } => {
                for (state, factor) in memory.iter_mut().zip([1.0, 5.0]) {
                    // Exact over the step: z goes to the sign of the rate with e^{−|Δq|/distance}.
                    let keep = (-w.abs() * now.dt / (a * factor)).exp();
                    *state = w.signum() + (*state - w.signum()) * keep;
                }
                coulomb * ((1.0 + beta) * memory[0] - beta * memory[1] - s)
            }
            FrictionForm::Disc { order, phase } => {
                a * (1.0 + 0.25 * (order * q - phase).cos()) * (w / 0.02).tanh()
            }
            FrictionForm::Lining { speed } => a * (0.8 + 0.45 / (1.0 + w.abs() / speed)) * s,
            FrictionForm::Unbalance { order, phase } => {
                a * now.a[i] + b * (order * q + phase).sin()
            }
            FrictionForm::SoftDisc { lag } => {
                memory[0] += (now.a[i] - memory[0]) * (1.0 - (-now.dt / lag).exp());
                a * memory[0]
            }
            FrictionForm::OtherAngle { other, phase } => {
                a * (0.5 + 0.5 * (3.0 * (now.q[other] - phase).cos()).tanh()) * s
            }
            FrictionForm::Switching { slot, seed } => {
                let on = hashed(seed, (now.time / slot) as u64) > 0.0;
                if on { a * s } else { 0.0 }
            }
            FrictionForm::CubedAcceleration { reference } => {
                a * (now.a[i] / reference).clamp(-1.6, 1.6).powi(3)
            }
            FrictionForm::Gyroscope { other, reference } => {
                a * w * now.v[other] / (reference * reference)
            }
            _ => 0.0,
        }
    }

    /// Its parameters by the library's names.
    pub(super) fn parameters(&self) -> Vec<Parameter> {
        let [a, b] = self.sizes;
        match self.form {
            FrictionForm::Mixture { .. } => vec![("coulomb", a, true), ("viscous", b, true)],
            FrictionForm::Grease { .. } => vec![("coulomb", a, true), ("viscous", b, false)],
            FrictionForm::Rational { speed, power } => {
                // The speed at which 1/e is left: (speed_e/speed)^power = e − 1.
                let third = speed * (std::f64::consts::E - 1.0).powf(1.0 / power);
                vec![("stiction", a, true), ("velocity", third, true)]
            }
            FrictionForm::Makkar { slow, .. } => {
                vec![("stiction", a, false), ("velocity", slow, false)]
            }
            FrictionForm::Carreau { power, .. } => {
                vec![("coefficient", a, false), ("exponent", 1.0 - 2.0 * power, false)]
            }
            FrictionForm::Eyring { knee } => {
                vec![("coefficient", a * (1.0 / knee).asinh(), false), ("exponent", 0.4, false)]
            }
            FrictionForm::Churning { .. } => {
                vec![("coefficient", a, false), ("exponent", 2.0, false)]
            }
            FrictionForm::Asymmetric { .. } => vec![("asymmetry", a, true)],
            FrictionForm::OneWay { .. } => vec![("asymmetry", a, false)],
            FrictionForm::LoadBoundary { .. } => vec![("mu", a, true)],
            FrictionForm::LoadHertz { .. } => vec![("mu", a, false)],
            FrictionForm::Efficiency { .. } => vec![("motoring", a, true), ("generating", b, true)],
            FrictionForm::Mesh { .. } => vec![("motoring", a, false), ("generating", b, false)],
            FrictionForm::Thermal { time, .. } | FrictionForm::Housing { time } => {
                vec![("coulomb", a, true), ("viscous", b, true), ("time_constant", time, false)]
            }
            FrictionForm::TightSpot { phase, kappa } => {
                let half = 0.5 * a * (1.0 - (-2.0 * kappa).exp());
                vec![("amplitude", half, false), ("phase", phase, true)]
            }
            FrictionForm::Triangle { phase } => {
                vec![("amplitude", a, true), ("phase", phase, true)]
            }
            FrictionForm::MaxwellSlip { .. } | FrictionForm::Bliman { .. } => {
                vec![("distance", a, false)]
            }
            FrictionForm::Disc { .. } => vec![("drag", a, true)],
            FrictionForm::Lining { .. } => vec![("drag", a, false)],
            FrictionForm::Unbalance { .. } => vec![("inertia", a, true)],
            FrictionForm::SoftDisc { .. } => vec![("inertia", a, false)],
            FrictionForm::OtherAngle { .. }
            | FrictionForm::Switching { .. }
            | FrictionForm::CubedAcceleration { .. }
            | FrictionForm::Gyroscope { .. } => vec![("size", a, false)],
        }
    }
}

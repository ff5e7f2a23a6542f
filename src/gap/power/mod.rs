//! Electrical power: what a robot takes now against what it took when the model was believed.
//!
//! Power has no nominal model, so a reference is fitted to the baseline: base power, losses of each joint
//! and of the drives, the share of braking power that is given back, and the lag of the meter,
//! `P = L·(base + g(S)·S)`, `S = Σ τ q̇ + Σ k τ² + c Σ |τ q̇|`; `g` differs with the sign of `S`.

mod cause;
mod reference;
mod weighing;

use crate::arm::effects::Effect;
use crate::arm::robot::Model;

use super::decision::Estimated;
use cause::{Cause, causes};
use reference::Reference;
use weighing::Weighing;

/// Share of the difference that the effects have to explain.
const EXPLAINS: f64 = 0.7;
/// Rate below which a joint rests \[rad/s\].
const REST: f64 = 0.02;

/// Mean power of a motion that repeats, or of a log.
#[derive(Clone, Debug)]
pub struct Powers {
    /// Time from row to row \[s\].
    pub step: f64,
    /// Whether the motion repeats.
    pub closed: bool,
    /// Rates by joint \[rad/s\].
    pub qd: Vec<Vec<f64>>,
    /// Measured torques by joint \[Nm\].
    pub tau: Vec<Vec<f64>>,
    /// Measured power \[W\].
    pub power: Vec<f64>,
}

impl Powers {
    fn rows(&self) -> usize {
        self.power.len()
    }

    fn mechanical(&self, row: usize) -> f64 {
        self.qd.iter().zip(&self.tau).map(|(qd, tau)| qd[row] * tau[row]).sum()
    }

    /// What passes through the drives of the joints.
    fn through(&self, row: usize) -> f64 {
        self.qd.iter().zip(&self.tau).map(|(qd, tau)| (qd[row] * tau[row]).abs()).sum()
    }

    /// Values as a meter of first order shows them, with a time constant \[s\].
    fn lagged(&self, mut x: Vec<f64>, lag: f64) -> Vec<f64> {
        if lag <= 0.0 {
            return x;
        }
        let kept = (-self.step / lag).exp();
        // A motion that repeats has been running before.
        let before = if self.closed { x.len() } else { 0 };
        let mut shown = x.first().copied().unwrap_or(0.0);
        for row in 0..before {
            shown = x[row] + (shown - x[row]) * kept;
        }
        for x in &mut x {
            shown = *x + (shown - *x) * kept;
            *x = shown;
        }
        x
    }

    /// Share of the joints that move or did so at most `timeout` \[s\] ago. Joints are taken for ready at the
    /// beginning of a log.
    fn released(&self, timeout: f64) -> Vec<f64> {
        let rows = self.rows();
        let mut share = vec![0.0; rows];
        for qd in &self.qd {
            let mut idle = 0.0;
            for round in 0..if self.closed { 2 } else { 1 } {
                for (row, qd) in qd.iter().enumerate() {
                    idle = if qd.abs() > REST { 0.0 } else { idle + self.step };
                    if (round == 1 || !self.closed) && idle <= timeout {
                        share[row] += 1.0 / self.qd.len() as f64;
                    }
                }
            }
        }
        share
    }
}

/// What was found of the power.
#[derive(Clone)]
pub struct PowerFound {
    /// The effects, the strongest first.
    pub effects: Vec<PowerEffect>,
    /// Whether there is a difference that no known effect explains.
    pub is_unknown: bool,
    /// Rms on the held-out data, noise taken off: noise, reference, with the effect \[W\].
    pub gap: [f64; 3],
}

/// An effect of the power.
#[derive(Clone)]
pub struct PowerEffect {
    /// The effect.
    pub effect: &'static Effect,
    /// Joint, from 0.
    pub joint: Option<usize>,
    /// Ids that cannot be told apart.
    pub class: Vec<&'static str>,
    /// Its parameter, where it has one.
    pub parameters: Vec<Estimated>,
    /// Logarithm of the odds.
    pub nats: f64,
}

/// Which effects separate the power now from that of the baseline. `None` where the baseline
/// tells no reference.
#[must_use]
pub fn diagnose_power(
    model: &Model,
    baseline: &[Powers],
    train: &[Powers],
    held: &[Powers],
    may: &dyn Fn(&str) -> bool,
) -> Option<PowerFound> {
    let reference = Reference::new(model, baseline)?;
    let causes = causes(&reference, may);
    let weighing = Weighing::new(&reference, &causes, train)?;
    let chosen = weighing.forward();
    let [none, found] = [&[][..], &chosen].map(|of| weighing.fit(of));
    let (none, found) = (none?, found?);
    let noise = weighing.variance;
    let explained = (none.left - found.left) / (none.left - noise).max(noise);
    let is_unknown = !chosen.is_empty() && explained < EXPLAINS;
    let told = if is_unknown { &[][..] } else { &chosen };
    let effects = told.iter().map(|k| weighing.effect(&chosen, *k)).collect::<Option<Vec<_>>>()?;
    let best = if is_unknown { &none } else { &found };
    let added: Vec<(&Cause<'_>, f64)> =
        told.iter().zip(&best.values).map(|(k, value)| (&causes[*k], *value)).collect();
    let rms = |mean: f64| (mean - reference.variance).max(0.0).sqrt();
    let before = left(&reference, held, &[]);
    let after = left(&reference.moved(&(&reference.root * &best.moved)), held, &added);
    let gap = [reference.variance.sqrt(), rms(before), rms(after)];
    Some(PowerFound { effects, is_unknown, gap })
}

/// Mean square that is missed with causes \[W²\].
fn left(reference: &Reference, logs: &[Powers], added: &[(&Cause<'_>, f64)]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for log in logs {
        let mut missed = reference.missed(log);
        for (cause, value) in added {
            missed.iter_mut().zip(cause.of(log)).for_each(|(missed, x)| *missed -= value * x);
        }
        sum += squares(&missed);
        count += missed.len() as f64;
    }
    sum / count.max(1.0)
}

fn squares(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum()
}

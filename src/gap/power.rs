//! Electrical power: what a robot takes now against what it took when the model was believed.
//!
//! Power has no nominal model, so a reference is fitted to the baseline: base power and the
//! losses of each joint, P = base + g·(Σ τ q̇ + Σ k τ²), g = 1, or what is given back where the
//! sum is negative.

use nalgebra::{DMatrix, DVector};

use crate::effects::{Effect, find};
use crate::robot::Model;

use super::diagnosis::Estimated;

/// What an effect has to bring \[nats\].
const LEAST_NATS: f64 = 25.0;
/// Odds below which two explanations cannot be told apart: 1 to 100.
const CLASS: f64 = 4.6;
/// Share of the difference that an effect has to explain.
const EXPLAINS: f64 = 0.7;
/// Effects that are the same while a robot moves.
const CONSTANT: [&str; 2] = ["base_load", "brake_power"];

/// Mean power of a motion that repeats, or of a log.
#[derive(Clone, Debug)]
pub struct Powers {
    /// Rates by joint \[rad/s\].
    pub qd: Vec<Vec<f64>>,
    /// Measured torques by joint \[Nm\].
    pub tau: Vec<Vec<f64>>,
    /// Measured power \[W\].
    pub power: Vec<f64>,
}

impl Powers {
    fn len(&self) -> usize {
        self.power.len()
    }

    fn mechanical(&self, row: usize) -> f64 {
        self.qd.iter().zip(&self.tau).map(|(qd, tau)| qd[row] * tau[row]).sum()
    }
}

/// What was found of the power.
#[derive(Clone)]
pub struct PowerFound {
    /// The effect, if there is one.
    pub effect: Option<PowerEffect>,
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

/// Reference of the baseline.
struct Reference {
    base: f64,
    loss: Vec<f64>,
    given_back: f64,
    variance: f64,
    /// Independent samples per row.
    independent: f64,
}

impl Reference {
    fn new(model: &Model, logs: &[Powers]) -> Option<Reference> {
        let n = model.dof;
        let given_back = model.drive.regeneration;
        let nominal: Vec<f64> = model
            .motors
            .as_ref()
            .map_or_else(|| vec![0.0; n], |motors| motors.loss_constant.clone());
        let mut reference =
            Reference { base: 0.0, loss: nominal, given_back, variance: 0.0, independent: 1.0 };
        let rows: Vec<(&Powers, usize)> =
            logs.iter().flat_map(|log| (0..log.len()).map(move |row| (log, row))).collect();
        if rows.len() < 10 * (n + 1) {
            return None;
        }
        // The sign of the sum depends on the losses: twice.
        for _ in 0..2 {
            let mut x = DMatrix::zeros(rows.len(), n + 1);
            let mut y = DVector::zeros(rows.len());
            for (i, (log, row)) in rows.iter().enumerate() {
                let share = reference.share(log, *row);
                x[(i, 0)] = 1.0;
                for joint in 0..n {
                    x[(i, 1 + joint)] = share * log.tau[joint][*row].powi(2);
                }
                y[i] = log.power[*row] - share * log.mechanical(*row);
            }
            let scale: Vec<f64> = (0..=n).map(|k| x.column(k).norm().max(1e-12)).collect();
            for (k, scale) in scale.iter().enumerate() {
                x.column_mut(k).unscale_mut(*scale);
            }
            let solution = x.clone().svd(true, true).solve(&y, 1e-10).ok()?;
            let left = &y - &x * &solution;
            reference.base = solution[0] / scale[0];
            reference.loss = (0..n).map(|k| solution[1 + k] / scale[1 + k]).collect();
            reference.variance = left.norm_squared() / (rows.len() - n - 1) as f64;
            let memory = left.as_slice().windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>()
                / left.norm_squared().max(1e-12);
            let memory = memory.clamp(0.0, 0.98);
            reference.independent = (1.0 - memory) / (1.0 + memory);
        }
        Some(reference)
    }

    fn sum(&self, log: &Powers, row: usize) -> f64 {
        let losses = self.loss.iter().zip(&log.tau).map(|(k, tau)| k * tau[row] * tau[row]);
        log.mechanical(row) + losses.sum::<f64>()
    }

    fn share(&self, log: &Powers, row: usize) -> f64 {
        if self.sum(log, row) < 0.0 { self.given_back } else { 1.0 }
    }

    fn missed(&self, log: &Powers, row: usize) -> f64 {
        log.power[row] - self.base - self.share(log, row) * self.sum(log, row)
    }
}

/// A possible cause: its column.
struct Cause {
    id: &'static str,
    joint: Option<usize>,
    column: fn(&Reference, &Powers, usize, usize) -> f64,
}

fn causes(dof: usize, given_back: f64) -> Vec<Cause> {
    let mut all = vec![
        Cause { id: "base_load", joint: None, column: |_, _, _, _| 1.0 },
        // What hangs on the link of the drives takes what joints give back.
        Cause { id: "base_load", joint: None, column: |of, log, _, row| of.share(log, row) },
    ];
    if given_back > 0.0 {
        all.push(Cause {
            id: "no_regeneration",
            joint: None,
            column: |of, log, _, row| -of.given_back * of.sum(log, row).min(0.0),
        });
    }
    for joint in 0..dof {
        all.push(Cause {
            id: "copper_loss",
            joint: Some(joint),
            column: |of, log, j, row| of.share(log, row) * log.tau[j][row].powi(2),
        });
        all.push(Cause {
            id: "inverter_loss",
            joint: Some(joint),
            column: |of, log, j, row| of.share(log, row) * log.tau[j][row].abs(),
        });
        all.push(Cause {
            id: "iron_loss",
            joint: Some(joint),
            column: |of, log, j, row| of.share(log, row) * log.qd[j][row].powi(2),
        });
    }
    all
}

/// Which effect separates the power now from that of the baseline. `None` where the baseline
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
    let missed: Vec<f64> =
        train.iter().flat_map(|log| (0..log.len()).map(|row| reference.missed(log, row))).collect();
    if missed.is_empty() {
        return None;
    }
    let all: f64 = missed.iter().map(|x| x * x).sum();
    let weight = 0.5 * reference.independent / reference.variance.max(1e-12);
    let mut found: Vec<(f64, f64, f64, Cause)> = Vec::new();
    for cause in causes(model.dof, reference.given_back).into_iter().filter(|of| may(of.id)) {
        let joint = cause.joint.unwrap_or(0);
        let (mut xx, mut xy) = (0.0, 0.0);
        let rows = train.iter().flat_map(|log| (0..log.len()).map(move |row| (log, row)));
        for ((log, row), y) in rows.zip(&missed) {
            let x = (cause.column)(&reference, log, joint, row);
            xx += x * x;
            xy += x * y;
        }
        // Every cause takes more power.
        if xx > 0.0 && xy > 0.0 {
            let value = xy / xx;
            let sd = (reference.variance / reference.independent / xx).sqrt();
            found.push((weight * xy * xy / xx, value, sd, cause));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let noise = reference.variance * missed.len() as f64;
    let mut result = PowerFound { effect: None, is_unknown: false, gap: [0.0; 3] };
    let mut added: Option<(f64, &Cause)> = None;
    if let Some((nats, value, sd, cause)) = found.first()
        && *nats > LEAST_NATS
    {
        let explained = nats / weight;
        if explained < EXPLAINS * (all - noise) {
            result.is_unknown = true;
        } else {
            let mut class: Vec<&'static str> = Vec::new();
            for (_, _, _, other) in found.iter().filter(|(other, ..)| nats - other < CLASS) {
                let same =
                    if CONSTANT.contains(&other.id) { &CONSTANT[..] } else { &[other.id][..] };
                for id in same {
                    if !class.contains(id) {
                        class.push(id);
                    }
                }
            }
            let effect = find(cause.id)?;
            let parameters = effect.parameters.iter().map(|parameter| Estimated {
                name: parameter.name.to_owned(),
                value: *value,
                sd: *sd,
                unit: parameter.unit,
            });
            result.effect = Some(PowerEffect {
                effect,
                joint: cause.joint,
                class,
                parameters: parameters.collect(),
                nats: *nats,
            });
            added = Some((*value, cause));
        }
    }
    let (mut before, mut after, mut count) = (0.0, 0.0, 0.0_f64);
    for log in held {
        for row in 0..log.len() {
            let missed = reference.missed(log, row);
            let more = added.map_or(0.0, |(value, cause)| {
                value * (cause.column)(&reference, log, cause.joint.unwrap_or(0), row)
            });
            before += missed * missed;
            after += (missed - more).powi(2);
            count += 1.0;
        }
    }
    let rms = |sum: f64| (sum / count.max(1.0) - reference.variance).max(0.0).sqrt();
    result.gap = [reference.variance.sqrt(), rms(before), rms(after)];
    Some(result)
}

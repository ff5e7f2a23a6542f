//! Electrical power: what a robot takes now against what it took when the model was believed.
//!
//! Power has no nominal model, so a reference is fitted to the baseline: base power and the
//! losses of each joint, P = base + g·(Σ τ q̇ + Σ k τ²), g = 1, or what is given back where the
//! sum is negative.

use std::collections::BTreeSet;

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::arm::effects::{Effect, find};
use crate::arm::robot::Model;

use super::decision::Estimated;
use super::posterior::Evidence;

/// What an effect has to bring \[nats\].
const LEAST_NATS: f64 = 25.0;
/// Odds below which two explanations cannot be told apart: 1 to 100.
const CLASS: f64 = 4.6;
/// Share of the difference that the effects have to explain.
const EXPLAINS: f64 = 0.7;
/// What is told of the losses of a joint that takes no load, of those that do.
const TOLD: f64 = 1e-6;
/// Effects that are named together at most.
const MOST: usize = 2;
/// The reference's own error, of the power: its losses are not all that there are.
const ERROR: f64 = 0.005;
/// The least that an effect is there for, of the power.
const LEAST_SIZE: f64 = 0.01;
/// What an effect changes before anything is measured, of the power.
const PRIOR: f64 = 0.1;
/// Rate below which a joint rests \[rad/s\].
const REST: f64 = 0.02;
/// Effects that are the same while a robot moves: a constant may be either.
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

    /// Share of the joints that move.
    fn moving(&self, row: usize) -> f64 {
        let moving = self.qd.iter().filter(|qd| qd[row].abs() > REST).count();
        moving as f64 / self.qd.len().max(1) as f64
    }

    fn mechanical(&self, row: usize) -> f64 {
        self.qd.iter().zip(&self.tau).map(|(qd, tau)| qd[row] * tau[row]).sum()
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

/// Reference of the baseline.
struct Reference {
    base: f64,
    loss: Vec<f64>,
    given_back: f64,
    variance: f64,
    /// Independent samples per row.
    independent: f64,
    /// A root of the covariance of base and losses.
    root: DMatrix<f64>,
}

impl Reference {
    fn new(model: &Model, logs: &[Powers]) -> Option<Reference> {
        let n = model.dof;
        let given_back = model.drive.regeneration;
        let nominal: Vec<f64> = model
            .motors
            .as_ref()
            .map_or_else(|| vec![0.0; n], |motors| motors.loss_constant.clone());
        let mut reference = Reference {
            base: 0.0,
            loss: nominal,
            given_back,
            variance: 0.0,
            independent: 1.0,
            root: DMatrix::zeros(n + 1, n + 1),
        };
        let rows: Vec<(&Powers, usize)> = rows(logs).collect();
        if rows.len() < 10 * (n + 1) {
            return None;
        }
        // The sign of the sum depends on the losses: twice.
        for _ in 0..2 {
            let mut x = DMatrix::zeros(rows.len(), n + 1);
            let mut y = DVector::zeros(rows.len());
            for (i, (log, row)) in rows.iter().enumerate() {
                x.row_mut(i).tr_copy_from(&reference.columns(log, *row));
                y[i] = log.power[*row] - reference.share(log, *row) * log.mechanical(*row);
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
            // Loads that never vary tell nothing of their losses.
            let ridge = DMatrix::identity(n + 1, n + 1) * TOLD;
            let inverse = Cholesky::new(x.tr_mul(&x) + ridge)?.inverse();
            reference.root = Cholesky::new(inverse)?.l();
            for (k, scale) in scale.iter().enumerate() {
                let sd = (reference.variance / reference.independent).sqrt() / scale;
                reference.root.row_mut(k).scale_mut(sd);
            }
        }
        Some(reference)
    }

    /// What base and losses are multiplied by.
    fn columns(&self, log: &Powers, row: usize) -> DVector<f64> {
        let share = self.share(log, row);
        let square = |joint: usize| share * log.tau[joint][row].powi(2);
        DVector::from_fn(log.tau.len() + 1, |k, _| if k == 0 { 1.0 } else { square(k - 1) })
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

    /// Mean square that is missed without causes and with them \[W²\].
    fn left(&self, logs: &[Powers], added: &[(&Cause, f64)]) -> [f64; 2] {
        let (mut before, mut after, mut count) = (0.0, 0.0, 0.0_f64);
        for (log, row) in rows(logs) {
            let missed = self.missed(log, row);
            let more = added.iter().map(|(cause, value)| value * cause.of(self, log, row));
            before += missed * missed;
            after += (missed - more.sum::<f64>()).powi(2);
            count += 1.0;
        }
        [before, after].map(|sum| sum / count.max(1.0))
    }
}

/// A possible cause: its column.
struct Cause {
    effect: &'static Effect,
    joint: Option<usize>,
    /// The least that its value can be: what there is may go.
    least: f64,
    column: fn(&Reference, &Powers, usize, usize) -> f64,
}

impl Cause {
    fn of(&self, reference: &Reference, log: &Powers, row: usize) -> f64 {
        (self.column)(reference, log, self.joint.unwrap_or(0), row)
    }
}

fn causes(reference: &Reference, may: &dyn Fn(&str) -> bool) -> Vec<Cause> {
    type Column = fn(&Reference, &Powers, usize, usize) -> f64;
    let mut all: Vec<(&str, Option<usize>, f64, Column)> = vec![
        ("base_load", None, -reference.base, |_, _, _, _| 1.0),
        // What hangs on the link of the drives takes what joints give back.
        ("base_load", None, -reference.base, |of, log, _, row| of.share(log, row)),
        // Brakes of single axes, or of all together, are held open while these move.
        ("brake_power", None, -reference.base, |_, log, _, row| log.moving(row)),
        ("brake_power", None, -reference.base, |_, log, _, row| log.moving(row).ceil()),
    ];
    if reference.given_back > 0.0 {
        let kept: Column = |of, log, _, row| -of.given_back * of.sum(log, row).min(0.0);
        all.push(("no_regeneration", None, 0.0, kept));
    }
    for (joint, loss) in reference.loss.iter().enumerate() {
        let losses: [(&str, f64, Column); 3] = [
            ("copper_loss", -loss, |of, log, j, row| of.share(log, row) * log.tau[j][row].powi(2)),
            ("inverter_loss", 0.0, |of, log, j, row| of.share(log, row) * log.tau[j][row].abs()),
            ("iron_loss", 0.0, |of, log, j, row| of.share(log, row) * log.qd[j][row].powi(2)),
        ];
        all.extend(losses.map(|(id, least, column)| (id, Some(joint), least, column)));
    }
    let all = all.into_iter().filter(|(id, ..)| may(id));
    let cause =
        |(id, joint, least, column)| Some(Cause { effect: find(id)?, joint, least, column });
    all.filter_map(cause).collect()
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
    let values = weighing.evidence.estimate(&chosen)?;
    let added: Vec<(&Cause, f64)> =
        chosen.iter().zip(values.mean.iter()).map(|(k, value)| (&causes[*k], *value)).collect();
    let [before, after] = reference.left(train, &added);
    let noise = weighing.variance;
    let explained = (before - after) / (before - noise).max(noise);
    let is_unknown = !chosen.is_empty() && explained < EXPLAINS;
    let sds = values.covariance.diagonal().map(f64::sqrt);
    let told = if is_unknown { &[][..] } else { &chosen };
    let effects = told.iter().zip(values.mean.iter().zip(sds.iter()));
    let effects: Vec<PowerEffect> =
        effects.map(|(k, (value, sd))| weighing.effect(&chosen, *k, *value, *sd)).collect();
    let [before, after] = reference.left(held, if is_unknown { &[] } else { &added });
    let rms = |mean: f64| (mean - reference.variance).max(0.0).sqrt();
    let gap = [reference.variance.sqrt(), rms(before), rms(after)];
    Some(PowerFound { effects, is_unknown, gap })
}

/// Causes that are weighed against each other.
struct Weighing<'a> {
    causes: &'a [Cause],
    evidence: Evidence,
    /// Variance of noise and of the reference's own error \[W²\].
    variance: f64,
    /// Rms of the measured power, and of what causes bring per unit \[W\].
    power: f64,
    sizes: Vec<f64>,
}

impl Weighing<'_> {
    fn new<'a>(
        reference: &Reference,
        causes: &'a [Cause],
        train: &[Powers],
    ) -> Option<Weighing<'a>> {
        let count = rows(train).count();
        let of_reference = reference.loss.len() + 1;
        let width = 1 + of_reference + causes.len();
        let mut gram = DMatrix::zeros(width, width);
        let mut power = 0.0;
        for (log, row) in rows(train) {
            let mut all = DVector::zeros(width);
            all[0] = reference.missed(log, row);
            // In deviations of the reference's parameters.
            let told = reference.root.tr_mul(&reference.columns(log, row));
            all.rows_mut(1, of_reference).copy_from(&told);
            for (k, cause) in causes.iter().enumerate() {
                all[1 + of_reference + k] = cause.of(reference, log, row);
            }
            gram.ger(1.0, &all, &all, 1.0);
            power += log.power[row] * log.power[row];
        }
        let power = (power / count.max(1) as f64).sqrt();
        let squares = gram.diagonal() / count.max(1) as f64;
        let sizes: Vec<f64> =
            squares.iter().skip(1 + of_reference).map(|square| square.sqrt()).collect();
        let variance = reference.variance + (ERROR * power).powi(2);
        gram *= reference.independent / variance;
        let sds = sizes.iter().map(|size| if *size > 0.0 { PRIOR * power / size } else { 0.0 });
        let sds = DVector::from_iterator(causes.len(), sds);
        let evidence = Evidence::new(&gram, of_reference, sds)?;
        (count > 0).then_some(Weighing { causes, evidence, variance, power, sizes })
    }

    /// The causes that bring enough, the strongest first.
    fn forward(&self) -> Vec<usize> {
        let mut chosen: Vec<usize> = Vec::new();
        while chosen.len() < MOST {
            let given = self.evidence.gain(&chosen);
            let with = |k: usize| [chosen.as_slice(), &[k]].concat();
            let best = (0..self.causes.len())
                .rev()
                .filter(|k| !chosen.iter().any(|of| self.is_alike(*of, *k)))
                .filter(|k| self.is_possible(&with(*k)))
                .map(|k| (self.evidence.gain(&with(k)), k))
                .max_by(|a, b| a.0.total_cmp(&b.0));
            match best {
                Some((nats, k)) if nats - given > LEAST_NATS => chosen.push(k),
                _ => break,
            }
        }
        chosen
    }

    /// Whether a cause is the other one's form: losses of a joint are alike.
    fn is_alike(&self, a: usize, b: usize) -> bool {
        let [a, b] = [a, b].map(|k| &self.causes[k]);
        a.joint == b.joint && (a.joint.is_some() || a.effect.id == b.effect.id)
    }

    /// Whether each of some causes can be, and changes enough of the power.
    fn is_possible(&self, chosen: &[usize]) -> bool {
        let Some(values) = self.evidence.estimate(chosen) else { return false };
        let mut of = chosen.iter().zip(values.mean.iter());
        of.all(|(k, value)| {
            // What takes less beside what takes more makes up for a law of another form.
            *value >= if chosen.len() > 1 { 0.0 } else { self.causes[*k].least }
                && value.abs() * self.sizes[*k] > LEAST_SIZE * self.power
        })
    }

    /// What is said of one of the chosen causes.
    fn effect(&self, chosen: &[usize], one: usize, value: f64, sd: f64) -> PowerEffect {
        let cause = &self.causes[one];
        let others: Vec<usize> = chosen.iter().copied().filter(|k| *k != one).collect();
        let gain = |k: usize| self.evidence.gain(&[others.as_slice(), &[k]].concat());
        let all = gain(one);
        let mut class = vec![cause.effect.id];
        for (k, other) in self.causes.iter().enumerate() {
            let is_like = k == one || !chosen.contains(&k) && all - gain(k) < CLASS;
            let id = other.effect.id;
            let same = if id == CONSTANT[0] { &CONSTANT[..] } else { &[id] };
            class.extend(same.iter().filter(|_| is_like));
        }
        let mut seen = BTreeSet::new();
        class.retain(|id| seen.insert(*id));
        let parameters = cause.effect.parameters.iter().map(|parameter| Estimated {
            name: parameter.name.to_owned(),
            value,
            sd,
            unit: parameter.unit,
        });
        PowerEffect {
            effect: cause.effect,
            joint: cause.joint,
            class,
            parameters: parameters.collect(),
            nats: all - self.evidence.gain(&others),
        }
    }
}

/// Rows of some logs.
fn rows(logs: &[Powers]) -> impl Iterator<Item = (&Powers, usize)> {
    logs.iter().flat_map(|log| (0..log.len()).map(move |row| (log, row)))
}

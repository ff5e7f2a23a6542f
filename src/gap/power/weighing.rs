//! Which causes of a change of power are probable.

use std::collections::BTreeSet;

use nalgebra::{Cholesky, DMatrix, DVector};

use super::cause::{Cause, FORMS};
use super::found::PowerEffect;
use super::powers::Powers;
use super::reference::Reference;
use crate::gap::decision::Estimated;

/// What an effect has to bring \[nats\].
const LEAST_NATS: f64 = 25.0;
/// Odds below which two explanations cannot be told apart: 1 to 100.
const CLASS: f64 = 4.6;
/// Effects that are named together at most.
const MOST: usize = 2;
/// The reference's own error, of the power: its losses are not all that there are.
const ERROR: f64 = 0.005;
/// The least that an effect is there for, of the power.
const LEAST_SIZE: f64 = 0.01;
/// What an effect changes before anything is measured, of the power.
const PRIOR: f64 = 0.1;
/// Deviation of the form of a law, of the law; chosen on power cases of worlds A and B, seeds 31 and 41 to 44.
/// Copper that warms by 50 K has a fifth more resistance.
const FORM: f64 = 0.2;

/// Causes that are weighed against each other.
pub(super) struct Weighing<'a> {
    causes: &'a [Cause<'a>],
    /// Weighted products of what is missed, parameters, causes, and their forms.
    gram: DMatrix<f64>,
    parameters: usize,
    /// Rows.
    count: f64,
    /// Independent samples per row.
    independent: f64,
    /// Variance of noise and of the reference's own error \[W²\].
    pub variance: f64,
    /// Rms of the measured power, and of what causes bring per unit \[W\].
    power: f64,
    sizes: Vec<f64>,
}

/// What some causes explain.
pub(super) struct Fit {
    /// Logarithm of the evidence.
    nats: f64,
    /// Powers of the causes, and their deviations.
    pub values: Vec<f64>,
    sds: Vec<f64>,
    /// Parameters of the reference, in deviations.
    pub moved: DVector<f64>,
    /// Mean square that is left \[W²\].
    pub left: f64,
}

impl<'a> Weighing<'a> {
    pub(super) fn new(
        reference: &Reference,
        causes: &'a [Cause<'a>],
        train: &[Powers],
    ) -> Option<Weighing<'a>> {
        let count = train.iter().map(Powers::rows).sum::<usize>();
        let parameters = reference.parameters();
        let first = 1 + parameters;
        let width = first + (1 + FORMS) * causes.len();
        let mut gram = DMatrix::zeros(width, width);
        let mut power = 0.0;
        for log in train {
            let mut all = DMatrix::zeros(log.rows(), width);
            all.column_mut(0).copy_from_slice(&reference.missed(log));
            // In deviations of the reference's parameters.
            let told = reference.columns(log) * &reference.root;
            all.columns_mut(1, parameters).copy_from(&told);
            for (k, cause) in causes.iter().enumerate() {
                all.column_mut(first + k).copy_from_slice(&cause.of(log));
                for (form, column) in cause.forms(log).into_iter().enumerate() {
                    let at = first + causes.len() + FORMS * k + form;
                    all.column_mut(at).copy_from_slice(&column);
                }
            }
            gram += all.tr_mul(&all);
            power += log.power.iter().map(|x| x * x).sum::<f64>();
        }
        let count = count as f64;
        let power = (power / count.max(1.0)).sqrt();
        let squares = gram.diagonal() / count.max(1.0);
        let sizes: Vec<f64> =
            squares.iter().skip(first).take(causes.len()).map(|square| square.sqrt()).collect();
        let variance = reference.variance + (ERROR * power).powi(2);
        let independent = reference.independent;
        gram *= independent / variance;
        let weighing =
            Weighing { causes, gram, parameters, count, independent, variance, power, sizes };
        (count > 0.0).then_some(weighing)
    }

    /// The causes that bring enough, the strongest first.
    pub(super) fn forward(&self) -> Vec<usize> {
        let mut chosen: Vec<usize> = Vec::new();
        loop {
            let Some(given) = self.fit(&chosen) else { return chosen };
            let with = |k: usize| [chosen.as_slice(), &[k]].concat();
            let best = (0..self.causes.len())
                .rev()
                .filter(|k| !chosen.iter().any(|of| self.is_alike(*of, *k)))
                .filter(|k| self.effects(&with(*k)) <= MOST)
                .filter_map(|k| Some((self.fit(&with(k))?, k)))
                .filter(|(fit, k)| self.is_possible(fit, &with(*k)))
                .max_by(|a, b| a.0.nats.total_cmp(&b.0.nats));
            match best {
                Some((fit, k))
                    if self.told(&given, &fit) > LEAST_NATS
                        && !self.may_be_form(&fit, &with(k)) =>
                {
                    chosen.push(k);
                }
                _ => return chosen,
            }
        }
    }

    /// The evidence of a fit beside that with fewer causes, as far as what is left is noise \[nats\].
    fn told(&self, less: &Fit, fit: &Fit) -> f64 {
        (fit.nats - less.nats) * self.variance / fit.left.max(self.variance)
    }

    /// Number of effects of some causes: one may be at several joints.
    fn effects(&self, chosen: &[usize]) -> usize {
        chosen.iter().map(|k| self.causes[*k].effect.id).collect::<BTreeSet<_>>().len()
    }

    /// Whether a cause is the other one's form: losses of a joint are alike.
    fn is_alike(&self, a: usize, b: usize) -> bool {
        let [a, b] = [a, b].map(|k| &self.causes[k]);
        a.joint == b.joint && (a.joint.is_some() || a.effect.id == b.effect.id)
    }

    /// Whether each of some causes can be, and changes enough of the power.
    fn is_possible(&self, fit: &Fit, chosen: &[usize]) -> bool {
        chosen.iter().zip(&fit.values).all(|(k, value)| {
            // What takes less beside what takes more makes up for a law of another form.
            *value >= if chosen.len() > 1 { 0.0 } else { self.causes[*k].least }
                && value.abs() * self.sizes[*k] > LEAST_SIZE * self.power
        })
    }

    /// Whether one of some causes is so small that it may be the form of a larger one of another effect.
    fn may_be_form(&self, fit: &Fit, chosen: &[usize]) -> bool {
        let sizes: Vec<(&str, f64)> = chosen
            .iter()
            .zip(&fit.values)
            .map(|(k, value)| (self.causes[*k].effect.id, value.abs() * self.sizes[*k]))
            .collect();
        let is_form = |(id, size): &(&str, f64)| {
            sizes.iter().any(|(of, larger)| of != id && *size < FORM * larger)
        };
        sizes.iter().any(is_form)
    }

    /// What some causes explain, their forms included.
    pub(super) fn fit(&self, chosen: &[usize]) -> Option<Fit> {
        let sds: Vec<f64> = chosen
            .iter()
            .map(|k| if self.sizes[*k] > 0.0 { PRIOR * self.power / self.sizes[*k] } else { 0.0 })
            .collect();
        let plain = self.fit_with(chosen, &sds, &vec![0.0; chosen.len()])?;
        let forms: Vec<f64> = plain.values.iter().map(|value| FORM * value.abs()).collect();
        self.fit_with(chosen, &sds, &forms)
    }

    /// The same with prior deviations of the causes and of their forms.
    fn fit_with(&self, chosen: &[usize], sds: &[f64], forms: &[f64]) -> Option<Fit> {
        let (first, n) = (1 + self.parameters, chosen.len());
        let form = |k: usize, form: usize| first + self.causes.len() + FORMS * k + form;
        let mut used: Vec<(usize, f64)> = (1..first).map(|k| (k, 1.0)).collect();
        used.extend(chosen.iter().zip(sds).map(|(k, sd)| (first + k, *sd)));
        for (k, sd) in chosen.iter().zip(forms) {
            used.extend((0..FORMS).map(|of| (form(*k, of), *sd)));
        }
        let count = used.len();
        let scaled = DMatrix::from_fn(count, count, |i, k| {
            used[i].1 * used[k].1 * self.gram[(used[i].0, used[k].0)]
        });
        let right = DVector::from_fn(count, |k, _| used[k].1 * self.gram[(used[k].0, 0)]);
        let factor = Cholesky::new(&scaled + DMatrix::identity(count, count))?;
        let mean = factor.solve(&right);
        let log_det: f64 = factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum();
        let left = self.gram[(0, 0)] - 2.0 * mean.dot(&right) + mean.dot(&(&scaled * &mean));
        let covariance = factor.inverse();
        let of = |k: usize| (used[self.parameters + k].1, self.parameters + k);
        Some(Fit {
            nats: 0.5 * right.dot(&mean) - log_det,
            values: (0..n).map(of).map(|(sd, at)| sd * mean[at]).collect(),
            sds: (0..n).map(of).map(|(sd, at)| sd * covariance[(at, at)].sqrt()).collect(),
            moved: mean.rows(0, self.parameters).into_owned(),
            left: left * self.variance / (self.independent * self.count),
        })
    }

    /// What is said of one of the chosen causes.
    pub(super) fn effect(&self, chosen: &[usize], one: usize) -> Option<PowerEffect> {
        let cause = &self.causes[one];
        let others: Vec<usize> = chosen.iter().copied().filter(|k| *k != one).collect();
        let with = |k: usize| self.fit(&[others.as_slice(), &[k]].concat());
        let (less, all) = (self.fit(&others)?, with(one)?);
        let mut class = vec![cause.effect.id];
        // Losses of a joint differ by what the form of each may be off.
        let of_form = FORM.powi(2) * (less.left - all.left);
        for (k, other) in self.causes.iter().enumerate().filter(|(k, _)| !chosen.contains(k)) {
            let Some(of) = with(k) else { continue };
            let is_form = other.joint.is_some() && other.joint == cause.joint;
            if self.told(&of, &all) < CLASS || is_form && of.left - all.left < of_form {
                class.push(other.effect.id);
            }
        }
        let mut seen = BTreeSet::new();
        class.retain(|id| seen.insert(*id));
        let (value, sd) = (*all.values.last()?, *all.sds.last()?);
        let parameters = cause.effect.parameters.iter().map(|parameter| Estimated {
            name: parameter.name.to_owned(),
            value,
            sd,
            unit: parameter.unit,
        });
        Some(PowerEffect {
            effect: cause.effect,
            joint: cause.joint,
            class,
            parameters: parameters.collect(),
            nats: self.told(&less, &all),
        })
    }
}

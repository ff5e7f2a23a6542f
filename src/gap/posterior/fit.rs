//! The most probable sizes with a hypothesis, and the posterior that follows.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::blocked::Factor;
use super::hypothesis::{Extra, Hypothesis, Member};
use super::reduced::{Reduced, variance};
use super::sizes::{JointSizes, LAWS, NOISE, Size, Sizes, WRITTEN, without_everyday};
use super::start::{Known, Start};
use crate::arm::robot::Model;
use crate::gap::data::Record;
use crate::gap::design::{Cell, Design, Group, JointDesign, Packed, Parameters, PieceRows, Set};

/// The logs with a hypothesis.
#[derive(Clone)]
pub(in crate::gap) struct Fit {
    /// The hypothesis.
    pub hypothesis: Hypothesis,
    /// Sizes of everyday errors.
    pub sizes: Sizes,
    /// Amplitudes of the members, over their usual ones.
    pub amplitudes: Vec<Size>,
    /// Logarithm of the evidence, priors of the sizes included.
    pub log_evidence: f64,
    /// Factors of parameters (in deviations) and effects.
    pub mean: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
    /// Size of the parameters of the torque path: 0 where they are not there.
    path: f64,
    pub(super) reduced: Vec<Reduced>,
    pub(super) extra: Vec<Extra>,
}

/// Gain of a step after which no further one is made \[nats\].
const CONVERGED: f64 = 0.5;
/// Steps of the sizes of errors of a model that is written: least and most.
const AS_WRITTEN: [usize; 2] = [8, 32];
/// Deviation of a parameter that keeps its value, of its usual one.
const KEPT: f64 = 1e-3;
/// Steps of the amplitudes before those of all sizes.
const AMPLITUDES: usize = 5;
/// Curvature that is added where a size hardly matters.
const LEAST_CURVATURE: f64 = 0.3;

/// Fits a hypothesis, with so many steps of the sizes at least and at most.
#[must_use]
pub(in crate::gap) fn fitted(
    design: &Design,
    hypothesis: Hypothesis,
    start: Start,
    steps: [usize; 2],
) -> Option<Fit> {
    fit_from(design, hypothesis, (start, 1.0), steps)
}

/// Fits pieces with what a written model has: neither everyday errors nor lags of the torques; at the
/// sizes of errors of another fit, where there is one.
#[must_use]
pub(in crate::gap) fn fitted_as_written(
    design: &Design,
    records: &[Record<'_>],
    pieces: Vec<PieceRows>,
    near: Option<&Fit>,
) -> Option<Fit> {
    let members = pieces.into_iter().map(|piece| Member::as_written(design, records, piece));
    let hypothesis = Hypothesis { members: members.collect() };
    let (mut sizes, steps) = match near {
        Some(near) => (near.sizes.clone(), [0, 0]),
        None => (without_everyday(design), AS_WRITTEN),
    };
    for joint in &mut sizes {
        joint.groups.retain(|(group, _)| !matches!(group, Group::Form(_)));
    }
    fit_from(design, hypothesis, (Start::at(sizes), 0.0), steps)
}

fn fit_from(
    design: &Design,
    hypothesis: Hypothesis,
    (start, path): (Start, f64),
    [least, most]: [usize; 2],
) -> Option<Fit> {
    let extra: Vec<Extra> = (0..design.joints.len())
        .into_par_iter()
        .map(|joint| hypothesis.extra(design, joint))
        .collect();
    let spread = design.tunables.amplitude_spread;
    let known = start.amplitudes.into_iter().chain(std::iter::repeat(1.0));
    let amplitudes = known.take(hypothesis.members.len());
    let amplitudes = amplitudes.map(|value| Size::about(value, 1.0, spread)).collect();
    let mut fit = Fit {
        hypothesis,
        sizes: start.sizes,
        amplitudes,
        log_evidence: f64::NEG_INFINITY,
        mean: DVector::zeros(0),
        covariance: DMatrix::zeros(0, 0),
        path,
        reduced: Vec::new(),
        extra,
    };
    fit.start_forms(design);
    fit.reduce(design, start.reduced)?;
    // Effects take their sizes first, or everyday errors grow in their place.
    for _ in 0..if most > 0 { AMPLITUDES } else { 0 } {
        fit.amplitude_step(design.parameters.count());
        fit.solve(design.parameters.count(), &design.parameters)?;
    }
    // Sizes that are far off need more steps.
    let mut before = f64::NEG_INFINITY;
    for round in 0..most {
        if round >= least && fit.log_evidence - before < CONVERGED {
            break;
        }
        before = fit.log_evidence;
        let known = (fit.sizes.clone(), fit.amplitudes.clone());
        if fit.step(design, &start.is_open).is_none() {
            // Sizes of which nothing can be computed.
            (fit.sizes, fit.amplitudes) = known;
            fit.reduce(design, vec![None; design.joints.len()])?;
            break;
        }
    }
    Some(fit)
}

impl Fit {
    /// What another fit may begin with.
    #[must_use]
    pub(in crate::gap) fn known(&self) -> Known<'_> {
        let Fit { hypothesis, sizes, amplitudes, reduced, .. } = self;
        Known { hypothesis, sizes, amplitudes, reduced }
    }

    /// Bounds what pieces bring along that are its members from number `first` on; whether one was
    /// beyond.
    pub(in crate::gap) fn bound<'a>(
        &self,
        pieces: impl Iterator<Item = &'a mut PieceRows>,
        first: usize,
        model: &Model,
    ) -> bool {
        let members = &self.hypothesis.members;
        let counts = members[..first].iter().map(|member| member.piece.prior.len());
        let mut from = self.mean.len() - self.hypothesis.columns() + counts.sum::<usize>();
        let mut is_beyond = false;
        for piece in pieces {
            let factors = &self.mean.as_slice()[from..from + piece.prior.len()];
            is_beyond |= piece.bound(factors, model);
            from += piece.prior.len();
        }
        is_beyond
    }

    /// Prior standard deviations and means of the effects' factors.
    pub(super) fn prior(&self) -> (Vec<f64>, Vec<f64>) {
        let mut sds = Vec::new();
        let mut means = Vec::new();
        for (member, amplitude) in self.hypothesis.members.iter().zip(&self.amplitudes) {
            let is_fixed = member.piece.is_fixed();
            for (k, (mean, sd)) in member.piece.prior.iter().enumerate() {
                means.push(*mean);
                // A shape that acts by itself has no amplitude.
                let scale = if is_fixed || k >= member.piece.own { 1.0 } else { amplitude.value };
                sds.push(sd * scale);
            }
        }
        (means, sds)
    }

    /// Forms begin at the usual sizes of their laws.
    fn start_forms(&mut self, design: &Design) {
        for (number, member) in self.hypothesis.members.iter().enumerate() {
            for (joint, form) in &member.forms {
                let Some((_, rows)) = member.piece.rows.iter().find(|(of, _)| of == joint) else {
                    continue;
                };
                let law = rows.column(0).norm() / form.norm();
                self.sizes[*joint].set_form(
                    number,
                    law / design.joints[*joint].torque,
                    &design.tunables,
                );
            }
        }
    }

    /// Marginalises the everyday errors of joints that are not known yet, then all else.
    fn reduce(&mut self, design: &Design, known: Vec<Option<Reduced>>) -> Option<()> {
        let parameters = design.parameters.count();
        let new = |joint: usize| {
            let (extra, sizes) = (&self.extra[joint], &self.sizes[joint]);
            Reduced::new(&design.joints[joint], parameters, extra, sizes)
        };
        let known = known.into_par_iter().enumerate();
        let all: Option<Vec<Reduced>> =
            known.map(|(joint, known)| known.or_else(|| new(joint))).collect();
        self.reduced = all?;
        self.solve(parameters, &design.parameters)
    }

    /// Parameters and factors of effects, and the evidence.
    fn solve(&mut self, parameters: usize, of: &Parameters) -> Option<()> {
        let (means, sds) = self.prior();
        let (h, global) = (means.len(), 1 + parameters + means.len());
        let mut sum = DMatrix::zeros(global, global);
        let mut log_evidence = 0.0;
        for of in &self.reduced {
            sum += &of.global;
            log_evidence += of.log_weights - of.log_det;
        }
        // The expected factors of effects are taken off the difference.
        let mut shift = DVector::zeros(global);
        shift[0] = 1.0;
        for (k, mean) in means.iter().enumerate() {
            shift[1 + parameters + k] = -mean;
        }
        let left = &sum * &shift;
        let squares = shift.dot(&left);
        let size = |k: usize| if k < of.of_model() { 1.0 } else { self.path };
        let scale: Vec<f64> = (0..parameters).map(size).chain(sds.iter().copied()).collect();
        let n = parameters + h;
        let mut scaled = DMatrix::from_fn(n, n, |i, k| {
            scale[i] * scale[k] * sum[(1 + i, 1 + k)] + if i == k { 1.0 } else { 0.0 }
        });
        // What an effect brings along is the model's no more.
        let members = if self.path > 0.0 { &[] } else { &self.hypothesis.members[..] };
        for brought in members.iter().flat_map(|of| &of.piece.brought) {
            for parameter in &brought.parameters {
                let row = of.mixing.row(*parameter) / (KEPT * of.sizes[*parameter].max(1e-12));
                let mut model = scaled.view_mut((0, 0), (row.len(), row.len()));
                model += row.transpose() * &row;
            }
        }
        let right = DVector::from_fn(n, |k, _| scale[k] * left[1 + k]);
        let factor = Factor::new(scaled)?;
        let moved = factor
            .solve(&DMatrix::from_columns(std::slice::from_ref(&right)))
            .column(0)
            .into_owned();
        let inverse = factor.inverse();
        log_evidence -= factor.log_det();
        log_evidence -= 0.5 * (squares - right.dot(&moved));
        log_evidence += self.sizes.iter().map(JointSizes::log_prior).sum::<f64>();
        log_evidence += self.amplitudes.iter().map(Size::log_prior).sum::<f64>();
        self.covariance = DMatrix::from_fn(n, n, |i, k| scale[i] * scale[k] * inverse[(i, k)]);
        self.mean = DVector::from_fn(n, |k, _| {
            scale[k] * moved[k] + if k >= parameters { means[k - parameters] } else { 0.0 }
        });
        self.log_evidence = log_evidence;
        Some(())
    }

    /// A step of the sizes of some joints, and the posterior with them.
    fn step(&mut self, design: &Design, is_open: &[bool]) -> Option<()> {
        let parameters = design.parameters.count();
        let steps: Vec<Option<JointSizes>> = (0..design.joints.len())
            .into_par_iter()
            .map(|joint| is_open[joint].then(|| self.joint_step(&design.joints[joint], joint)))
            .collect();
        self.amplitude_step(parameters);
        let mut changed = vec![false; steps.len()];
        for (joint, step) in steps.into_iter().enumerate() {
            if let Some(step) = step {
                self.sizes[joint] = step;
                changed[joint] = true;
            }
        }
        self.form_priors(design);
        self.law_powers(design.parameters.count());
        for (extra, of) in self.extra.iter_mut().zip(&design.joints) {
            for (laws, cell) in extra.laws.iter_mut().zip(&of.cells) {
                *laws /= cell.rows.len() as f64;
            }
        }
        // What laws miss follows their sizes.
        let old = std::mem::take(&mut self.reduced).into_iter().enumerate();
        let is_same = |joint: usize| !changed[joint] && !self.hypothesis.reaches(joint);
        let known = old.map(|(joint, old)| is_same(joint).then_some(old)).collect();
        self.reduce(design, known)
    }

    /// A step of the amplitudes of the members.
    fn amplitude_step(&mut self, parameters: usize) {
        let mut from = parameters;
        for (member, amplitude) in self.hypothesis.members.iter().zip(&mut self.amplitudes) {
            let prior = &member.piece.prior;
            let of = from..from + prior.len();
            from = of.end;
            if prior.iter().any(|(mean, _)| *mean != 0.0) {
                continue;
            }
            let (mut squares, mut variances, mut count) = (0.0, 0.0, 0.0);
            for (k, (_, sd)) in of.zip(&prior[..member.piece.own]) {
                let sd = sd * amplitude.value;
                if sd > 0.0 {
                    squares += (self.mean[k] / sd).powi(2);
                    variances += self.covariance[(k, k)] / (sd * sd);
                    count += 1.0;
                }
            }
            amplitude.step(
                squares + variances - count,
                2.0 * (count - variances).max(0.0) + LEAST_CURVATURE,
            );
        }
    }

    /// The prior of a form follows the size of its law.
    fn form_priors(&mut self, design: &Design) {
        let mut from = design.parameters.count();
        for (number, member) in self.hypothesis.members.iter().enumerate() {
            let count = member.piece.prior.len();
            let own = member.piece.own;
            let factors = self.mean.rows(from, own).into_owned();
            from += count;
            for (joint, form) in &member.forms {
                let Some((_, rows)) = member.piece.rows.iter().find(|(of, _)| of == joint) else {
                    continue;
                };
                let law = (rows.columns(0, own) * &factors).norm() / form.norm();
                self.sizes[*joint].set_form(
                    number,
                    law / design.joints[*joint].torque,
                    &design.tunables,
                );
            }
        }
    }

    /// The laws' mean squares by cell follow their factors.
    fn law_powers(&mut self, parameters: usize) {
        for extra in &mut self.extra {
            for (laws, own) in extra.laws.iter_mut().zip(&extra.own) {
                *laws = 0.0;
                let mut from = 0;
                for member in &self.hypothesis.members {
                    let count = member.piece.own;
                    let factors = self.mean.rows(parameters + from, count);
                    *laws += factors.dot(&(own.view((from, from), (count, count)) * factors));
                    from += member.piece.prior.len();
                }
            }
        }
    }

    /// A step of the sizes of a joint.
    fn joint_step(&self, design: &JointDesign, joint: usize) -> JointSizes {
        let Reduced { factor, solved, sizes: scale, .. } = &self.reduced[joint];
        let extra = &self.extra[joint];
        let theta = &self.mean;
        let n = theta.len();
        let solved_theta = solved.columns(1, n);
        let u = solved.column(0) - solved_theta * theta;
        let across = solved_theta * &self.covariance;
        let variance_u = factor.inverse() + &across * solved_theta.transpose();
        let mut sizes = self.sizes[joint].clone();
        let all: Vec<Group> = design
            .groups
            .iter()
            .copied()
            .chain(extra.forms.iter().map(|of| Group::Form(*of)))
            .collect();
        for (group, size) in &mut sizes.groups {
            let (mut squares, mut variances, mut count) = (0.0, 0.0, 0.0);
            for (k, _) in all.iter().enumerate().filter(|(_, of)| *of == group) {
                squares += u[k] * u[k];
                variances += variance_u[(k, k)];
                count += 1.0;
            }
            if count > 0.0 {
                size.step(
                    squares + variances - count,
                    2.0 * (count - variances).max(0.0) + LEAST_CURVATURE,
                );
            }
        }
        let missed = self.missed(design, joint, &u, &across, &variance_u, scale);
        for (k, size) in sizes.error.iter_mut().enumerate() {
            let part_of = |cell: &Cell, laws: f64| match (k, cell.set) {
                (k, Set::Now) if k == cell.range => cell.power,
                (k, Set::Baseline) if k == 3 + cell.range => cell.power,
                (NOISE, _) => cell.white,
                (LAWS, _) => laws,
                (WRITTEN, Set::Now) => cell.all,
                _ => 0.0,
            };
            let (mut gradient, mut curvature) = (0.0, 0.0);
            for ((cell, missed), laws) in design.cells.iter().zip(&missed).zip(&extra.laws) {
                let variance = variance(cell, &self.sizes[joint], *laws);
                let part = size.value * size.value * part_of(cell, *laws) / variance;
                let count = cell.rows.len() as f64;
                gradient += part * (missed / variance - count);
                curvature += 2.0 * count * part * part;
            }
            size.step(gradient, curvature + LEAST_CURVATURE);
        }
        sizes
    }

    /// Expected squares of what is missed, by cell.
    fn missed(
        &self,
        design: &JointDesign,
        joint: usize,
        u: &DVector<f64>,
        across: &DMatrix<f64>,
        variance_u: &DMatrix<f64>,
        scale: &[f64],
    ) -> Vec<f64> {
        let extra = &self.extra[joint];
        let everyday = design.groups.len();
        let (h, f) = (extra.effects, extra.forms.len());
        let parameters = self.mean.len() - h;
        // Order y, P, L | H, F.
        let size = 1 + parameters + everyday;
        let place_theta = |k: usize| if k < parameters { 1 + k } else { size + k - parameters };
        let place_u =
            |k: usize| if k < everyday { 1 + parameters + k } else { size + h + k - everyday };
        let total = size + h + f;
        let mut v = DVector::zeros(total);
        v[0] = 1.0;
        for k in 0..self.mean.len() {
            v[place_theta(k)] = -self.mean[k];
        }
        for k in 0..u.len() {
            v[place_u(k)] = -scale[k] * u[k];
        }
        let mut omega = &v * v.transpose();
        for i in 0..self.mean.len() {
            for k in 0..self.mean.len() {
                omega[(place_theta(i), place_theta(k))] += self.covariance[(i, k)];
            }
            for k in 0..u.len() {
                let covariance = -scale[k] * across[(k, i)];
                omega[(place_theta(i), place_u(k))] += covariance;
                omega[(place_u(k), place_theta(i))] += covariance;
            }
        }
        for i in 0..u.len() {
            for k in 0..u.len() {
                omega[(place_u(i), place_u(k))] += scale[i] * scale[k] * variance_u[(i, k)];
            }
        }
        let base = Packed::doubled(&omega.view((0, 0), (size, size)).into_owned());
        let with = omega.view((0, size), (size, h + f)).into_owned();
        let own = omega.view((size, size), (h + f, h + f)).into_owned();
        (0..design.cells.len())
            .map(|k| {
                let more =
                    |(w, o): (&DMatrix<f64>, &DMatrix<f64>)| 2.0 * w.dot(&with) + o.dot(&own);
                design.grams[k].dot(&base) + extra.products(k).map_or(0.0, more)
            })
            .map(|missed| missed.max(0.0))
            .collect()
    }
}

//! Shares of a joint's torque: of everyday errors, of effects.

use std::ops::Range;

use nalgebra::{Cholesky, DVector};

use super::fit::Fit;
use crate::arm::effects::{Acts, Variable};
use crate::gap::design::{Cell, Design, Group, JointDesign, Set};

/// Square of the share of the torque to which parameters are told from smooth errors.
const RIDGE: f64 = 1e-6;

impl Fit {
    /// Everyday errors of a joint in the logs as they are now, of its torque: root mean square of the
    /// smooth functions and of what no function explains.
    #[must_use]
    pub(in crate::gap) fn everyday(&self, design: &Design, joint: usize) -> f64 {
        let smooth = self.smooth(design, joint, &is_everyday);
        (smooth + error(design, joint, |range| self.sizes[joint].error[range].value.powi(2))).sqrt()
    }

    /// What of them the baseline does not have.
    #[must_use]
    pub(in crate::gap) fn changed(&self, design: &Design, joint: usize) -> f64 {
        let is_of_day = |group: Group| matches!(group, Group::Day(_));
        let size = |range: usize| self.sizes[joint].error[range].value.powi(2);
        let more = |range: usize| (size(range) - size(range + BASELINE)).max(0.0);
        (self.smooth(design, joint, &is_of_day) + error(design, joint, more)).sqrt()
    }

    /// The variable of the largest smooth error of a joint, if smooth errors are most of it.
    #[must_use]
    pub(in crate::gap) fn largest_variable(
        &self,
        design: &Design,
        joint: usize,
    ) -> Option<Variable> {
        let error = error(design, joint, |range| self.sizes[joint].error[range].value.powi(2));
        let variables = design.joints[joint].groups.iter().filter_map(|group| match group {
            Group::Smooth(variable) => Some(*variable),
            _ => None,
        });
        let mut variables: Vec<Variable> = variables.collect();
        variables.dedup();
        let share =
            |of: &Variable| self.smooth(design, joint, &|group| group == Group::Smooth(*of));
        let shares = variables.iter().map(|of| (share(of), *of));
        let largest = shares.max_by(|a, b| a.0.total_cmp(&b.0));
        largest.filter(|(share, _)| *share > error).map(|(_, of)| of)
    }

    /// Share of members in a joint's torque in the logs as they are now: root mean square. Of what acts
    /// over time, the change over all repetitions.
    #[must_use]
    pub(in crate::gap) fn share(
        &self,
        design: &Design,
        members: Range<usize>,
        joint: usize,
    ) -> f64 {
        self.product(design, [members.clone(), members], joint).sqrt()
    }

    /// Whether a member's share of some joint's torque is that of a finding.
    #[must_use]
    pub(in crate::gap) fn is_large(&self, design: &Design, member: usize) -> bool {
        let least = design.least_share();
        (0..design.joints.len()).any(|joint| self.share(design, member..member + 1, joint) >= least)
    }

    /// Correlation of the torques of two ranges of members at a joint.
    #[must_use]
    pub(in crate::gap) fn correlation(
        &self,
        design: &Design,
        [a, b]: [Range<usize>; 2],
        joint: usize,
    ) -> f64 {
        let sizes = [&a, &b].map(|of| self.share(design, of.clone(), joint));
        let product = self.product(design, [a, b], joint);
        product / (sizes[0] * sizes[1]).max(f64::MIN_POSITIVE)
    }

    /// Mean product of the torques of two ranges of members, of the mean square of the joint's.
    fn product(&self, design: &Design, members: [Range<usize>; 2], joint: usize) -> f64 {
        let of = &design.joints[joint];
        let set = if members.iter().any(|of| self.drifts(of)) && of.shows_drift {
            Set::Drift
        } else {
            Set::Now
        };
        let [a, b] = members.map(|of| self.torque(design, of, joint));
        let cells = of.cells.iter().filter(|cell| cell.set == set);
        let products = cells.map(|cell| {
            let [a, b] = [&a, &b].map(|rows| rows.rows(cell.rows.start, cell.rows.len()));
            a.dot(&b)
        });
        products.sum::<f64>() / power(of).max(f64::MIN_POSITIVE)
    }

    /// Whether members act over time: what does not change from repetition to repetition is friction.
    fn drifts(&self, members: &Range<usize>) -> bool {
        let mut members = self.hypothesis.members[members.clone()].iter();
        members.any(|member| member.piece.effect.acts == Acts::OverTime)
    }

    /// Rows of what members add to a joint's torque.
    fn torque(&self, design: &Design, members: Range<usize>, joint: usize) -> DVector<f64> {
        let mut sum = DVector::zeros(design.joints[joint].y.len());
        let mut from = design.parameters.count();
        for (number, member) in self.hypothesis.members.iter().enumerate() {
            let own = member.piece.own;
            let rows = member.piece.rows.iter().find(|(at, _)| *at == joint);
            if let Some((_, rows)) = rows.filter(|_| members.contains(&number)) {
                sum += rows.columns(0, own) * self.mean.rows(from, own);
            }
            from += member.piece.prior.len();
        }
        sum
    }

    /// Mean square of smooth errors of some groups, of the torque's: what parameters could explain as
    /// well is none.
    fn smooth(&self, design: &Design, joint: usize, is_counted: &dyn Fn(Group) -> bool) -> f64 {
        let of = &design.joints[joint];
        let reduced = &self.reduced[joint];
        let parameters = design.parameters.count();
        let u = reduced.solved.column(0) - reduced.solved.columns(1, self.mean.len()) * &self.mean;
        let mut smooth = DVector::zeros(of.y.len());
        for (k, _) in of.groups.iter().enumerate().filter(|(_, group)| is_counted(**group)) {
            smooth.axpy(reduced.sizes[k] * u[k], &of.base.column(parameters + k), 1.0);
        }
        let fixed = (0..of.groups.len()).filter(|k| of.groups[*k] == Group::Fixed);
        let numbers: Vec<usize> = (0..parameters).chain(fixed.map(|k| parameters + k)).collect();
        let mut own = of.base.select_columns(&numbers);
        for cell in of.cells.iter().filter(|cell| cell.set != Set::Now) {
            own.rows_mut(cell.rows.start, cell.rows.len()).fill(0.0);
            smooth.rows_mut(cell.rows.start, cell.rows.len()).fill(0.0);
        }
        let transposed = own.transpose();
        let mut gram = &transposed * &own;
        let ridge = RIDGE * of.torque * of.torque * of.y.len() as f64;
        (0..gram.nrows()).for_each(|k| gram[(k, k)] += ridge);
        if let Some(factor) = Cholesky::new(gram) {
            smooth -= &own * factor.solve(&(&transposed * &smooth));
        }
        smooth.norm_squared() / power(of).max(f64::MIN_POSITIVE)
    }
}

/// Mean square of an error that is given by range of frequencies, of the torque's.
fn error(design: &Design, joint: usize, square: impl Fn(usize) -> f64) -> f64 {
    let of = &design.joints[joint];
    let squares = now(of).map(|cell| square(cell.range) * cell.power * cell.rows.len() as f64);
    squares.sum::<f64>() / power(of).max(f64::MIN_POSITIVE)
}

/// Sum of the squares of the model's torque in the logs as they are now.
fn power(of: &JointDesign) -> f64 {
    now(of).map(|cell| cell.power * cell.rows.len() as f64).sum()
}

/// Place of the baseline's sizes behind those of the logs as they are now.
const BASELINE: usize = 3;

/// Errors that any robot has; friction after a reversal is measured by Coulomb friction.
fn is_everyday(group: Group) -> bool {
    match group {
        Group::Smooth(variable) => variable != Variable::Reversal,
        Group::OtherPosition => true,
        Group::Day(_) | Group::LogFriction | Group::Fixed | Group::Form(_) => false,
    }
}

/// Cells of the logs as they are now.
fn now(of: &JointDesign) -> impl Iterator<Item = &Cell> {
    of.cells.iter().filter(|cell| cell.set == Set::Now)
}

//! Information of a motion on the base parameters.

use nalgebra::DMatrix;

use crate::arm::dynamics::{BaseParameters, JOINT, RIGID, Regressor, motor_rates, regressor};
use crate::arm::robot::{MAX_DOF, Model};

use super::series::State;

/// Condition number above which some parameter counts as not excited.
const BLIND: f64 = 1e12;

/// Information of a motion on the base parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Information {
    /// Number of base parameters that the motion excites.
    pub rank: usize,
    /// Condition number of W with columns of one length.
    pub scaled: f64,
    /// Condition number of W in SI units.
    pub raw: f64,
    /// `log det WᵀW`.
    pub log_det: f64,
}

/// The sums `WᵀW` of base regressors.
#[derive(Clone, Debug)]
pub(super) struct Normal<'a> {
    model: &'a Model,
    base: &'a BaseParameters,
    /// For each joint, the base parameters in its equation.
    columns: Vec<Vec<usize>>,
    scratch: Regressor,
    shares: [[f64; MAX_DOF]; MAX_DOF],
}

impl<'a> Normal<'a> {
    /// Empty sums for the base parameters `base` of a robot.
    #[must_use]
    pub(super) fn new(model: &'a Model, base: &'a BaseParameters) -> Normal<'a> {
        let n = model.dof;
        let mut shares = [[0.0; MAX_DOF]; MAX_DOF];
        for (joint, share) in shares.iter_mut().enumerate().take(n) {
            let mut unit = [0.0; MAX_DOF];
            unit[joint] = 1.0;
            *share = motor_rates(model, &unit[..n]);
        }
        let mut normal =
            Normal { model, base, columns: Vec::new(), scratch: Regressor::new(), shares };
        let state: State = std::array::from_fn(|kind| {
            std::array::from_fn(|j| 0.3 + ((kind * MAX_DOF + j + 2) as f64).sqrt().fract())
        });
        let rates = normal.evaluate(&state);
        normal.columns = (0..n)
            .map(|joint| {
                let all = base.independent.iter().enumerate();
                all.filter(|(_, index)| normal.coefficient(joint, **index, &rates) != 0.0)
                    .map(|(k, _)| k)
                    .collect()
            })
            .collect();
        normal
    }

    /// `WᵀW` of a motion.
    #[must_use]
    pub(super) fn matrix(&mut self, states: &[State]) -> DMatrix<f64> {
        let rank = self.base.rank();
        let mut sum = DMatrix::zeros(rank, rank);
        let mut row = Vec::with_capacity(rank);
        for state in states {
            let rates = self.evaluate(state);
            for joint in 0..self.model.dof {
                row.clear();
                for column in &self.columns[joint] {
                    row.push(self.coefficient(joint, self.base.independent[*column], &rates));
                }
                for (a, (value, to)) in row.iter().zip(&self.columns[joint]).enumerate() {
                    let mut column = sum.column_mut(*to);
                    for (other, from) in row[..=a].iter().zip(&self.columns[joint]) {
                        column[*from] += value * other;
                    }
                }
            }
        }
        sum.fill_lower_triangle_with_upper_triangle();
        sum
    }

    fn evaluate(&mut self, state: &State) -> [[f64; MAX_DOF]; 2] {
        let n = self.model.dof;
        let [q, qd, qdd] = state;
        regressor(self.model, &mut self.scratch, &q[..n], &qd[..n], &qdd[..n]);
        [motor_rates(self.model, &qd[..n]), motor_rates(self.model, &qdd[..n])]
    }

    fn coefficient(&self, joint: usize, parameter: usize, rates: &[[f64; MAX_DOF]; 2]) -> f64 {
        let rigid = RIGID * self.model.dof;
        if parameter < rigid {
            return self.scratch.rows[joint][parameter / RIGID][parameter % RIGID];
        }
        let motor = (parameter - rigid) / JOINT;
        let rate = rates[0][motor];
        let value = match (parameter - rigid) % JOINT {
            0 => rates[1][motor],
            1 => rate,
            2 if rate == 0.0 => 0.0,
            2 => rate.signum(),
            _ => 1.0,
        };
        self.shares[joint][motor] * value
    }
}

/// log det of a positive definite matrix, else `None`.
#[must_use]
pub(super) fn log_det(normal: &DMatrix<f64>) -> Option<f64> {
    let factor = normal.clone().cholesky()?;
    Some(2.0 * factor.l_dirty().diagonal().map(f64::ln).sum())
}

/// Information of a motion with the sums `normal`.
#[must_use]
pub fn information(normal: &DMatrix<f64>) -> Information {
    let lengths: Vec<f64> = normal.diagonal().iter().map(|x| x.sqrt()).collect();
    let scaled = DMatrix::from_fn(normal.nrows(), normal.ncols(), |a, b| {
        let length = lengths[a] * lengths[b];
        if length > 0.0 { normal[(a, b)] / length } else { 0.0 }
    });
    let condition = |m: &DMatrix<f64>| {
        let values = m.clone().symmetric_eigen().eigenvalues;
        (values.max() / values.min().max(values.max() / BLIND)).sqrt()
    };
    let values = scaled.clone().symmetric_eigen().eigenvalues;
    Information {
        rank: values.iter().filter(|value| **value > 1e-10 * values.max()).count(),
        scaled: condition(&scaled),
        raw: condition(normal),
        log_det: log_det(normal).unwrap_or(f64::NEG_INFINITY),
    }
}

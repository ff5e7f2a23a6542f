//! Base parameters: the combinations of parameters that torques determine.
//!
//! M. Gautier, "Numerical calculation of the base inertial parameters of robots", Journal of
//! Robotic Systems 8, 1991: QR decomposition of the stacked regressor of many states, W = Q R. A
//! column without a pivot is a combination of previous columns, W₂ = W₁ K, and its parameter is
//! grouped with theirs: π₁ + K π₂.

use std::fmt::Write;

use nalgebra::DMatrix;

use crate::arm::robot::{MAX_DOF, Model};

use super::motor_side::motor_rates;
use super::parameters::{JOINT, RIGID, joint_row, parameter_count, parameter_name};
use super::regressor::{Regressor, regressor};

/// Number of states of the stacked regressor.
const STATES: usize = 80;
/// Pivots below this share of the column length are 0.
const TOLERANCE: f64 = 1e-9;
/// Largest angle \[rad\], velocity \[rad/s\] and acceleration \[rad/s²\] of a state.
const REACH: [f64; 3] = [3.0, 3.0, 3.0];
/// A speed with a sign but without inertial torques \[rad/s\].
const CREEP: f64 = 1e-6;

/// The independent parameters and the grouping of the others.
#[derive(Clone, Debug)]
pub struct BaseParameters {
    /// Number of joints.
    pub dof: usize,
    /// Indices of the leading parameters of the base parameters, ascending.
    pub independent: Vec<usize>,
    /// Indices of the other parameters, ascending.
    pub dependent: Vec<usize>,
    /// K, one row per `independent` and one column per `dependent` parameter.
    pub grouping: DMatrix<f64>,
}

impl BaseParameters {
    /// Number of base parameters.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.independent.len()
    }

    /// The base parameters from all parameters.
    #[must_use]
    pub fn of_parameters(&self, all: &[f64]) -> Vec<f64> {
        let value = |row: usize, index: &usize| {
            let grouped = self.dependent.iter().enumerate();
            all[*index] + grouped.map(|(k, from)| self.grouping[(row, k)] * all[*from]).sum::<f64>()
        };
        self.independent.iter().enumerate().map(|(row, index)| value(row, index)).collect()
    }

    /// A base parameter in words, such as `zz1 + yy2 + 0.49 m3`.
    #[must_use]
    pub fn name(&self, row: usize) -> String {
        let mut text = parameter_name(self.dof, self.independent[row]);
        for (k, from) in self.dependent.iter().enumerate() {
            let factor = self.grouping[(row, k)];
            if factor == 0.0 {
                continue;
            }
            let sign = if factor < 0.0 { '-' } else { '+' };
            let name = parameter_name(self.dof, *from);
            let size = (factor.abs() * 1e6).round() / 1e6;
            let factor = if size == 1.0 { String::new() } else { format!("{size} ") };
            let _ = write!(text, " {sign} {factor}{name}");
        }
        text
    }
}

/// Writes the regressor at one state into `rows` from row `first` on: one row per joint, one column
/// per parameter in the order of [`parameter_name`](super::parameter_name).
pub fn write_rows(
    model: &Model,
    scratch: &mut Regressor,
    state: [&[f64]; 3],
    rows: &mut DMatrix<f64>,
    first: usize,
) {
    let [q, qd, qdd] = state;
    regressor(model, scratch, q, qd, qdd);
    let n = model.dof;
    for joint in 0..n {
        for link in 0..n {
            for (k, value) in scratch.rows[joint][link].iter().enumerate() {
                rows[(first + joint, RIGID * link + k)] = *value;
            }
        }
    }
    let (rates, accelerations) = (motor_rates(model, qd), motor_rates(model, qdd));
    for motor in 0..n {
        let values = joint_row(rates[motor], accelerations[motor]);
        for joint in 0..n {
            // Entry of C: 1 for the own joint, the coupling for axis 5.
            let mut unit = [0.0; MAX_DOF];
            unit[joint] = 1.0;
            let share = motor_rates(model, &unit)[motor];
            for (k, value) in values.iter().enumerate() {
                rows[(first + joint, RIGID * n + JOINT * motor + k)] = share * value;
            }
        }
    }
}

/// The base parameters of a robot.
#[must_use]
pub fn base_parameters(model: &Model) -> BaseParameters {
    let all: Vec<usize> = (0..parameter_count(model.dof)).collect();
    base_parameters_among(model, &all)
}

/// The base parameters of the parameters `among` (indices, ascending) if the others are known.
#[must_use]
pub fn base_parameters_among(model: &Model, among: &[usize]) -> BaseParameters {
    grouped(model, among, REACH)
}

/// The base parameters of motions so slow that only gravity and the sign of friction matter.
#[must_use]
pub fn base_parameters_at_rest(model: &Model, among: &[usize]) -> BaseParameters {
    grouped(model, among, [REACH[0], CREEP, 0.0])
}

fn grouped(model: &Model, among: &[usize], reach: [f64; 3]) -> BaseParameters {
    let n = model.dof;
    let count = parameter_count(n);
    let mut stacked = DMatrix::zeros(STATES * n, count);
    let mut scratch = Regressor::new();
    for state in 0..STATES {
        let [q, qd, qdd]: [Vec<f64>; 3] = std::array::from_fn(|kind| {
            (0..n).map(|joint| reach[kind] * spread(state, kind * MAX_DOF + joint)).collect()
        });
        write_rows(model, &mut scratch, [&q, &qd, &qdd], &mut stacked, state * n);
    }
    let mut stacked = stacked.select_columns(among);
    // Scale columns to equal length, independent of units; columns of rounding errors stay small.
    let mut lengths: Vec<f64> = stacked.column_iter().map(|column| column.norm()).collect();
    let longest = lengths.iter().fold(f64::MIN_POSITIVE, |m, length| m.max(*length));
    for (mut column, length) in stacked.column_iter_mut().zip(&mut lengths) {
        if *length < TOLERANCE * longest {
            *length = longest;
        }
        column /= *length;
    }
    let mut base = group(stacked, &lengths, n);
    for index in base.independent.iter_mut().chain(&mut base.dependent) {
        *index = among[*index];
    }
    base
}

/// Householder reflections from left to right; a column without a remainder below the previous
/// pivots has none.
fn group(mut w: DMatrix<f64>, lengths: &[f64], dof: usize) -> BaseParameters {
    let (mut independent, mut dependent) = (Vec::new(), Vec::new());
    for column in 0..w.ncols() {
        let rank = independent.len();
        let below = w.view_range(rank.., column).norm();
        if below < TOLERANCE {
            dependent.push(column);
            continue;
        }
        independent.push(column);
        let mut mirror = w.view_range(rank.., column).clone_owned();
        mirror[0] += below.copysign(mirror[0]);
        let scale = 2.0 / mirror.norm_squared();
        for later in column..w.ncols() {
            let share = scale * mirror.dot(&w.view_range(rank.., later));
            w.view_range_mut(rank.., later).axpy(-share, &mirror, 1.0);
        }
    }
    let rank = independent.len();
    // Solve R₁ K = R₂ backwards, then undo the scaling.
    let mut grouping = DMatrix::zeros(rank, dependent.len());
    for (k, from) in dependent.iter().enumerate() {
        for row in (0..rank).rev() {
            let mut sum = w[(row, *from)];
            for other in row + 1..rank {
                sum -= w[(row, independent[other])] * grouping[(other, k)];
            }
            grouping[(row, k)] = sum / w[(row, independent[row])];
        }
        for row in 0..rank {
            grouping[(row, k)] *= lengths[*from] / lengths[independent[row]];
            if grouping[(row, k)].abs() < TOLERANCE {
                grouping[(row, k)] = 0.0;
            }
        }
    }
    BaseParameters { dof, independent, dependent, grouping }
}

/// A number in (−1, 1), evenly distributed over `index` and independent per `channel`: the
/// fractional parts of multiples of square roots of primes.
fn spread(index: usize, channel: usize) -> f64 {
    const PRIMES: [f64; 3 * MAX_DOF] = [
        2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0, 29.0, 31.0, 37.0, 41.0, 43.0, 47.0, 53.0,
        59.0, 61.0, 67.0, 71.0, 73.0,
    ];
    2.0 * ((index + 1) as f64 * PRIMES[channel].sqrt()).fract() - 1.0
}

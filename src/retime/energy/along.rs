//! The power at instants of a motion as a function of the robot.
//!
//! Torques are linear in the parameters of the robot (see [`moments`](super::moments)), so power at
//! an instant and its derivatives have closed forms.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::change::Changes;
use super::features;
use super::power::{power_at, supply_w};
use crate::arm::dynamics::{Data, Load, Regressor};
use crate::arm::robot::prior::{Plausible, Spread};
use crate::arm::robot::{Model, Sharing};
use crate::retime::path::joint_path::Joints;

/// A state of the robot with its load.
#[derive(Clone, Debug)]
pub struct Instant {
    /// Tool and payload at the flange.
    pub load: Load,
    /// Position \[rad\], velocity \[rad/s\], acceleration \[rad/s²\].
    pub state: [Joints; 3],
}

impl Instant {
    /// The robot at rest.
    #[must_use]
    pub fn rest(load: &Load, q: &Joints) -> Instant {
        Instant { load: load.clone(), state: [*q, [0.0; 6], [0.0; 6]] }
    }

    fn rests(&self) -> bool {
        self.state[1].iter().chain(&self.state[2]).all(|x| *x == 0.0)
    }
}

/// Instants and windows over which power and torques are averaged.
pub struct Along<'a> {
    model: &'a Model,
    windows: Vec<Range<usize>>,
    /// Features of each joint, one row per instant.
    features: Vec<DMatrix<f64>>,
    rates: Vec<Joints>,
    rests: Vec<bool>,
    /// Power of the model without [`Along::terms`] \[W\].
    rest_w: Vec<f64>,
}

/// Derivatives of the parameter differences by the latent variables.
pub struct Slopes {
    joints: Vec<DMatrix<f64>>,
    loss: DMatrix<f64>,
    supply_w: DVector<f64>,
}

/// Means over the windows.
pub struct Means {
    /// Power, W.
    pub power: DVector<f64>,
    /// Torque of each joint \[Nm\].
    pub torque: Vec<DVector<f64>>,
}

/// Step of a latent variable in a central difference.
const STEP: f64 = 1e-3;

impl Slopes {
    /// The derivatives at the latent variables `z`.
    pub fn at(model: &Model, spread: &Spread, z: &[f64]) -> Slopes {
        let count = spread.latents.len();
        let mut slopes = Slopes {
            joints: (0..model.dof)
                .map(|j| DMatrix::zeros(features::count(model, j), count))
                .collect(),
            loss: DMatrix::zeros(model.dof, count),
            supply_w: DVector::zeros(count),
        };
        for k in 0..count {
            let moved = |step: f64| {
                let robot = spread.robot(model, |i| z[i] + if i == k { step } else { 0.0 });
                Changes::from_one(model, &robot)
            };
            let (high, low) = (moved(STEP), moved(-STEP));
            let scale = 0.5 / STEP;
            for (j, (a, b)) in high.joints.iter().zip(&low.joints).enumerate() {
                let slope = (a.values.column(0) - b.values.column(0)) * scale;
                slopes.joints[j].set_column(k, &slope);
                slopes.loss[(j, k)] = (a.loss[0] - b.loss[0]) * scale;
            }
            slopes.supply_w[k] = (high.supply_w() - low.supply_w()) * scale;
        }
        slopes
    }
}

impl<'a> Along<'a> {
    /// Evaluates the features at the instants; each window is a range of them.
    pub fn new(model: &'a Model, instants: &[Instant], windows: Vec<Range<usize>>) -> Along<'a> {
        let mut data = Data::new();
        let mut regressor = Regressor::new();
        let rows = instants.len();
        let mut along = Along {
            model,
            windows,
            features: (0..model.dof)
                .map(|j| DMatrix::zeros(rows, features::count(model, j)))
                .collect(),
            rates: instants.iter().map(|instant| instant.state[1]).collect(),
            rests: instants.iter().map(Instant::rests).collect(),
            rest_w: Vec::new(),
        };
        let mut supplies = Vec::with_capacity(rows);
        for (row, Instant { load, state }) in instants.iter().enumerate() {
            let state: [&[f64]; 3] = [&state[0], &state[1], &state[2]];
            let into = (&mut along.features[..], row);
            features::write(model, (&mut data, &mut regressor), load, state, into);
            let power = power_at(model, &mut data, load, state);
            supplies.push(supply_w(model, &mut data, load, state, &power));
        }
        let own = Changes::from_one(model, &Plausible::nominal(model));
        let (terms, _) = along.terms(&own);
        along.rest_w = supplies.iter().zip(terms).map(|(all, term)| all - term).collect();
        along
    }

    /// Torques of each joint: one row per instant, one column per robot \[Nm\].
    pub fn torques(&self, robots: &Changes) -> Vec<DMatrix<f64>> {
        self.features.iter().zip(&robots.joints).map(|(phi, of)| phi * &of.values).collect()
    }

    /// Power of work, copper and braking loss per instant \[W\]; torques per joint \[Nm\].
    fn terms(&self, robot: &Changes) -> (Vec<f64>, Vec<DMatrix<f64>>) {
        let torques = self.torques(robot);
        let terms = (0..self.rates.len()).map(|i| {
            let tau = |j: usize| torques[j][i];
            let copper = robot.joints.iter().enumerate();
            let copper: f64 = copper.map(|(j, of)| of.loss[0] * tau(j) * tau(j)).sum();
            if self.rests[i] {
                return copper;
            }
            let by_joint = |j: usize| tau(j) * self.rates[i][j];
            let work: f64 = (0..self.model.dof).map(by_joint).sum();
            let lost = match self.model.drive.sharing {
                Sharing::Bus => (-work).max(0.0),
                Sharing::None => (0..self.model.dof).map(|j| (-by_joint(j)).max(0.0)).sum(),
            };
            work + copper + (1.0 - self.model.drive.regeneration) * lost
        });
        (terms.collect(), torques)
    }

    /// Means of the windows for a robot.
    pub fn means(&self, robot: &Changes) -> Means {
        let (terms, torques) = self.terms(robot);
        let power = self.averages(|i| terms[i] + self.rest_w[i]).add_scalar(robot.supply_w());
        Means { power, torque: torques.iter().map(|tau| self.averages(|i| tau[i])).collect() }
    }

    /// The mean of a quantity over the instants of each window.
    fn averages(&self, value: impl Fn(usize) -> f64) -> DVector<f64> {
        let mean = |w: &Range<usize>| w.clone().map(&value).sum::<f64>() / w.len() as f64;
        DVector::from_iterator(self.windows.len(), self.windows.iter().map(mean))
    }

    /// Derivatives of the mean powers by the latent variables, one row per window.
    pub fn power_slopes(&self, robot: &Changes, slopes: &Slopes) -> DMatrix<f64> {
        let torques = self.torques(robot);
        let left = 1.0 - self.model.drive.regeneration;
        let braking: Vec<bool> = (0..self.rates.len())
            .map(|i| {
                let work: f64 = (0..self.model.dof).map(|j| torques[j][i] * self.rates[i][j]).sum();
                work < 0.0
            })
            .collect();
        let mut by_power = DMatrix::zeros(self.windows.len(), slopes.supply_w.len());
        for (j, of) in robot.joints.iter().enumerate() {
            let tau = &torques[j];
            let of_power = |i: usize| {
                let rate = self.rates[i][j];
                let lost = match self.model.drive.sharing {
                    Sharing::Bus => braking[i],
                    Sharing::None => tau[i] * rate < 0.0,
                };
                let work = if lost { rate * (1.0 - left) } else { rate };
                2.0 * of.loss[0] * tau[i] + if self.rests[i] { 0.0 } else { work }
            };
            by_power += self.sums(j, &of_power) * &slopes.joints[j];
            let squares = self.averages(|i| tau[i] * tau[i]);
            by_power += squares * slopes.loss.row(j);
        }
        for mut row in by_power.row_iter_mut() {
            row += slopes.supply_w.transpose();
        }
        by_power
    }

    /// Derivatives of the mean torques of each joint, one row per window.
    pub fn torque_slopes<'s>(
        &'s self,
        slopes: &'s Slopes,
    ) -> impl Iterator<Item = DMatrix<f64>> + 's {
        slopes.joints.iter().enumerate().map(|(j, slopes)| self.sums(j, &|_| 1.0) * slopes)
    }

    /// Weighted means of the features of a joint, one row per window.
    fn sums(&self, joint: usize, weight: &dyn Fn(usize) -> f64) -> DMatrix<f64> {
        let phi = &self.features[joint];
        let mut sums = DMatrix::zeros(self.windows.len(), phi.ncols());
        for (w, window) in self.windows.iter().enumerate() {
            let weights: Vec<f64> =
                window.clone().map(|i| weight(i) / window.len() as f64).collect();
            for (p, column) in phi.column_iter().enumerate() {
                let rows = column.as_slice()[window.clone()].iter();
                sums[(w, p)] = rows.zip(&weights).map(|(x, w)| x * w).sum();
            }
        }
        sums
    }

    /// Whether the robot moves at all instants of a window.
    pub fn moves(&self, window: usize) -> bool {
        self.windows[window].clone().all(|i| !self.rests[i])
    }
}

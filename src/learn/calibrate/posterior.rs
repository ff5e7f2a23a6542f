//! Plausible robots that fit a log.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::aligned::correlation;
use super::fold::Windows;
use crate::arm::robot::Model;
use crate::arm::robot::prior::{Spread, standard_normals};
use crate::retime::energy::along::{Along, Means, Slopes};
use crate::retime::energy::change::Changes;

/// Seed of the draws.
const SEED: u64 = 113;
/// Largest number of steps of a fit, and the relative gain below which it ends.
const STEPS: usize = 30;
const GAIN: f64 = 1e-4;
/// Initial damping, its factors after a successful and a failed step, and its upper limit.
const DAMPING: f64 = 1e-2;
const LESS: f64 = 0.2;
const MORE: f64 = 5.0;
const MOST: f64 = 1e8;
/// Largest distance of a draw's misfit from its expected value, in standard deviations.
const WITHIN: f64 = 4.0;

/// Measured window means with the standard deviations of their noise.
pub(super) struct Data {
    power: DVector<f64>,
    /// Power, then the torque of each joint; windows in which it rests have an infinite standard
    /// deviation.
    channels: Vec<(DVector<f64>, DVector<f64>)>,
}

impl Data {
    /// The means of a log's windows.
    pub(super) fn new(along: &Along<'_>, windows: &Windows) -> Data {
        let vector = |values: &Vec<f64>| DVector::from_column_slice(values);
        // At rest, static friction makes the torque indeterminate.
        let moving = |(w, sd): (usize, &f64)| if along.moves(w) { *sd } else { f64::INFINITY };
        let torque = windows.torque.iter().map(|(tau, sd)| {
            let sd = sd.iter().enumerate().map(moving).collect::<Vec<f64>>();
            (vector(tau), vector(&sd))
        });
        let power = vector(&windows.power);
        let of_power = (power.clone(), vector(&windows.power_sd));
        Data { power, channels: std::iter::once(of_power).chain(torque).collect() }
    }

    /// The same data with the variance of the noise multiplied by `factor`.
    pub(super) fn with_noise(&self, factor: f64) -> Data {
        let scale = factor.sqrt();
        let channels = self.channels.iter().map(|(values, sd)| (values.clone(), sd * scale));
        Data { power: self.power.clone(), channels: channels.collect() }
    }

    /// Share of the power's variance that a robot explains.
    pub(super) fn explained(&self, means: &Means) -> f64 {
        let mean = self.power.mean();
        let all: f64 = self.power.iter().map(|w| (w - mean).powi(2)).sum();
        1.0 - (&self.power - &means.power).norm_squared() / all.max(f64::MIN_POSITIVE)
    }

    /// Correlation of the measured power with that of a robot.
    pub(super) fn correlation(&self, means: &Means) -> f64 {
        correlation(self.power.as_slice(), means.power.as_slice())
    }

    /// Which residuals have a finite standard deviation.
    fn counted(&self) -> Vec<bool> {
        self.channels.iter().flat_map(|(_, sd)| sd.iter().map(|sd| sd.is_finite())).collect()
    }

    fn count(&self) -> usize {
        self.counted().iter().filter(|counts| **counts).count()
    }

    /// Residuals over their standard deviations: power, then each torque.
    fn residuals(&self, means: &Means) -> DVector<f64> {
        let expected = std::iter::once(&means.power).chain(&means.torque);
        let all = self.channels.iter().zip(expected).flat_map(|((values, sd), expected)| {
            (values - expected).component_div(sd).iter().copied().collect::<Vec<f64>>()
        });
        DVector::from_vec(all.collect())
    }
}

/// A robot fitted to the log.
pub(super) struct Fitted {
    pub(super) z: Vec<f64>,
    pub(super) means: Means,
    misfit: f64,
    /// Number of latent parameters that the log determines.
    decided: f64,
}

/// A fit of the latent parameters to data.
pub(super) struct Fit<'a> {
    pub(super) model: &'a Model,
    pub(super) spread: &'a Spread,
    pub(super) along: &'a Along<'a>,
    pub(super) data: &'a Data,
}

impl Fit<'_> {
    /// The most likely robot.
    pub(super) fn most_likely(&self) -> Fitted {
        let zero = vec![0.0; self.spread.latents.len()];
        let none = DVector::zeros(self.data.counted().len());
        self.nearest(&zero, &zero, &none)
    }

    /// Residual variance of the most likely robot over the variance of the noise.
    pub(super) fn misfit_over_noise(&self, likely: &Fitted) -> f64 {
        likely.misfit / (self.data.count() as f64 - likely.decided).max(1.0)
    }

    /// Plausible robots, each fitted to the log with its own noise added.
    pub(super) fn draws(&self, likely: &[f64], robots: usize) -> Vec<Vec<f64>> {
        let count = self.spread.latents.len();
        let counted = self.data.counted();
        let noise_count = counted.len();
        let normals = standard_normals(count + noise_count, robots, SEED);
        // The residuals contain the added noise and that of the log: twice the variance.
        let m = self.data.count() as f64;
        let bound = 2.0 * (m + WITHIN * (2.0 * m).sqrt());
        let draw = |i: usize| {
            let prior: Vec<f64> = normals[..count].iter().map(|x| x[i]).collect();
            let noise = normals[count..].iter().zip(&counted);
            let noise = noise.map(|(x, counts)| if *counts { x[i] } else { 0.0 });
            let noise = DVector::from_iterator(noise_count, noise);
            let fitted = self.nearest(likely, &prior, &noise);
            (fitted.misfit <= bound).then_some(fitted.z)
        };
        (0..robots).into_par_iter().filter_map(draw).collect()
    }

    fn means(&self, z: &[f64]) -> Means {
        self.along.means(&self.change(z))
    }

    fn change(&self, z: &[f64]) -> Changes {
        Changes::from_one(self.model, &self.spread.robot(self.model, |k| z[k]))
    }

    /// The robot that minimises the squared distance from `prior` and from the log with added
    /// `noise`, from `start` on (Levenberg–Marquardt).
    fn nearest(&self, start: &[f64], prior: &[f64], noise: &DVector<f64>) -> Fitted {
        let prior = DVector::from_column_slice(prior);
        let mut z = DVector::from_column_slice(start);
        let cost = |z: &DVector<f64>, residuals: &DVector<f64>| {
            residuals.norm_squared() + (z - &prior).norm_squared()
        };
        let mut means = self.means(z.as_slice());
        let mut residuals = self.data.residuals(&means) + noise;
        let mut best = cost(&z, &residuals);
        let mut damping = DAMPING;
        let mut decided = 0.0;
        for _ in 0..STEPS {
            let (normal, gradient) = self.normal_equations(&z, &residuals);
            let gradient = gradient - (&z - &prior);
            let unit = DMatrix::identity(z.len(), z.len());
            if let Some(inverse) = (&normal + &unit).cholesky() {
                decided = z.len() as f64 - inverse.inverse().trace();
            }
            let mut gained = 0.0;
            while damping < MOST {
                let system = &normal + &unit * (1.0 + damping);
                let Some(factor) = system.cholesky() else {
                    damping *= MORE;
                    continue;
                };
                let next = &z + factor.solve(&gradient);
                let new = self.means(next.as_slice());
                let left = self.data.residuals(&new) + noise;
                let value = cost(&next, &left);
                if value < best {
                    gained = best - value;
                    (z, means, residuals, best) = (next, new, left, value);
                    damping *= LESS;
                    break;
                }
                damping *= MORE;
            }
            if gained <= GAIN * best.max(1.0) {
                break;
            }
        }
        Fitted { z: z.as_slice().to_vec(), means, misfit: residuals.norm_squared(), decided }
    }

    /// `JᵀJ` and `Jᵀr` of the residuals over their standard deviations.
    fn normal_equations(
        &self,
        z: &DVector<f64>,
        residuals: &DVector<f64>,
    ) -> (DMatrix<f64>, DVector<f64>) {
        let z = z.as_slice();
        let slopes = Slopes::at(self.model, self.spread, z);
        let by_power = self.along.power_slopes(&self.change(z), &slopes);
        let count = z.len();
        let mut normal = DMatrix::zeros(count, count);
        let mut gradient = DVector::zeros(count);
        let windows = self.data.power.len();
        let by_channel = std::iter::once(by_power).chain(self.along.torque_slopes(&slopes));
        let all = self.data.channels.iter().zip(by_channel);
        for (part, ((_, sd), mut slope)) in all.enumerate() {
            for (mut row, sd) in slope.row_iter_mut().zip(sd.iter()) {
                row /= *sd;
            }
            normal.gemm_tr(1.0, &slope, &slope, 1.0);
            gradient.gemv_tr(1.0, &slope, &residuals.rows(part * windows, windows), 1.0);
        }
        (normal, gradient)
    }
}

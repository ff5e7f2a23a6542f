//! The difference between measurement and model, and all that may explain it, as rows of
//! spectra.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::effects::{self, Effect, Form, Motion, Of};

use super::channel::Channel;
use super::column::{Column, Owner, Piece, pieces};
use super::evidence::Evidence;
use super::generic::generic;
use super::nuisance::{Nuisance, Trust, nuisance};
use super::record::Record;
use super::spectrum::Spectrum;

/// A piece with its place among the columns.
pub struct Placed {
    /// Whose it is.
    pub owner: Owner,
    /// Joint, from 0; `None` of the robot.
    pub joint: Option<usize>,
    /// Values of its coordinates; 1 usual size for linear ones.
    pub shape: Vec<f64>,
    /// Shapes that are tried at the joint.
    pub choices: usize,
    /// Its columns.
    pub columns: std::ops::Range<usize>,
}

/// Rows of all joints and records.
pub struct Table {
    /// All that may explain the difference.
    pub pieces: Vec<Placed>,
    /// Names of the parameters of the model.
    pub parameters: Vec<String>,
    /// Their deviations, in their units.
    pub deviations: Vec<f64>,
    means: DVector<f64>,
    sds: DVector<f64>,
    joints: Vec<Rows>,
}

/// Rows of one joint.
struct Rows {
    /// Difference, parameters, then columns that reach the joint, as they are logged.
    values: DMatrix<f64>,
    /// The same before the channel, and the model's torque and the measured one.
    plain: DMatrix<f64>,
    model: Vec<f64>,
    measured: Vec<f64>,
    /// Of each row \[Hz\]; 0 of a mean. Rows of one frequency are real and imaginary part.
    frequency: Vec<f64>,
    /// Numbers of these columns.
    reached: Vec<usize>,
    noise: Vec<f64>,
    power: Vec<f64>,
}

impl Table {
    /// Of records of one robot, with the effects that may be found.
    #[must_use]
    pub fn new(records: &[Record<'_>], effects: &[&'static Effect], trust: Trust) -> Table {
        let motions: Vec<&Motion<'_>> = records.iter().map(|record| &record.motion).collect();
        let n = motions.first().map_or(0, |motion| motion.model.dof);
        let wanted: Vec<(Option<&'static Effect>, usize)> = effects
            .iter()
            .filter(|e| e.channel == effects::Channel::Torque && !matches!(e.form, Form::Elsewhere))
            .flat_map(|effect| {
                let joints = (effect.joints)(n);
                let joints = if effect.of == Of::Robot {
                    joints.into_iter().take(1).collect()
                } else {
                    joints
                };
                joints.into_iter().map(|joint| (Some(*effect), joint))
            })
            .chain((0..n).map(|joint| (None, joint)))
            .collect();
        let all: Vec<Piece> = wanted
            .into_par_iter()
            .flat_map_iter(|(effect, joint)| match effect {
                Some(effect) => pieces(effect, &motions, joint),
                None => generic(&motions, joint),
            })
            .collect();
        Table::of(records, all, trust)
    }

    /// Of records and pieces that are given.
    #[must_use]
    pub fn of(records: &[Record<'_>], all: Vec<Piece>, trust: Trust) -> Table {
        let n = records.first().map_or(0, |record| record.motion.model.dof);
        let nuisances: Vec<Nuisance> =
            records.par_iter().map(|record| nuisance(&record.motion, trust)).collect();
        let joints = (0..n)
            .into_par_iter()
            .map(|joint| Rows::new(records, &nuisances, &all, joint))
            .collect();
        let mut means = Vec::new();
        let mut sds = Vec::new();
        let mut placed = Vec::new();
        for piece in all {
            let from = means.len();
            means.extend(piece.columns.iter().map(|column| column.mean));
            sds.extend(piece.columns.iter().map(|column| column.sd));
            placed.push(Placed {
                owner: piece.owner,
                joint: piece.joint,
                shape: piece.shape,
                choices: piece.choices,
                columns: from..means.len(),
            });
        }
        let (parameters, deviations) = nuisances
            .into_iter()
            .next()
            .map_or_else(Default::default, |of| (of.names, of.deviations));
        Table {
            pieces: placed,
            parameters,
            deviations,
            means: DVector::from_vec(means),
            sds: DVector::from_vec(sds),
            joints,
        }
    }

    /// Puts a piece in the place of another one of the same effect and joint.
    pub(super) fn replace(&mut self, number: usize, piece: Piece, records: &[Record<'_>]) {
        let placed = &mut self.pieces[number];
        placed.shape.clone_from(&piece.shape);
        let parameters = self.parameters.len();
        for (k, column) in placed.columns.clone().zip(&piece.columns) {
            self.means[k] = column.mean;
            self.sds[k] = column.sd;
            for (joint, rows) in self.joints.iter_mut().enumerate() {
                let Ok(place) = rows.reached.binary_search(&k) else { continue };
                let mut first = 0;
                for (record, series) in records.iter().zip(&column.series) {
                    let count = record.spectrum.rows();
                    if let Some((_, series)) = series.iter().find(|(of, _)| *of == joint) {
                        let spectrum = record.rows_of(joint, series);
                        let to = 1 + parameters + place;
                        rows.plain.view_mut((first, to), (count, 1)).copy_from_slice(&spectrum);
                    }
                    first += count;
                }
            }
        }
    }

    /// All that is computed goes through a channel before it is compared.
    pub(super) fn through(&mut self, channel: &Channel) {
        self.joints.par_iter_mut().for_each(|rows| rows.through(channel));
    }

    /// How well everything explains the difference if the model's torques are known to the
    /// share `error` of their own.
    #[must_use]
    pub fn evidence(&self, error: f64) -> Evidence {
        let parameters = self.parameters.len();
        let count = self.means.len();
        let size = 1 + parameters + count;
        let mut gram = DMatrix::zeros(size, size);
        let mut log_weights = 0.0;
        let mut rows = 0;
        let parts: Vec<(DMatrix<f64>, f64)> =
            self.joints.par_iter().map(|joint| joint.gram(error)).collect();
        for (joint, (part, log_weight)) in self.joints.iter().zip(parts) {
            log_weights += log_weight;
            rows += joint.noise.len();
            let place = |k: usize| {
                if k <= parameters { k } else { 1 + parameters + joint.reached[k - 1 - parameters] }
            };
            for a in 0..part.nrows() {
                for b in 0..part.ncols() {
                    gram[(place(a), place(b))] += part[(a, b)];
                }
            }
        }
        Evidence::new(&gram, parameters, self.means.clone(), self.sds.clone(), log_weights, rows)
    }
}

impl Rows {
    fn new(records: &[Record<'_>], nuisances: &[Nuisance], all: &[Piece], joint: usize) -> Rows {
        let parameters = nuisances.first().map_or(0, |of| of.names.len());
        let columns = || all.iter().flat_map(|piece| &piece.columns);
        let reaches = |column: &&Column| column.series.iter().flatten().any(|(of, _)| *of == joint);
        let reached: Vec<usize> =
            columns().enumerate().filter_map(|(k, column)| reaches(&column).then_some(k)).collect();
        let height = records.iter().map(|record| record.spectrum.rows()).sum();
        let mut values = DMatrix::zeros(height, 1 + parameters + reached.len());
        let (mut noise, mut power, mut frequency) = (Vec::new(), Vec::new(), Vec::new());
        let (mut model, mut measured) = (Vec::new(), Vec::new());
        let mut first = 0;
        for (number, (record, nuisance)) in records.iter().zip(nuisances).enumerate() {
            let rows = record.spectrum.rows();
            let mut write = |to: usize, series: &[f64]| {
                let spectrum = record.rows_of(joint, series);
                values.view_mut((first, to), (rows, 1)).copy_from_slice(&spectrum);
            };
            model.extend(record.rows_of(joint, &record.motion.torque[joint]));
            measured.extend(record.rows_of(joint, &record.measured[joint]));
            for (k, of) in nuisance.series.iter().enumerate() {
                write(1 + k, &of[joint]);
            }
            let mut to = 1 + parameters;
            for column in columns().filter(reaches) {
                if let Some((_, series)) = column.series[number].iter().find(|(of, _)| *of == joint)
                {
                    write(to, series);
                }
                to += 1;
            }
            for row in 0..rows {
                let bin = Spectrum::bin(row);
                frequency.push(bin as f64 / (record.motion.step() * record.motion.len() as f64));
                noise.push(record.noise[joint][bin]);
                power.push(record.power[joint][bin]);
            }
            first += rows;
        }
        let plain = values.clone();
        let mut rows = Rows { values, plain, model, measured, frequency, reached, noise, power };
        rows.through(&Channel::default());
        rows
    }

    fn through(&mut self, channel: &Channel) {
        let mut row = 0;
        while row < self.frequency.len() {
            let frequency = self.frequency[row];
            if frequency == 0.0 {
                self.values[(row, 0)] = self.measured[row] - self.model[row];
                for k in 1..self.values.ncols() {
                    self.values[(row, k)] = self.plain[(row, k)];
                }
                row += 1;
                continue;
            }
            let [re, im] = channel.response(frequency);
            let turned = |[a, b]: [f64; 2]| [re * a - im * b, re * b + im * a];
            let model = turned([self.model[row], self.model[row + 1]]);
            for part in 0..2 {
                self.values[(row + part, 0)] = self.measured[row + part] - model[part];
            }
            for k in 1..self.values.ncols() {
                let both = turned([self.plain[(row, k)], self.plain[(row + 1, k)]]);
                self.values[(row, k)] = both[0];
                self.values[(row + 1, k)] = both[1];
            }
            row += 2;
        }
    }

    /// Products of all columns, weighted, and the sum of the logarithms of the weights' roots.
    fn gram(&self, error: f64) -> (DMatrix<f64>, f64) {
        let mut weighted = self.values.clone();
        let mut log_weights = 0.0;
        for (row, (noise, power)) in self.noise.iter().zip(&self.power).enumerate() {
            let variance = (noise + error * error * power).max(1e-18);
            let weight = 1.0 / variance.sqrt();
            log_weights += weight.ln();
            weighted.row_mut(row).scale_mut(weight);
        }
        (weighted.tr_mul(&weighted), log_weights)
    }
}

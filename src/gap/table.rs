//! The difference between measurement and model, and all that may explain it, as rows of
//! spectra.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::effects::{self, Effect, Form, Of};

use super::channel::Channel;
use super::column::{Column, Owner, Piece, pieces};
use super::evidence::Evidence;
use super::generic::generic;
use super::nuisance::{Nuisance, Trust, nuisance};
use super::record::Record;
use super::rows::Rows;

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
    /// Names of the parameters of the model, then of what no model has.
    pub parameters: Vec<String>,
    /// Their deviations, in their units.
    pub deviations: Vec<f64>,
    /// Changes of the standard parameters for one deviation of each of the model's.
    pub mixing: DMatrix<f64>,
    /// Parameters from here on are in shares of the model's error.
    errors_from: usize,
    means: DVector<f64>,
    sds: DVector<f64>,
    joints: Vec<Rows>,
}

impl Table {
    /// Of records of one robot, with the effects that may be found.
    #[must_use]
    pub fn new(records: &[Record<'_>], effects: &[&'static Effect], trust: Trust) -> Table {
        let n = records.first().map_or(0, |record| record.motion.model.dof);
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
                Some(effect) => pieces(effect, records, joint),
                None => generic(records, joint),
            })
            .collect();
        Table::of(records, all, &nuisances(records, trust))
    }

    /// Of records and pieces that are given.
    #[must_use]
    pub(super) fn of(records: &[Record<'_>], all: Vec<Piece>, nuisances: &[Nuisance]) -> Table {
        let n = records.first().map_or(0, |record| record.motion.model.dof);
        let columns: Vec<&Column> = all.iter().flat_map(|piece| &piece.columns).collect();
        let joints = (0..n)
            .into_par_iter()
            .map(|joint| Rows::new(records, nuisances, &columns, joint))
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
        let first = nuisances.first();
        Table {
            pieces: placed,
            parameters: first.map_or_else(Vec::new, |of| of.names.clone()),
            deviations: first.map_or_else(Vec::new, |of| of.deviations.clone()),
            mixing: first.map_or_else(|| DMatrix::zeros(0, 0), |of| of.mixing.clone()),
            errors_from: first.map_or(0, |of| of.errors_from),
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
                rows.replace(1 + parameters + k, column, joint, records);
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
        let size = 1 + parameters + self.means.len();
        let mut gram = DMatrix::zeros(size, size);
        let mut log_weights = 0.0;
        let mut rows = 0;
        let parts: Vec<(DMatrix<f64>, f64)> =
            self.joints.par_iter().map(|joint| joint.gram(error)).collect();
        for (joint, (part, log_weight)) in self.joints.iter().zip(parts) {
            log_weights += log_weight;
            rows += joint.len();
            let reached = joint.reached();
            for (b, to) in reached.iter().enumerate() {
                for (a, from) in reached.iter().enumerate() {
                    gram[(*from, *to)] += part[(a, b)];
                }
            }
        }
        for k in 1 + self.errors_from..=parameters {
            gram.row_mut(k).scale_mut(error);
            gram.column_mut(k).scale_mut(error);
        }
        Evidence::new(&gram, parameters, self.means.clone(), self.sds.clone(), log_weights, rows)
    }
}

/// The parameters' columns of each record.
pub(super) fn nuisances(records: &[Record<'_>], trust: Trust) -> Vec<Nuisance> {
    records.par_iter().map(|record| nuisance(record, trust)).collect()
}

//! The difference between measurement and model, and all that may explain it, as rows of
//! spectra.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::arm::effects::{self, Effect, Form, Response, Scope};

use super::column::{Column, Owner, Piece, pieces};
use super::evidence::{Evidence, Products};
use super::generic::generic;
use super::nuisance::{Common, Nuisance, Trust, nuisance, smooth_error};
use super::record::{Record, RecordKind};
use super::ripples::ripples;
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
    pub(super) errors_from: usize,
    /// How many times more than believed the model's parameters may be off.
    spread: f64,
    pub(super) means: DVector<f64>,
    pub(super) sds: DVector<f64>,
    /// Columns that others have replaced since all was weighed.
    pub(super) changed: BTreeSet<usize>,
    joints: Vec<Rows>,
}

impl Table {
    /// Of records of one robot, with the effects that may be found and with pieces `more`.
    #[must_use]
    pub(super) fn new(
        records: &[Record<'_>],
        effects: &[&'static Effect],
        trust: Trust,
        more: Vec<Piece>,
    ) -> Table {
        let n = records.first().map_or(0, |record| record.motion.model.dof);
        // What the last link has more is what it carries.
        let carries = effects.iter().any(|effect| effect.id == "payload");
        let is_load = |effect: &Effect, joint: usize| {
            carries && effect.id == "link_parameters" && joint + 1 == n
        };
        let wanted: Vec<(Option<&'static Effect>, usize)> = effects
            .iter()
            .filter(|e| e.channel == effects::Channel::Torque && !matches!(e.form, Form::Elsewhere))
            .filter(|e| !["current_sign", "time_delay", "filter_lag"].contains(&e.id))
            .flat_map(|effect| {
                let joints = (effect.joints)(n);
                let joints = if effect.scope == Scope::Robot {
                    joints.into_iter().take(1).collect()
                } else {
                    joints
                };
                joints.into_iter().map(|joint| (Some(*effect), joint))
            })
            .filter(|(effect, joint)| effect.is_none_or(|effect| !is_load(effect, *joint)))
            .chain((0..n).map(|joint| (None, joint)))
            .collect();
        let all: Vec<Piece> = wanted
            .into_par_iter()
            .flat_map_iter(|(effect, joint)| match effect {
                Some(effect) if effect.id == "ripple" => ripples(effect, records, joint),
                Some(effect) => pieces(effect, records, joint),
                None => generic(records, joint),
            })
            .chain(more)
            .collect();
        Table::of(records, all, &nuisances(records, trust))
    }

    /// Of records and pieces that are given.
    #[must_use]
    pub(super) fn of(records: &[Record<'_>], all: Vec<Piece>, nuisances: &[Nuisance]) -> Table {
        let n = records.first().map_or(0, |record| record.motion.model.dof);
        let columns: Vec<&Column> = all.iter().flat_map(|piece| &piece.columns).collect();
        let kinds = [RecordKind::Mean, RecordKind::Drift, RecordKind::Before];
        let joints = (0..kinds.len() * n)
            .into_par_iter()
            .map(|i| {
                Rows::new(records, nuisances, &columns, i / kinds.len(), kinds[i % kinds.len()])
            })
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
            spread: 1.0,
            means: DVector::from_vec(means),
            sds: DVector::from_vec(sds),
            changed: BTreeSet::new(),
            joints,
        }
    }

    /// Puts a piece in the place of another one of the same effect and joint.
    pub(super) fn replace(&mut self, number: usize, piece: &Piece, records: &[Record<'_>]) {
        let placed = &mut self.pieces[number];
        placed.shape.clone_from(&piece.shape);
        let parameters = self.parameters.len();
        self.changed.extend(placed.columns.clone());
        for (k, column) in placed.columns.clone().zip(&piece.columns) {
            self.means[k] = column.mean;
            self.sds[k] = column.sd;
            for rows in &mut self.joints {
                rows.replace(1 + parameters + k, column, records);
            }
        }
    }

    /// The measured torque of a joint is taken with the other sign.
    pub(super) fn flip(&mut self, joint: usize) {
        self.joints.iter_mut().for_each(|rows| rows.flip(joint));
    }

    /// All that is computed goes through the channel of its joint before it is compared.
    pub(super) fn through_all(&mut self, records: &[Record<'_>], channels: &[Response]) {
        self.through_where(records, channels, |_| true);
    }

    /// The same of the model, its parameters and some columns, whose numbers rise.
    pub(super) fn through(
        &mut self,
        records: &[Record<'_>],
        channels: &[Response],
        columns: &[usize],
    ) {
        let first = 1 + self.parameters.len();
        self.through_where(records, channels, |number| {
            number < first || columns.binary_search(&(number - first)).is_ok()
        });
    }

    /// The same of some columns alone.
    pub(super) fn through_columns(
        &mut self,
        records: &[Record<'_>],
        channels: &[Response],
        columns: &[usize],
    ) {
        let first = 1 + self.parameters.len();
        self.through_where(records, channels, |number| {
            number >= first && columns.binary_search(&(number - first)).is_ok()
        });
    }

    fn through_where(
        &mut self,
        records: &[Record<'_>],
        channels: &[Response],
        is_used: impl Fn(usize) -> bool + Sync,
    ) {
        self.joints.par_iter_mut().for_each(|rows| rows.through(records, channels, &is_used));
    }

    /// How well everything explains the difference if the model's torques are known to the
    /// share `error` of their own.
    #[must_use]
    pub fn evidence(&self, error: f64) -> Evidence {
        let all: Vec<usize> = (0..self.means.len()).collect();
        self.evidence_of(error, &all)
    }

    /// How probable the measurement of one joint is, without any column, behind channels.
    pub(super) fn of_joint(
        &mut self,
        records: &[Record<'_>],
        joint: usize,
        channels: &[Response],
        error: f64,
    ) -> Evidence {
        let parameters = self.parameters.len();
        let place = |number: usize| (number <= parameters).then_some(number);
        let mut gram = DMatrix::zeros(1 + parameters, 1 + parameters);
        let mut log_weights = 0.0;
        for rows in self.joints.iter_mut().filter(|rows| rows.is_mean_of(joint)) {
            rows.through(records, channels, |number| number <= parameters);
            let (part, reached, log_weight) = rows.gram(error, place);
            add(&mut gram, &part, &reached);
            log_weights += log_weight;
        }
        self.scale(&mut gram, error);
        let none = || DVector::zeros(0);
        Evidence::new(&gram, parameters, none(), none(), log_weights)
    }

    /// Frequencies beyond a bin count no more.
    pub(super) fn limit(&mut self, highest: usize) {
        self.joints.iter_mut().for_each(|rows| rows.highest = highest);
    }

    /// Number of the bins of the longest record.
    pub(super) fn bins(&self) -> usize {
        let spectra = self.joints.iter().flat_map(|rows| &rows.spectra);
        spectra.map(|spectrum| spectrum.bins).max().unwrap_or(0)
    }

    /// Lets the model's parameters be off by so many times what is believed.
    pub(super) fn set_spread(&mut self, spread: f64) {
        let more = spread / self.spread;
        self.spread = spread;
        self.mixing *= more;
        let count = self.mixing.ncols();
        self.deviations[..count].iter_mut().for_each(|of| *of *= more);
    }

    /// Factors of the columns of the parameters: some are in shares of the model's error.
    pub(super) fn scales(&self, error: f64) -> Vec<f64> {
        let mut scales = vec![1.0; self.parameters.len()];
        scales[..self.mixing.ncols()].fill(self.spread);
        scales[self.errors_from..].fill(smooth_error(error));
        scales
    }

    /// Scales the columns of the parameters.
    fn scale(&self, gram: &mut DMatrix<f64>, error: f64) {
        for (k, scale) in self.scales(error).into_iter().enumerate() {
            gram.row_mut(1 + k).scale_mut(scale);
            gram.column_mut(1 + k).scale_mut(scale);
        }
    }

    /// Places of the difference, the parameters and some columns by number.
    pub(super) fn places_of(&self, columns: &[usize]) -> Vec<Option<usize>> {
        let parameters = self.parameters.len();
        let mut places = vec![None; 1 + parameters + self.means.len()];
        for (k, place) in places.iter_mut().enumerate().take(1 + parameters) {
            *place = Some(k);
        }
        for (k, column) in columns.iter().enumerate() {
            places[1 + parameters + column] = Some(1 + parameters + k);
        }
        places
    }

    /// Weighted products of the difference, the parameters and some columns, and the sum of the
    /// logarithms of the weights' roots.
    pub(super) fn gram_of(&self, error: f64, columns: &[usize]) -> (DMatrix<f64>, f64) {
        let size = 1 + self.parameters.len() + columns.len();
        let places = self.places_of(columns);
        let parts: Vec<(DMatrix<f64>, Vec<usize>, f64)> =
            self.joints.par_iter().map(|rows| rows.gram(error, |number| places[number])).collect();
        let mut gram = DMatrix::zeros(size, size);
        let mut log_weights = 0.0;
        for (part, reached, log_weight) in parts {
            log_weights += log_weight;
            add(&mut gram, &part, &reached);
        }
        self.scale(&mut gram, error);
        (gram, log_weights)
    }

    /// Products of some columns, by their places among others, with all of these.
    pub(super) fn products_of(&self, error: f64, columns: &[usize], of: Vec<usize>) -> Products {
        let parameters = self.parameters.len();
        let places = self.places_of(columns);
        let numbers: Vec<usize> = of.iter().map(|k| 1 + parameters + columns[*k]).collect();
        let parts: Vec<_> = self
            .joints
            .par_iter()
            .filter_map(|rows| rows.products(error, |number| places[number], &numbers))
            .collect();
        let mut with = DMatrix::zeros(1 + parameters + columns.len(), of.len());
        for (part, [rows, to]) in parts {
            for (k, to) in to.iter().enumerate() {
                for (i, row) in rows.iter().enumerate() {
                    with[(*row, *to)] += part[(i, k)];
                }
            }
        }
        for (k, scale) in self.scales(error).into_iter().enumerate() {
            with.row_mut(1 + k).scale_mut(scale);
        }
        let of_all = |x: &DVector<f64>| of.iter().map(|k| x[columns[*k]]).collect();
        let (means, sds) = (of_all(&self.means), of_all(&self.sds));
        Products { of, with, means, sds }
    }

    /// Weighted products of everything with noise, by draw.
    pub(super) fn products_with_noise(
        &self,
        error: f64,
        draws: usize,
        normal: &mut impl FnMut() -> f64,
    ) -> DMatrix<f64> {
        let columns: Vec<usize> = (0..self.means.len()).collect();
        let places = self.places_of(&columns);
        let mut products = DMatrix::zeros(places.len(), draws);
        for rows in &self.joints {
            let noise = DMatrix::from_fn(rows.len(), draws, |_, _| normal());
            let (part, reached) = rows.products_with(error, |number| places[number], &noise);
            for (row, place) in part.row_iter().zip(reached) {
                let mut to = products.row_mut(place);
                to += row;
            }
        }
        for (k, scale) in self.scales(error).into_iter().enumerate() {
            products.row_mut(1 + k).scale_mut(scale);
        }
        products
    }

    /// Variance of what noise, error and excess make of a joint's torque \[N²m²\].
    pub(super) fn variance(&self, joint: usize, error: f64) -> f64 {
        let of_joint = self.joints.iter().filter(|rows| rows.is_mean_of(joint));
        of_joint.map(|rows| rows.variance(error)).sum()
    }

    /// Calls `of` for the rows of each joint.
    pub(super) fn each_rows(&mut self, of: impl Fn(&mut Rows) -> f64 + Send + Sync) -> Vec<f64> {
        self.joints.par_iter_mut().map(of).collect()
    }

    /// The same of some columns alone, which count in their order.
    pub(super) fn evidence_of(&self, error: f64, columns: &[usize]) -> Evidence {
        let (gram, log_weights) = self.gram_of(error, columns);
        let of =
            |x: &DVector<f64>| DVector::from_iterator(columns.len(), columns.iter().map(|k| x[*k]));
        let count = self.parameters.len();
        Evidence::new(&gram, count, of(&self.means), of(&self.sds), log_weights)
    }
}

/// Adds products of columns at their places.
fn add(gram: &mut DMatrix<f64>, part: &DMatrix<f64>, places: &[usize]) {
    for (b, to) in places.iter().enumerate() {
        for (a, from) in places.iter().enumerate() {
            gram[(*from, *to)] += part[(a, b)];
        }
    }
}

/// The parameters' columns of each record.
pub(super) fn nuisances(records: &[Record<'_>], trust: Trust) -> Vec<Nuisance> {
    let is_mean = |record: &&Record<'_>| record.kind != RecordKind::Drift;
    let common = Common::new(records);
    records
        .par_iter()
        .enumerate()
        .map(|(number, record)| {
            let place = records[..number].iter().filter(is_mean).count();
            nuisance(record, trust, &common, place)
        })
        .collect()
}

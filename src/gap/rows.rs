//! Rows of one joint in all records of a kind: the difference, and what may explain it there.

use nalgebra::{DMatrix, DVector};

use crate::arm::effects::Response;

use super::column::Column;
use super::nuisance::Nuisance;
use super::record::{Record, RecordKind};
use super::spectrum::Spectrum;

/// Least variance of a row \[N²m²\].
const LEAST: f64 = 1e-18;
/// Columns whose products are made at once.
const BLOCK: usize = 128;

/// Rows of one joint in all records of a kind.
pub(super) struct Rows {
    joint: usize,
    kind: RecordKind,
    /// Difference, then the columns that reach the joint, as they are logged.
    pub(super) values: DMatrix<f64>,
    /// Of each column, of each record of the kind, its series before the channel.
    plain: Vec<Vec<Option<Vec<f64>>>>,
    measured: Vec<f64>,
    /// Numbers of the columns: 0 is the difference, then parameters, then what may be found.
    reached: Vec<usize>,
    pub(super) noise: Vec<f64>,
    pub(super) power: Vec<f64>,
    /// Variance beyond noise and error \[N²m²\].
    pub(super) excess: Vec<f64>,
    /// Frequency of each row, and the highest one that counts, in numbers of bins.
    bins: Vec<usize>,
    pub(super) highest: usize,
    /// Of the records of the kind.
    pub(super) spectra: Vec<Spectrum>,
}

/// Factors of some columns, and how well they are known.
pub(super) struct Posterior {
    /// Place of each column by its number, from 1; the difference has 0.
    pub(super) places: Vec<Option<usize>>,
    pub(super) mean: DVector<f64>,
    pub(super) covariance: DMatrix<f64>,
}

impl Rows {
    /// Of all records of a kind.
    pub(super) fn new(
        all: &[Record<'_>],
        nuisances: &[Nuisance],
        columns: &[&Column],
        joint: usize,
        kind: RecordKind,
    ) -> Rows {
        let numbers: Vec<usize> =
            (0..all.len()).filter(|number| all[*number].kind == kind).collect();
        let records: Vec<&Record<'_>> = numbers.iter().map(|number| &all[*number]).collect();
        let parameters = nuisances.first().map_or(0, |of| of.series.len());
        let of_parameter = |at: usize, k: usize| find(&nuisances[numbers[at]].series[k], joint);
        let of_column = |at: usize, k: usize| find(&columns[k].series[numbers[at]], joint);
        let mut reached = vec![0];
        reached.extend((0..parameters).filter_map(|k| {
            let there = (0..records.len()).any(|record| of_parameter(record, k).is_some());
            there.then_some(1 + k)
        }));
        reached.extend((0..columns.len()).filter_map(|k| {
            let there = (0..records.len()).any(|record| of_column(record, k).is_some());
            there.then_some(1 + parameters + k)
        }));
        let height = records.iter().map(|record| record.spectrum.rows()).sum();
        let (mut noise, mut power, mut measured) = (Vec::new(), Vec::new(), Vec::new());
        let mut bins = Vec::new();
        for record in &records {
            measured.extend(record.rows_of(joint, &record.measured[joint]));
            for row in 0..record.spectrum.rows() {
                let bin = Spectrum::bin(row);
                bins.push(bin);
                noise.push(record.noise[joint][bin]);
                power.push(record.power[joint][bin]);
            }
        }
        let series = |number: usize, k: usize| -> Option<Vec<f64>> {
            match (k, kind) {
                (0, RecordKind::Mean | RecordKind::Before) => {
                    Some(records[number].motion.torque[joint].clone())
                }
                (0, RecordKind::Drift) => None,
                (k, _) if k <= parameters => of_parameter(number, k - 1).cloned(),
                (k, _) => of_column(number, k - 1 - parameters).cloned(),
            }
        };
        let plain = reached
            .iter()
            .map(|k| (0..records.len()).map(|number| series(number, *k)).collect())
            .collect();
        let values = DMatrix::zeros(height, reached.len());
        let excess = vec![0.0; height];
        let spectra = records.iter().map(|record| record.spectrum.clone()).collect();
        let mut rows = Rows {
            joint,
            kind,
            values,
            plain,
            measured,
            reached,
            noise,
            power,
            excess,
            bins,
            highest: usize::MAX,
            spectra,
        };
        rows.through(all, &[], |_| true);
        rows
    }

    pub(super) fn len(&self) -> usize {
        self.noise.len()
    }

    /// Another column in the place of the one with the number.
    pub(super) fn replace(&mut self, number: usize, column: &Column, records: &[Record<'_>]) {
        let Ok(place) = self.reached.binary_search(&number) else { return };
        let of_kind = |(record, _): &(&Record<'_>, _)| record.kind == self.kind;
        let of = records.iter().zip(&column.series).filter(of_kind);
        for ((_, series), plain) in of.zip(&mut self.plain[place]) {
            *plain = find(series, self.joint).cloned();
        }
    }

    pub(super) fn is_mean_of(&self, joint: usize) -> bool {
        self.joint == joint && self.kind == RecordKind::Mean
    }

    pub(super) fn flip(&mut self, joint: usize) {
        if joint == self.joint && self.kind != RecordKind::Before {
            self.measured.iter_mut().for_each(|x| *x = -*x);
            for (row, measured) in self.measured.iter().enumerate() {
                self.values[(row, 0)] += 2.0 * measured;
            }
        }
    }

    /// The columns that are used, as they are behind the joint's channel: what is logged at an
    /// instant is later than what was, so windows come last.
    pub(super) fn through(
        &mut self,
        records: &[Record<'_>],
        channels: &[Response],
        is_used: impl Fn(usize) -> bool,
    ) {
        // What is late now was not before.
        let known = channels.get(self.joint).filter(|_| self.kind != RecordKind::Before);
        let channel = known.copied().unwrap_or_default();
        for (k, series) in self.plain.iter().enumerate() {
            if !is_used(self.reached[k]) {
                continue;
            }
            let mut first = 0;
            let of_kind = records.iter().filter(|record| record.kind == self.kind);
            for (record, series) in of_kind.zip(series) {
                let rows = record.spectrum.rows();
                let mut to = self.values.view_mut((first, k), (rows, 1));
                match series {
                    Some(series) => {
                        let late = channel.behind(&record.motion, self.joint, series);
                        to.copy_from_slice(&record.rows_of(self.joint, &late));
                    }
                    // The model does not drift: what was there is the difference.
                    None => to.fill(0.0),
                }
                first += rows;
            }
        }
        if is_used(0) {
            for (row, measured) in self.measured.iter().enumerate() {
                self.values[(row, 0)] = measured - self.values[(row, 0)];
            }
        }
    }

    /// Products of the columns with a place, weighted, their places, and the sum of the
    /// logarithms of the weights' roots.
    pub(super) fn gram(
        &self,
        error: f64,
        place: impl Fn(usize) -> Option<usize>,
    ) -> (DMatrix<f64>, Vec<usize>, f64) {
        let weights = self.weights(error);
        let log_weights = weights.iter().filter(|of| **of > 0.0).map(|of| of.ln()).sum();
        let (used, places) = self.used(place);
        let weighted = self.weighted(&weights, &used);
        let transposed = weighted.transpose();
        let count = used.len();
        let mut gram = DMatrix::zeros(count, count);
        for from in (0..count).step_by(BLOCK) {
            // What is above the diagonal is below it, too.
            let width = BLOCK.min(count - from);
            let below = transposed.rows_range(from..) * weighted.columns(from, width);
            gram.view_mut((from, from), below.shape()).copy_from(&below);
            gram.view_mut((from, from), (width, count - from)).tr_copy_from(&below);
        }
        (gram, places, log_weights)
    }

    /// Products of the columns with a place with some of these by number, weighted, and the
    /// places of both.
    pub(super) fn products(
        &self,
        error: f64,
        place: impl Fn(usize) -> Option<usize>,
        some: &[usize],
    ) -> Option<(DMatrix<f64>, [Vec<usize>; 2])> {
        let (of, to) = self.used(|number| some.binary_search(&number).ok());
        if of.is_empty() {
            return None;
        }
        let weights: Vec<f64> = self.weights(error).into_iter().map(|x| x * x).collect();
        let weighted = self.weighted(&weights, &of);
        let (used, places) = self.used(place);
        let product = |i: usize, k: usize| self.values.column(used[i]).dot(&weighted.column(k));
        Some((DMatrix::from_fn(used.len(), of.len(), product), [places, to]))
    }

    /// Products of the columns with a place with columns of whitened noise, and their places.
    pub(super) fn products_with(
        &self,
        error: f64,
        place: impl Fn(usize) -> Option<usize>,
        noise: &DMatrix<f64>,
    ) -> (DMatrix<f64>, Vec<usize>) {
        let (used, places) = self.used(place);
        (self.weighted(&self.weights(error), &used).transpose() * noise, places)
    }

    /// Roots of the weights of the rows.
    fn weights(&self, error: f64) -> Vec<f64> {
        let variances = self.noise.iter().zip(&self.power).zip(&self.excess);
        variances
            .map(|((noise, power), excess)| noise + error * error * power + excess)
            .zip(&self.bins)
            .map(
                |(variance, bin)| {
                    if *bin > self.highest { 0.0 } else { 1.0 / variance.max(LEAST).sqrt() }
                },
            )
            .collect()
    }

    /// Columns with a place, and these places.
    fn used(&self, place: impl Fn(usize) -> Option<usize>) -> (Vec<usize>, Vec<usize>) {
        let reached = self.reached.iter().enumerate();
        reached.filter_map(|(k, number)| Some((k, place(*number)?))).unzip()
    }

    /// Some columns, each row times its weight.
    fn weighted(&self, weights: &[f64], used: &[usize]) -> DMatrix<f64> {
        let mut weighted = DMatrix::zeros(self.len(), used.len());
        for (mut to, k) in weighted.column_iter_mut().zip(used) {
            let from = self.values.column(*k);
            for ((to, from), weight) in to.iter_mut().zip(from.iter()).zip(weights) {
                *to = from * weight;
            }
        }
        weighted
    }
}

impl Rows {
    /// Expected squares of what is missed, by row.
    pub(super) fn missed(&self, posterior: &Posterior) -> Vec<f64> {
        let place = |number: usize| posterior.places[number].filter(|_| number > 0);
        let (used, places) = self.used(place);
        let count = used.len();
        let of = |k: usize| places[k] - 1;
        let covariance =
            DMatrix::from_fn(count, count, |i, k| posterior.covariance[(of(i), of(k))]);
        let mean = DVector::from_fn(count, |k, _| posterior.mean[of(k)]);
        let columns = self.values.select_columns(&used);
        let left = self.values.column(0) - &columns * mean;
        let spread = &columns * covariance;
        (0..self.len())
            .map(|row| left[row].powi(2) + spread.row(row).dot(&columns.row(row)).max(0.0))
            .collect()
    }
}

/// The series of a joint.
fn find(series: &[(usize, Vec<f64>)], joint: usize) -> Option<&Vec<f64>> {
    series.iter().find(|(of, _)| *of == joint).map(|(_, series)| series)
}

//! Rows of one joint in all records of a kind: the difference, and what may explain it there.

use nalgebra::{DMatrix, DVector};

use crate::effects::Response;

use super::column::Column;
use super::nuisance::Nuisance;
use super::record::{Record, RecordKind};
use super::spectrum::Spectrum;

/// Least variance of a row \[N²m²\].
const LEAST: f64 = 1e-18;

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
        for record in &records {
            measured.extend(record.rows_of(joint, &record.measured[joint]));
            for row in 0..record.spectrum.rows() {
                let bin = Spectrum::bin(row);
                noise.push(record.noise[joint][bin]);
                power.push(record.power[joint][bin]);
            }
        }
        let series = |number: usize, k: usize| -> Option<Vec<f64>> {
            match (k, kind) {
                (0, RecordKind::Mean) => Some(records[number].motion.torque[joint].clone()),
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
        let mut rows =
            Rows { joint, kind, values, plain, measured, reached, noise, power, excess, spectra };
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
        if joint == self.joint {
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
        let channel = channels.get(self.joint).copied().unwrap_or_default();
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
        let mut weights = Vec::with_capacity(self.len());
        let mut log_weights = 0.0;
        for ((noise, power), excess) in self.noise.iter().zip(&self.power).zip(&self.excess) {
            let weight = 1.0 / (noise + error * error * power + excess).max(LEAST).sqrt();
            log_weights += weight.ln();
            weights.push(weight);
        }
        let used: Vec<(usize, usize)> = self
            .reached
            .iter()
            .enumerate()
            .filter_map(|(k, number)| Some((k, place(*number)?)))
            .collect();
        let mut weighted = DMatrix::zeros(self.len(), used.len());
        for (mut to, (k, _)) in weighted.column_iter_mut().zip(&used) {
            let from = self.values.column(*k);
            for ((to, from), weight) in to.iter_mut().zip(from.iter()).zip(&weights) {
                *to = from * weight;
            }
        }
        let places = used.into_iter().map(|(_, place)| place).collect();
        (weighted.transpose() * &weighted, places, log_weights)
    }
}

impl Rows {
    /// Expected squares of what is missed, by row.
    pub(super) fn missed(&self, posterior: &Posterior) -> Vec<f64> {
        let used: Vec<(usize, usize)> = self
            .reached
            .iter()
            .enumerate()
            .filter(|(_, number)| **number > 0)
            .filter_map(|(k, number)| Some((k, posterior.places[*number]? - 1)))
            .collect();
        let count = used.len();
        let covariance =
            DMatrix::from_fn(count, count, |i, k| posterior.covariance[(used[i].1, used[k].1)]);
        let mean = DVector::from_fn(count, |k, _| posterior.mean[used[k].1]);
        let mut columns = DMatrix::zeros(self.len(), count);
        for (mut to, (k, _)) in columns.column_iter_mut().zip(&used) {
            to.copy_from(&self.values.column(*k));
        }
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

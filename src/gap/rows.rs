//! Rows of one joint in all records of a kind: the difference, and what may explain it there.

use nalgebra::DMatrix;

use super::channel::Channel;
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
    values: DMatrix<f64>,
    /// The same before the channel, and the model's torque and the measured one.
    plain: DMatrix<f64>,
    model: Vec<f64>,
    measured: Vec<f64>,
    /// Of each row \[Hz\]; 0 of a mean. Rows of one frequency are real and imaginary part.
    frequency: Vec<f64>,
    /// Numbers of the columns: 0 is the difference, then parameters, then what may be found.
    reached: Vec<usize>,
    noise: Vec<f64>,
    power: Vec<f64>,
}

impl Rows {
    /// Of all records of a kind.
    pub(super) fn new(
        records: &[Record<'_>],
        nuisances: &[Nuisance],
        columns: &[&Column],
        joint: usize,
        kind: RecordKind,
    ) -> Rows {
        let numbers: Vec<usize> =
            (0..records.len()).filter(|number| records[*number].kind == kind).collect();
        let records: Vec<&Record<'_>> = numbers.iter().map(|number| &records[*number]).collect();
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
        let mut values = DMatrix::zeros(height, reached.len());
        let (mut noise, mut power, mut frequency) = (Vec::new(), Vec::new(), Vec::new());
        let (mut model, mut measured) = (Vec::new(), Vec::new());
        let mut first = 0;
        for (number, record) in records.iter().enumerate() {
            let rows = record.spectrum.rows();
            measured.extend(record.rows_of(joint, &record.measured[joint]));
            match record.kind {
                RecordKind::Mean => {
                    model.extend(record.rows_of(joint, &record.motion.torque[joint]));
                }
                RecordKind::Drift => model.extend(vec![0.0; rows]),
            }
            for (to, k) in reached.iter().enumerate().skip(1) {
                let series = if *k <= parameters {
                    of_parameter(number, k - 1)
                } else {
                    of_column(number, k - 1 - parameters)
                };
                if let Some(series) = series {
                    let spectrum = record.rows_of(joint, series);
                    values.view_mut((first, to), (rows, 1)).copy_from_slice(&spectrum);
                }
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
        let mut rows =
            Rows { joint, kind, values, plain, model, measured, frequency, reached, noise, power };
        rows.through(&[], |_| true);
        rows
    }

    pub(super) fn len(&self) -> usize {
        self.noise.len()
    }

    /// Another column in the place of the one with the number.
    pub(super) fn replace(&mut self, number: usize, column: &Column, records: &[Record<'_>]) {
        let Ok(place) = self.reached.binary_search(&number) else { return };
        let mut first = 0;
        let of_kind = |(record, _): &(&Record<'_>, _)| record.kind == self.kind;
        for (record, series) in records.iter().zip(&column.series).filter(of_kind) {
            let count = record.spectrum.rows();
            if let Some(series) = find(series, self.joint) {
                let spectrum = record.rows_of(self.joint, series);
                self.plain.view_mut((first, place), (count, 1)).copy_from_slice(&spectrum);
            }
            first += count;
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

    pub(super) fn through(&mut self, channels: &[Channel], is_used: impl Fn(usize) -> bool) {
        let channel = channels.get(self.joint).copied().unwrap_or_default();
        let still = channel == Channel::default();
        let responses: Vec<[f64; 2]> =
            self.frequency.iter().map(|frequency| channel.response(*frequency)).collect();
        let turned = |from: &[f64], to: &mut [f64]| {
            to.copy_from_slice(from);
            let mut row = 0;
            while !still && row < from.len() {
                // A mean has no phase.
                if self.frequency[row] == 0.0 {
                    row += 1;
                    continue;
                }
                let [re, im] = responses[row];
                let [a, b] = [from[row], from[row + 1]];
                to[row] = re * a - im * b;
                to[row + 1] = re * b + im * a;
                row += 2;
            }
        };
        let height = self.frequency.len();
        let mut model = vec![0.0; height];
        turned(&self.model, &mut model);
        let values = self.values.as_mut_slice();
        for (row, model) in model.iter().enumerate() {
            values[row] = self.measured[row] - model;
        }
        let plain = self.plain.as_slice();
        for k in (1..self.reached.len()).filter(|k| is_used(self.reached[*k])) {
            let at = k * height..(k + 1) * height;
            turned(&plain[at.clone()], &mut values[at]);
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
        for (noise, power) in self.noise.iter().zip(&self.power) {
            let weight = 1.0 / (noise + error * error * power).max(LEAST).sqrt();
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
        (weighted.tr_mul(&weighted), places, log_weights)
    }
}

/// The series of a joint.
fn find(series: &[(usize, Vec<f64>)], joint: usize) -> Option<&Vec<f64>> {
    series.iter().find(|(of, _)| *of == joint).map(|(_, series)| series)
}

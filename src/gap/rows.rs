//! Rows of one joint: the difference, and what may explain it there.

use nalgebra::DMatrix;

use super::channel::Channel;
use super::column::Column;
use super::nuisance::Nuisance;
use super::record::{Record, RecordKind};
use super::spectrum::Spectrum;

/// Least variance of a row \[N²m²\].
const LEAST: f64 = 1e-18;

/// Rows of one joint.
#[derive(Clone)]
pub(super) struct Rows {
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
    pub(super) fn new(
        records: &[Record<'_>],
        nuisances: &[Nuisance],
        columns: &[&Column],
        joint: usize,
    ) -> Rows {
        let parameters = nuisances.first().map_or(0, |of| of.series.len());
        let of_parameter = |record: usize, k: usize| find(&nuisances[record].series[k], joint);
        let of_column = |record: usize, k: usize| find(&columns[k].series[record], joint);
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
        let mut rows = Rows { values, plain, model, measured, frequency, reached, noise, power };
        rows.through(&Channel::default());
        rows
    }

    pub(super) fn len(&self) -> usize {
        self.noise.len()
    }

    pub(super) fn reached(&self) -> &[usize] {
        &self.reached
    }

    /// Another column in the place of the one with the number.
    pub(super) fn replace(
        &mut self,
        number: usize,
        column: &Column,
        joint: usize,
        records: &[Record<'_>],
    ) {
        let Ok(place) = self.reached.binary_search(&number) else { return };
        let mut first = 0;
        for (record, series) in records.iter().zip(&column.series) {
            let count = record.spectrum.rows();
            if let Some(series) = find(series, joint) {
                let spectrum = record.rows_of(joint, series);
                self.plain.view_mut((first, place), (count, 1)).copy_from_slice(&spectrum);
            }
            first += count;
        }
    }

    pub(super) fn through(&mut self, channel: &Channel) {
        let still = *channel == Channel::default();
        let mut row = 0;
        while row < self.frequency.len() {
            let frequency = self.frequency[row];
            if frequency == 0.0 {
                self.values[(row, 0)] = self.measured[row] - self.model[row];
                row += 1;
                continue;
            }
            let [re, im] = channel.response(frequency);
            let [a, b] = [self.model[row], self.model[row + 1]];
            self.values[(row, 0)] = self.measured[row] - (re * a - im * b);
            self.values[(row + 1, 0)] = self.measured[row + 1] - (re * b + im * a);
            row += 2;
        }
        for k in 1..self.values.ncols() {
            let plain = self.plain.column(k);
            let mut to = self.values.column_mut(k);
            to.copy_from(&plain);
            let mut row = 0;
            while !still && row < self.frequency.len() {
                if self.frequency[row] == 0.0 {
                    row += 1;
                    continue;
                }
                let [re, im] = channel.response(self.frequency[row]);
                let [a, b] = [plain[row], plain[row + 1]];
                to[row] = re * a - im * b;
                to[row + 1] = re * b + im * a;
                row += 2;
            }
        }
    }

    /// Products of all columns, weighted, and the sum of the logarithms of the weights' roots.
    pub(super) fn gram(&self, error: f64) -> (DMatrix<f64>, f64) {
        let mut weights = Vec::with_capacity(self.len());
        let mut log_weights = 0.0;
        for (noise, power) in self.noise.iter().zip(&self.power) {
            let weight = 1.0 / (noise + error * error * power).max(LEAST).sqrt();
            log_weights += weight.ln();
            weights.push(weight);
        }
        let mut weighted = self.values.clone();
        for mut column in weighted.column_iter_mut() {
            column.iter_mut().zip(&weights).for_each(|(x, weight)| *x *= weight);
        }
        (weighted.tr_mul(&weighted), log_weights)
    }
}

/// The series of a joint.
fn find(series: &[(usize, Vec<f64>)], joint: usize) -> Option<&Vec<f64>> {
    series.iter().find(|(of, _)| *of == joint).map(|(_, series)| series)
}

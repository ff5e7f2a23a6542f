//! Rows of one joint.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::everyday::{Group, everyday, set_of};
use super::parameters::Parameters;
use crate::gap::record::{Record, RecordKind};
use crate::gap::spectrum::Spectrum;
use crate::gap::tunables::Tunables;

/// Ratio of the frequencies at the ends of a band.
const BAND: f64 = 1.5;
/// Least variance of a row \[N²m²\].
const LEAST: f64 = 1e-18;

/// The set of logs of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// Logs of the robot as it is now.
    Now,
    /// Logs of the baseline.
    Baseline,
    /// How repetitions drift.
    Drift,
}

/// Frequencies between which an error of the model has its own size \[Hz\]: one of three.
const RANGES: [f64; 2] = [1.0, 4.0];

/// Least variance of the noise, of the mean square of the torque: no log is known better.
const FLOOR: f64 = 1e-7;

/// Rows of one log in one band of frequencies.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Its lowest frequency, in numbers of bins.
    pub first_bin: usize,
    /// Its rows.
    pub rows: Range<usize>,
    /// Its range of frequencies: low, middle or high.
    pub range: usize,
    /// The set of its log.
    pub set: Set,
    /// Variance of the noise in a row \[N²m²\].
    pub noise: f64,
    /// Mean square of the joint's torque, where the log does not show its noise; else 0 \[N²m²\].
    pub white: f64,
    /// Mean square of the model's torque in a row \[N²m²\].
    pub power: f64,
}

/// Rows of one joint in all records.
pub struct JointDesign {
    /// The joint, from 0.
    pub joint: usize,
    /// Root of the mean square of the model's torque \[Nm\].
    pub torque: f64,
    /// Cells, in the order of the rows.
    pub cells: Vec<Cell>,
    /// The difference between measured and predicted torque.
    pub y: DVector<f64>,
    /// Columns: parameters of the model, then everyday errors.
    pub base: DMatrix<f64>,
    /// The columns transposed.
    pub transposed: DMatrix<f64>,
    /// Groups of the everyday errors.
    pub groups: Vec<Group>,
    /// Products of `[y, base]` of each cell.
    pub grams: Vec<DMatrix<f64>>,
}

impl JointDesign {
    pub(super) fn new(
        records: &[Record<'_>],
        joint: usize,
        parameters: &Parameters,
        tunables: &Tunables,
    ) -> Self {
        let mut cells = Vec::new();
        let mut y = Vec::new();
        for record in records {
            let from = y.len();
            y.extend(difference(record, joint));
            cells.extend(cells_of(record, joint, from));
        }
        let local = everyday(records, joint, tunables);
        let count = parameters.count();
        let mut base = DMatrix::zeros(y.len(), count + local.len());
        for k in 0..count {
            rows_of(records, joint, &parameters.series(joint, k), base.column_mut(k).as_mut_slice());
        }
        for (k, of) in local.iter().enumerate() {
            let series: Vec<&[f64]> = of.series.iter().map(Vec::as_slice).collect();
            rows_of(records, joint, &series, base.column_mut(count + k).as_mut_slice());
        }
        let y = DVector::from_vec(y);
        let torques = records.iter().flat_map(|record| &record.motion.torque[joint]);
        let mut design = JointDesign {
            joint,
            torque: super::basis::rms(torques).max(1e-9),
            cells,
            y,
            transposed: base.transpose(),
            base,
            groups: local.iter().map(|of| of.group).collect(),
            grams: Vec::new(),
        };
        design.grams = design.cells.iter().map(|cell| design.gram(cell)).collect();
        design
    }

    fn gram(&self, cell: &Cell) -> DMatrix<f64> {
        let (from, count) = (cell.rows.start, cell.rows.len());
        let mut all = DMatrix::zeros(count, 1 + self.base.ncols());
        all.column_mut(0).copy_from(&self.y.rows(from, count));
        all.columns_mut(1, self.base.ncols()).copy_from(&self.base.rows(from, count));
        // Faster than `tr_mul`, which has no blocked product.
        all.transpose() * &all
    }
}

/// Rows of the difference between measured and predicted torque.
fn difference(record: &Record<'_>, joint: usize) -> Vec<f64> {
    let measured = &record.measured[joint];
    let missed: Vec<f64> = match record.kind {
        // The model does not drift.
        RecordKind::Drift => measured.clone(),
        RecordKind::Mean | RecordKind::Before => {
            measured.iter().zip(&record.motion.torque[joint]).map(|(a, b)| a - b).collect()
        }
    };
    record.rows_of(joint, &missed)
}

/// Writes the rows of a series that is given by record; an empty one is 0.
pub(super) fn rows_of(
    records: &[Record<'_>],
    joint: usize,
    series: &[&[f64]],
    to: &mut [f64],
) {
    let mut from = 0;
    for (record, series) in records.iter().zip(series) {
        let count = record.spectrum.rows();
        if !series.is_empty() {
            to[from..from + count].copy_from_slice(&record.rows_of(joint, series));
        }
        from += count;
    }
}

/// Bands of a record, whose first row is `from`.
fn cells_of(record: &Record<'_>, joint: usize, from: usize) -> Vec<Cell> {
    let (noise, power) = (&record.noise[joint], &record.power[joint]);
    let bins = record.spectrum.bins;
    let all = power.iter().sum::<f64>() / bins.max(1) as f64;
    let power_all = &vec![all; bins];
    let lasts = record.motion.step() * record.motion.rows() as f64;
    let mut cells = Vec::new();
    let mut first = 0;
    while first < bins {
        let next = (((first as f64) * BAND) as usize).max(first + 1).min(bins);
        let mean = |of: &[f64]| {
            of[first..next].iter().sum::<f64>() / (next - first) as f64
        };
        cells.push(Cell {
            first_bin: first,
            range: RANGES.iter().filter(|edge| first as f64 / lasts >= **edge).count(),
            rows: from + first_row(first)..from + first_row(next),
            set: set_of(record.kind),
            noise: mean(noise).max(LEAST).max(FLOOR * all),
            white: if record.repetitions > 1 { 0.0 } else { mean(power_all) },
            power: mean(power),
        });
        first = next;
    }
    cells
}

/// The first row of a bin.
fn first_row(bin: usize) -> usize {
    debug_assert!(bin == 0 || Spectrum::bin(2 * bin - 1) == bin);
    if bin == 0 { 0 } else { 2 * bin - 1 }
}

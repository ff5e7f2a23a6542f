//! Rows of one joint.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::everyday::{Group, everyday};
use super::packed::Packed;
use super::parameters::Parameters;
use super::set::{Set, set_of};
use crate::gap::data::{Record, RecordKind};
use crate::gap::tunables::Tunables;

/// Ratio of the frequencies at the ends of a band.
const BAND: f64 = 2.0;
/// Least variance of a row \[N²m²\].
const LEAST: f64 = 1e-18;

/// Frequencies between which an error of the model has its own size \[Hz\]: one of three.
const RANGES: [f64; 2] = [1.0, 4.0];

/// Least variance of the noise, of the mean square of the torque: no log is known better.
const FLOOR: f64 = 1e-7;

/// Rows that show nothing: an effect of this share of the torque would be worth less than so many
/// nats there, and the difference is no larger than noise by so many standard deviations.
const HARDLY_SEEN: f64 = 0.1;
const WORTH: f64 = 0.5;
const BEYOND: f64 = 4.0;

/// Rows of one log in one band of frequencies.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Number of its record.
    pub record: usize,
    /// Its lowest frequency \[Hz\].
    pub frequency: f64,
    /// Its rows among those of the record.
    source: Range<usize>,
    /// Its rows in the design.
    pub rows: Range<usize>,
    /// Its range of frequencies: low, middle or high.
    pub range: usize,
    /// The set of its log.
    pub set: Set,
    /// Variance of the noise in a row \[N²m²\].
    pub noise: f64,
    /// Mean square of the joint's torque, where the log does not show its noise; else 0 \[N²m²\].
    pub white: f64,
    /// Mean square of the joint's torque \[N²m²\].
    pub all: f64,
    /// Mean square of the model's torque in a row \[N²m²\].
    pub power: f64,
}

/// Rows of one joint in all records: low frequencies first.
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
    /// Number of the record and column, among the everyday errors, of each mean friction of a log: dry,
    /// then viscous, record by record.
    pub friction: Vec<(usize, usize)>,
    /// Whether a log shows how its repetitions drift.
    pub shows_drift: bool,
    /// Products of `[y, base]` of each cell.
    pub(in crate::gap) grams: Vec<Packed>,
}

impl JointDesign {
    pub(super) fn new(
        records: &[Record<'_>],
        joint: usize,
        parameters: &Parameters,
        tunables: &Tunables,
    ) -> Self {
        let differences: Vec<Vec<f64>> =
            records.iter().map(|record| difference(record, joint)).collect();
        let mut cells: Vec<Cell> = Vec::new();
        for (number, (record, missed)) in records.iter().zip(&differences).enumerate() {
            let all = cells_of(record, number, joint).into_iter();
            cells.extend(all.filter(|cell| cell.shows_something(missed)));
        }
        cells.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        let mut height = 0;
        for cell in &mut cells {
            cell.rows = height..height + cell.source.len();
            height = cell.rows.end;
        }
        let torques = records.iter().flat_map(|record| &record.motion.torque[joint]);
        let mut design = JointDesign {
            joint,
            torque: super::basis::rms(torques).max(1e-9),
            cells,
            y: DVector::zeros(height),
            base: DMatrix::zeros(0, 0),
            transposed: DMatrix::zeros(0, 0),
            groups: Vec::new(),
            friction: Vec::new(),
            shows_drift: records.iter().any(|record| record.kind == RecordKind::Drift),
            grams: Vec::new(),
        };
        let mut y = DVector::zeros(height);
        design.place(&differences, y.as_mut_slice());
        design.y = y;
        let local = everyday(records, joint, tunables);
        let count = parameters.count();
        let mut base = DMatrix::zeros(height, count + local.len());
        for k in 0..count {
            design.rows_of(
                records,
                &parameters.series(joint, k),
                base.column_mut(k).as_mut_slice(),
            );
        }
        for (k, of) in local.iter().enumerate() {
            let series: Vec<&[f64]> = of.series.iter().map(Vec::as_slice).collect();
            design.rows_of(records, &series, base.column_mut(count + k).as_mut_slice());
        }
        design.transposed = base.transpose();
        design.base = base;
        design.groups = local.iter().map(|of| of.group).collect();
        let friction = local.iter().enumerate();
        let friction = friction.filter_map(|(column, of)| Some((of.friction_of?, column)));
        design.friction = friction.collect();
        design.grams = design.cells.iter().map(|cell| design.gram(cell)).collect();
        design
    }

    /// Writes the rows of a series that is given by record; an empty one is 0.
    pub(super) fn rows_of(&self, records: &[Record<'_>], series: &[&[f64]], to: &mut [f64]) {
        let rows = |(record, series): (&Record<'_>, &&[f64])| -> Vec<f64> {
            if series.is_empty() { Vec::new() } else { record.rows_of(self.joint, series) }
        };
        let rows: Vec<Vec<f64>> = records.iter().zip(series).map(rows).collect();
        self.place(&rows, to);
    }

    /// Writes rows that are given by record to their places.
    fn place(&self, rows: &[Vec<f64>], to: &mut [f64]) {
        for cell in &self.cells {
            let from = &rows[cell.record];
            if !from.is_empty() {
                to[cell.rows.clone()].copy_from_slice(&from[cell.source.clone()]);
            }
        }
    }

    /// Rows by record, those that are not used 0.
    #[must_use]
    pub(in crate::gap) fn by_record(
        &self,
        records: &[Record<'_>],
        rows: &DVector<f64>,
    ) -> Vec<Vec<f64>> {
        let count = |record: &Record<'_>| first_row(record.bins());
        let mut all: Vec<Vec<f64>> = records.iter().map(|of| vec![0.0; count(of)]).collect();
        for cell in &self.cells {
            let from = &rows.as_slice()[cell.rows.clone()];
            all[cell.record][cell.source.clone()].copy_from_slice(from);
        }
        all
    }

    /// Number of rows below a frequency \[Hz\].
    #[must_use]
    pub fn rows_below(&self, frequency: f64) -> usize {
        let below = self.cells.iter().take_while(|cell| cell.frequency < frequency);
        below.last().map_or(0, |cell| cell.rows.end)
    }

    fn gram(&self, cell: &Cell) -> Packed {
        let (from, count) = (cell.rows.start, cell.rows.len());
        let mut all = DMatrix::zeros(count, 1 + self.base.ncols());
        all.column_mut(0).copy_from(&self.y.rows(from, count));
        all.columns_mut(1, self.base.ncols()).copy_from(&self.base.rows(from, count));
        // Faster than `tr_mul`, which has no blocked product.
        Packed::of(&(all.transpose() * &all))
    }
}

impl Cell {
    /// Whether effects of a usual size can be seen in it, or something is.
    fn shows_something(&self, missed: &[f64]) -> bool {
        let count = self.source.len() as f64;
        let squares: f64 = missed[self.source.clone()].iter().map(|x| x * x).sum();
        let noise = self.noise;
        self.white > 0.0
            || 0.5 * HARDLY_SEEN * HARDLY_SEEN * self.power * count > WORTH * noise
            || squares > noise * (count + BEYOND * (2.0 * count).sqrt())
    }
}

/// Rows of the difference between measured and predicted torque.
fn difference(record: &Record<'_>, joint: usize) -> Vec<f64> {
    let measured = &record.measured[joint];
    let missed: Vec<f64> = match record.kind {
        // The model does not drift.
        RecordKind::Drift => measured.clone(),
        RecordKind::Mean | RecordKind::Before => {
            measured.iter().zip(&record.modelled[joint]).map(|(a, b)| a - b).collect()
        }
    };
    record.rows_of(joint, &missed)
}

/// Bands of a record.
fn cells_of(record: &Record<'_>, number: usize, joint: usize) -> Vec<Cell> {
    let (noise, power) = (&record.noise[joint], &record.power[joint]);
    let bins = record.bins();
    let all = power.iter().sum::<f64>() / bins.max(1) as f64;
    let lasts = record.duration();
    let mut cells = Vec::new();
    let mut first = 0;
    while first < bins {
        let next = (((first as f64) * BAND) as usize).max(first + 1).min(bins);
        let mean = |of: &[f64]| of[first..next].iter().sum::<f64>() / (next - first) as f64;
        let frequency = first as f64 / lasts;
        cells.push(Cell {
            record: number,
            frequency,
            range: RANGES.iter().filter(|edge| frequency >= **edge).count(),
            source: first_row(first)..first_row(next),
            rows: 0..0,
            set: set_of(record.kind),
            noise: mean(noise).max(LEAST).max(FLOOR * all),
            white: if record.repetitions > 1 { 0.0 } else { all },
            all,
            power: mean(power),
        });
        first = next;
    }
    cells
}

/// The first row of a bin.
fn first_row(bin: usize) -> usize {
    if bin == 0 { 0 } else { 2 * bin - 1 }
}

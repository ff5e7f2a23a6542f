//! Parameters of the model, which may be off by what the model is trusted.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rayon::prelude::*;

use crate::arm::dynamics::{JOINT, RIGID, Regressor, link_parameters, parameter_count, write_rows};
use crate::arm::effects::{Motion, Response};
use crate::arm::robot::Link;
use crate::gap::data::{Record, RecordKind};
use crate::gap::tunables::Tunables;

use super::basis::rms;
use crate::gap::trust::{Spread, Trust};

/// Displacement of a centre of mass over which differences are taken \[m\].
const SMALL: f64 = 1e-6;
/// Errors of a joint's torque, of its root mean square, that nothing sees.
const UNSEEN: f64 = 1e-3;
/// Sum of squares, in such errors, below which a direction of the parameters changes nothing.
const NOTHING: f64 = 1e-2;

/// Torques by joint that a parameter reaches \[Nm\].
type Reached = Vec<(usize, Vec<f64>)>;
/// Torques of a joint \[Nm\]: rows in time, columns of parameters.
type Series = DMatrix<f64>;

/// The parameters of the model, and those of the torque path behind them: directions that the motions
/// show, each with a deviation of 1.
pub struct Parameters {
    /// Changes of the standard parameters by direction; the torque path has none.
    pub mixing: DMatrix<f64>,
    /// Standard deviations of the standard parameters.
    pub sizes: DVector<f64>,
    /// The directions in deviations of single parameters.
    directions: DMatrix<f64>,
    /// By record, by direction.
    series: Vec<Vec<Reached>>,
}

impl Parameters {
    pub(super) fn new(records: &[Record<'_>], trust: Trust, tunables: &Tunables) -> Parameters {
        let mixing = prior(records, &trust.spread(), tunables);
        let path = [tunables.lag, tunables.lag_form];
        let known = |record: &&Record<'_>| record.kind != RecordKind::Drift;
        let of_model: Vec<Vec<Series>> = records
            .par_iter()
            .map(|record| known(&record).then(|| of_model(&record.motion, &mixing)))
            .map(Option::unwrap_or_default)
            .collect();
        let directions = shown(&of_model, records, mixing.ncols());
        let of_record = |(record, series): (&Record<'_>, &Vec<Series>)| {
            // No parameter changes from repetition to repetition.
            if record.kind == RecordKind::Drift {
                return vec![Vec::new(); directions.ncols() + path.len()];
            }
            let mut all = along(series, &directions);
            all.extend(of_path(&record.motion, path));
            all
        };
        Parameters {
            series: records.par_iter().zip(&of_model).map(of_record).collect(),
            sizes: DVector::from_fn(mixing.nrows(), |row, _| mixing.row(row).norm()),
            mixing: mixing * &directions,
            directions,
        }
    }

    /// Number of directions, those of the torque path among them.
    #[must_use]
    pub fn count(&self) -> usize {
        self.of_model() + 2
    }

    /// Number of directions of the model's parameters.
    #[must_use]
    pub fn of_model(&self) -> usize {
        self.mixing.ncols()
    }

    /// The parameters of a link in directions: a row for each.
    pub(super) fn of_link(&self, link: usize) -> DMatrix<f64> {
        self.directions.rows(RIGID * link, RIGID).into_owned()
    }

    /// The series of a direction at a joint by record; empty where it does not reach the joint.
    pub(super) fn series(&self, joint: usize, k: usize) -> Vec<&[f64]> {
        let mut all = Vec::with_capacity(self.series.len());
        for record in &self.series {
            let found = record[k].iter().find(|(of, _)| *of == joint);
            all.push(found.map_or(&[][..], |(_, series)| series.as_slice()));
        }
        all
    }
}

/// Changes of the standard parameters for one deviation of each of the model's parameters.
fn prior(records: &[Record<'_>], spread: &Spread, tunables: &Tunables) -> DMatrix<f64> {
    let motions: Vec<&Motion<'_>> = records.iter().map(|record| &record.motion).collect();
    let Some(first) = motions.first() else { return DMatrix::zeros(0, 0) };
    let (model, n) = (first.model, first.model.dof);
    let mut mixing = DMatrix::zeros(parameter_count(n), parameter_count(n));
    for (number, link) in model.links.iter().enumerate() {
        for (k, change) in of_link(link, spread).into_iter().enumerate() {
            let column = RIGID * number + k;
            for (row, value) in change.into_iter().enumerate() {
                mixing[(RIGID * number + row, column)] = value;
            }
        }
    }
    for joint in 0..n {
        let scale = first.scale(joint);
        let largest = motions.iter().map(|m| m.scale(joint).torque[1]).fold(0.0, f64::max);
        // A model without rotors lacks as much as its links have.
        let rotor = if scale.rotor > 0.0 {
            spread.inertia * scale.rotor
        } else {
            tunables.missing_rotor * scale.inertia
        };
        let sizes = [
            rotor,
            spread.friction * scale.viscous,
            spread.friction * scale.coulomb,
            spread.offset * largest,
        ];
        for (k, size) in sizes.into_iter().enumerate() {
            let column = RIGID * n + JOINT * joint + k;
            mixing[(column, column)] = size;
        }
    }
    mixing
}

/// Directions of the parameters whose torques can be seen in records, in columns.
fn shown(all: &[Vec<Series>], records: &[Record<'_>], count: usize) -> DMatrix<f64> {
    let mut products = DMatrix::zeros(count, count);
    for (record, series) in records.iter().zip(all) {
        for (joint, columns) in series.iter().enumerate() {
            let torque = rms(record.motion.torque[joint].iter()).max(f64::MIN_POSITIVE);
            products += columns.transpose() * columns / (UNSEEN * torque).powi(2);
        }
    }
    let eigen = products.symmetric_eigen();
    let seen: Vec<usize> = (0..count).filter(|k| eigen.eigenvalues[*k] > NOTHING).collect();
    eigen.eigenvectors.select_columns(&seen)
}

/// The series along directions.
fn along(series: &[Series], directions: &DMatrix<f64>) -> Vec<Reached> {
    let all: Vec<Series> = series.iter().map(|of| of * directions).collect();
    let of = |k: usize| {
        let of_joint = all.iter().enumerate();
        of_joint.map(|(joint, of)| (joint, of.column(k).as_slice().to_vec())).collect()
    };
    (0..directions.ncols()).map(of).collect()
}

/// What one deviation of each parameter of the model adds, by joint.
fn of_model(motion: &Motion<'_>, mixing: &DMatrix<f64>) -> Vec<Series> {
    let model = motion.model;
    let (n, rows, count) = (model.dof, motion.rows(), mixing.ncols());
    let mut scratch = Regressor::new();
    let mut regressor = DMatrix::zeros(n, count);
    let mut series = vec![Series::zeros(rows, count); n];
    for row in 0..rows {
        let [mut q, qd, qdd] = motion.state(row);
        for (q, offset) in q.iter_mut().zip(&model.sensors.position_offset) {
            *q += offset;
        }
        let state = [&q[..n], &qd[..n], &qdd[..n]];
        write_rows(model, &mut scratch, state, &mut regressor, 0);
        for (joint, of) in series.iter_mut().enumerate() {
            // A joint that counts as at rest has no sense.
            regressor[(joint, RIGID * n + JOINT * joint + 2)] = motion.senses[joint][row];
            of.row_mut(row).copy_from(&regressor.row(joint));
        }
    }
    series.into_iter().map(|of| of * mixing).collect()
}

/// What a lag of all torques changes, and by how much a delay differs from a lag \[s\].
fn of_path(motion: &Motion<'_>, [lag, form]: [f64; 2]) -> [Reached; 2] {
    let late = |response: Response| -> Vec<Vec<f64>> {
        let joints = 0..motion.model.dof;
        joints.map(|joint| response.behind(motion, joint, &motion.torque[joint])).collect()
    };
    let lagged = late(Response { delay: 0.0, lag });
    let [slow, delayed] =
        [Response { delay: 0.0, lag: form }, Response { delay: form, lag: 0.0 }].map(late);
    let less = |a: &[Vec<f64>], b: &[Vec<f64>]| -> Reached {
        let pairs = a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect());
        pairs.enumerate().collect()
    };
    [less(&lagged, &motion.torque), less(&delayed, &slow)]
}

/// Changes of the ten parameters of a link for one deviation of mass, centre and inertia.
fn of_link(link: &Link, spread: &Spread) -> Vec<[f64; RIGID]> {
    let before = link_parameters(link);
    let moment = (link.inertia.trace() / 3.0).abs();
    let mut all = Vec::with_capacity(RIGID);
    let push = |all: &mut Vec<[f64; RIGID]>, changed: Link| {
        let after = link_parameters(&changed);
        let mut change = [0.0; RIGID];
        for (to, (after, before)) in change.iter_mut().zip(after.iter().zip(&before)) {
            *to = after - before;
        }
        all.push(change);
    };
    let mass = spread.mass * link.mass;
    push(&mut all, Link { mass: link.mass + mass, ..link.clone() });
    for axis in 0..3 {
        let changed = Link { com: link.com + Vector3::ith(axis, SMALL), ..link.clone() };
        push(&mut all, changed);
    }
    // To first order: a large deviation is no displaced body.
    for x in all[1..].iter_mut().flatten() {
        *x *= spread.com / SMALL;
    }
    for (row, column) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
        let own = link.inertia[(row, column)].abs();
        let relative = spread.inertia * if row == column { own } else { moment };
        // A centre that is off by as much as the body is large changes its moments to second order.
        let size = relative.hypot(2.0 * link.mass * spread.com * spread.com);
        let mut inertia: Matrix3<f64> = link.inertia;
        inertia[(row, column)] += size;
        if row != column {
            inertia[(column, row)] += size;
        }
        push(&mut all, Link { inertia, ..link.clone() });
    }
    all
}

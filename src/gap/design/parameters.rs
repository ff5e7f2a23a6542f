//! Parameters of the model, which may be off by what the model is trusted.

use nalgebra::{DMatrix, Matrix3, Vector3};

use crate::arm::dynamics::{JOINT, RIGID, Regressor, link_parameters, parameter_count, write_rows};
use crate::arm::effects::{Motion, Response};
use crate::arm::robot::Link;
use crate::gap::data::{Record, RecordKind};
use crate::gap::tunables::Tunables;

use crate::gap::trust::{Spread, Trust};

/// Displacement of a centre of mass over which differences are taken \[m\].
const SMALL: f64 = 1e-6;
/// Names of the parameters of a link and of a joint.
const LINK: [&str; RIGID] = [
    "mass",
    "com_x",
    "com_y",
    "com_z",
    "inertia_xx",
    "inertia_yy",
    "inertia_zz",
    "inertia_xy",
    "inertia_xz",
    "inertia_yz",
];
const OF_JOINT: [&str; JOINT] = ["rotor_inertia", "viscous", "coulomb", "offset"];
/// Names of the parameters of the torque path.
const OF_PATH: [&str; 2] = ["lag of the torques", "form of the lag"];

/// Torques by joint that a parameter reaches \[Nm\].
type Reached = Vec<(usize, Vec<f64>)>;

/// What one standard deviation of each parameter changes.
pub struct Parameters {
    /// Names, such as `link 3 mass`.
    pub names: Vec<String>,
    /// Standard deviations, in the units of the parameters.
    pub deviations: Vec<f64>,
    /// Changes of the standard parameters for one deviation of each: square; parameters of the
    /// torque path have none.
    pub mixing: DMatrix<f64>,
    /// By record, by parameter.
    series: Vec<Vec<Reached>>,
}

impl Parameters {
    pub(super) fn new(records: &[Record<'_>], trust: Trust, tunables: &Tunables) -> Parameters {
        let mut all = prior(records, &trust.spread(), tunables);
        let path = [tunables.lag, tunables.lag_form];
        all.names.extend(OF_PATH.map(ToOwned::to_owned));
        all.deviations.extend(path);
        for record in records {
            let series = match record.kind {
                RecordKind::Mean | RecordKind::Before => {
                    let mut series = of_model(&record.motion, &all.mixing);
                    series.extend(of_path(&record.motion, path));
                    series
                }
                // No parameter changes from repetition to repetition.
                RecordKind::Drift => vec![Vec::new(); all.names.len()],
            };
            all.series.push(series);
        }
        all
    }

    /// Number of parameters.
    #[must_use]
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// The series of a parameter at a joint by record; empty where it does not reach the joint.
    pub(super) fn series(&self, joint: usize, k: usize) -> Vec<&[f64]> {
        let mut all = Vec::with_capacity(self.series.len());
        for record in &self.series {
            let found = record[k].iter().find(|(of, _)| *of == joint);
            all.push(found.map_or(&[][..], |(_, series)| series.as_slice()));
        }
        all
    }
}

/// Names and deviations of the model's parameters.
fn prior(records: &[Record<'_>], spread: &Spread, tunables: &Tunables) -> Parameters {
    let motions: Vec<&Motion<'_>> = records.iter().map(|record| &record.motion).collect();
    let mut all = Parameters {
        names: Vec::new(),
        deviations: Vec::new(),
        mixing: DMatrix::zeros(0, 0),
        series: Vec::new(),
    };
    let Some(first) = motions.first() else { return all };
    let (model, n) = (first.model, first.model.dof);
    all.mixing = DMatrix::zeros(parameter_count(n), parameter_count(n));
    for (number, link) in model.links.iter().enumerate() {
        for (k, (change, size)) in of_link(link, spread).into_iter().enumerate() {
            let column = RIGID * number + k;
            for (row, value) in change.into_iter().enumerate() {
                all.mixing[(RIGID * number + row, column)] = value;
            }
            all.names.push(format!("link {} {}", number + 1, LINK[k]));
            all.deviations.push(size);
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
            all.mixing[(column, column)] = size;
            all.names.push(format!("joint {} {}", joint + 1, OF_JOINT[k]));
            all.deviations.push(size);
        }
    }
    all
}

/// What one deviation of each parameter of the model adds.
fn of_model(motion: &Motion<'_>, mixing: &DMatrix<f64>) -> Vec<Reached> {
    let model = motion.model;
    let (n, rows, count) = (model.dof, motion.rows(), mixing.ncols());
    let mut scratch = Regressor::new();
    let mut regressor = DMatrix::zeros(n, count);
    let mut series: Vec<Reached> =
        (0..count).map(|_| (0..n).map(|joint| (joint, vec![0.0; rows])).collect()).collect();
    for row in 0..rows {
        let [mut q, qd, qdd] = motion.state(row);
        for (q, offset) in q.iter_mut().zip(&model.sensors.position_offset) {
            *q += offset;
        }
        let state = [&q[..n], &qd[..n], &qdd[..n]];
        write_rows(model, &mut scratch, state, &mut regressor, 0);
        for joint in 0..n {
            // A joint that counts as at rest has no sense.
            regressor[(joint, RIGID * n + JOINT * joint + 2)] = motion.senses[joint][row];
        }
        let changed = &regressor * mixing;
        for (parameter, of) in series.iter_mut().enumerate() {
            for (joint, of) in of.iter_mut() {
                of[row] = changed[(*joint, parameter)];
            }
        }
    }
    for of in &mut series {
        of.retain(|(_, series)| series.iter().any(|x| *x != 0.0));
    }
    series
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
fn of_link(link: &Link, spread: &Spread) -> Vec<([f64; RIGID], f64)> {
    let before = link_parameters(link);
    let moment = (link.inertia.trace() / 3.0).abs();
    let mut all = Vec::with_capacity(RIGID);
    let push = |all: &mut Vec<([f64; RIGID], f64)>, changed: Link, size: f64| {
        let after = link_parameters(&changed);
        let mut change = [0.0; RIGID];
        for (to, (after, before)) in change.iter_mut().zip(after.iter().zip(&before)) {
            *to = after - before;
        }
        all.push((change, size));
    };
    let mass = spread.mass * link.mass;
    push(&mut all, Link { mass: link.mass + mass, ..link.clone() }, mass);
    for axis in 0..3 {
        let changed = Link { com: link.com + Vector3::ith(axis, SMALL), ..link.clone() };
        push(&mut all, changed, SMALL);
    }
    // To first order: a large deviation is no displaced body.
    for (change, size) in &mut all[1..] {
        for x in change.iter_mut() {
            *x *= spread.com / SMALL;
        }
        *size = spread.com;
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
        push(&mut all, Link { inertia, ..link.clone() }, size);
    }
    all
}

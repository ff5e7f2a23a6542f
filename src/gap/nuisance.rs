//! Parameters of the model that are not exactly known: they may explain what they can, within
//! what they are trusted.

use nalgebra::{DMatrix, Matrix3, Vector3};

use crate::arm::dynamics::{JOINT, RIGID, Regressor, link_parameters, parameter_count, write_rows};
use crate::arm::effects::Motion;
use crate::arm::robot::Link;

use super::record::{Record, RecordKind};

/// How much the parameters of the model are believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trust {
    /// Identified on this robot.
    Commissioned,
    /// From drawings.
    Cad,
    /// Not at all.
    Unknown,
}

/// Standard deviations of the parameters.
struct Spread {
    /// Of a mass, relative.
    mass: f64,
    /// Of a centre of mass \[m\].
    com: f64,
    /// Of inertias of links and rotors, relative.
    inertia: f64,
    /// Of friction, relative.
    friction: f64,
    /// Of an offset, of the largest torque.
    offset: f64,
}

impl Trust {
    fn spread(self) -> Spread {
        match self {
            Trust::Commissioned => {
                Spread { mass: 0.01, com: 0.003, inertia: 0.03, friction: 0.05, offset: 0.002 }
            }
            Trust::Cad => {
                Spread { mass: 0.1, com: 0.015, inertia: 0.2, friction: 0.25, offset: 0.005 }
            }
            Trust::Unknown => {
                Spread { mass: 10.0, com: 1.0, inertia: 20.0, friction: 20.0, offset: 2.0 }
            }
        }
    }
}

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

/// Stiction that any robot may have beyond its model, of Coulomb friction, and the speed at
/// which 1/e of it is left \[rad/s\].
const STICTION: f64 = 0.012;
const SLOW: f64 = 0.08;
/// Smooth torques that no model has: powers of position and of speed.
const OF_POSITION: std::ops::RangeInclusive<usize> = 0..=6;
const OF_SPEED: std::ops::RangeInclusive<usize> = 2..=6;
/// Of them, of the torque, where the model's error is no larger, and of this where it is.
const SMOOTH: f64 = 0.005;
const OF_ERROR: f64 = 0.7;
/// Least error that smooth torques have.
pub(super) fn smooth_error(error: f64) -> f64 {
    error.max(SMOOTH / OF_ERROR)
}

/// Change of friction from repetition to repetition, of itself.
const VARIES: f64 = 0.006;
/// The same from log to log: not of the same motion.
const DIFFERS: f64 = 0.02;

/// What a change of each parameter by one standard deviation adds to the torques: of each
/// parameter, of each joint, the series; behind the parameters what no model has.
pub(super) struct Nuisance {
    /// Names, such as `link 3 mass`.
    pub(super) names: Vec<String>,
    /// The size of one deviation in the parameter's unit.
    pub(super) deviations: Vec<f64>,
    /// Changes of the standard parameters for one deviation of each of the model's.
    pub(super) mixing: DMatrix<f64>,
    /// Columns from here on are in shares of the model's error.
    pub(super) errors_from: usize,
    /// By column, joints that it reaches with their rows \[Nm\].
    pub(super) series: Vec<Vec<(usize, Vec<f64>)>>,
}

/// What all logs of a robot have in common: a parameter has one size, a function one range.
pub(super) struct Common {
    /// By joint, the root mean square and the largest of the torque \[Nm\].
    torque: Vec<[f64; 2]>,
    /// By joint, the ranges of position \[rad\] and of the motor's rate \[rad/s\].
    ranges: Vec<[[f64; 2]; 2]>,
    /// Number of means.
    means: usize,
}

impl Common {
    /// Of all records.
    pub(super) fn new(records: &[Record<'_>]) -> Common {
        let dof = records.first().map_or(0, |record| record.motion.model.dof);
        let range = |of: &dyn Fn(&Record<'_>) -> Vec<f64>| -> [f64; 2] {
            let all = records.iter().flat_map(of);
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
        };
        Common {
            torque: (0..dof)
                .map(|joint| {
                    let scales: Vec<[f64; 2]> =
                        records.iter().map(|record| record.motion.scale(joint).torque).collect();
                    let squares: f64 = scales.iter().map(|[rms, _]| rms * rms).sum();
                    let mean = (squares / scales.len().max(1) as f64).sqrt();
                    [mean, scales.iter().map(|[_, largest]| *largest).fold(0.0, f64::max)]
                })
                .collect(),
            ranges: (0..dof)
                .map(|joint| {
                    [
                        range(&|record| record.motion.q[joint].clone()),
                        range(&|record| record.motion.rates[joint].clone()),
                    ]
                })
                .collect(),
            means: records.iter().filter(|record| record.kind != RecordKind::Drift).count(),
        }
    }
}

/// The parameters of a motion's model; `place` is that of a mean among the means.
pub(super) fn nuisance(
    record: &Record<'_>,
    trust: Trust,
    common: &Common,
    place: usize,
) -> Nuisance {
    let motion = &record.motion;
    let model = motion.model;
    let n = model.dof;
    let spread = trust.spread();
    let count = parameter_count(n);
    let mut names = Vec::new();
    let mut deviations = Vec::new();
    // Parameters of the regressor for a change of one deviation.
    let mut mixing = DMatrix::zeros(count, count);
    for (number, link) in model.links.iter().enumerate() {
        for (k, (change, size)) in of_link(link, &spread).into_iter().enumerate() {
            let column = RIGID * number + k;
            for (row, value) in change.into_iter().enumerate() {
                mixing[(RIGID * number + row, column)] = value;
            }
            names.push(format!("link {} {}", number + 1, LINK[k]));
            deviations.push(size);
        }
    }
    for joint in 0..n {
        let scale = motion.scale(joint);
        let inertia = spread.inertia * scale.rotor;
        let sizes = [
            inertia,
            spread.friction * scale.viscous,
            spread.friction * scale.coulomb,
            spread.offset * common.torque[joint][1],
        ];
        for (k, size) in sizes.into_iter().enumerate() {
            let column = RIGID * n + JOINT * joint + k;
            mixing[(column, column)] = size;
            names.push(format!("joint {} {}", joint + 1, OF_JOINT[k]));
            deviations.push(size);
        }
    }
    let series = match record.kind {
        RecordKind::Mean | RecordKind::Before => of_parameters(motion, &mixing),
        // No parameter changes from repetition to repetition.
        RecordKind::Drift => vec![Vec::new(); count],
    };
    let mut of = Nuisance { names, deviations, mixing, errors_from: 0, series };
    without_model(record, common, place, &mut of);
    of
}

/// What one deviation of each parameter adds.
fn of_parameters(motion: &Motion<'_>, mixing: &DMatrix<f64>) -> Vec<Vec<(usize, Vec<f64>)>> {
    let model = motion.model;
    let (n, rows, count) = (model.dof, motion.rows(), mixing.ncols());
    let mut scratch = Regressor::new();
    let mut regressor = DMatrix::zeros(n, count);
    let mut series: Vec<Vec<(usize, Vec<f64>)>> =
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

/// What no model has: a little friction at low speed, smooth functions of position and speed;
/// friction that changes from repetition to repetition.
fn without_model(record: &Record<'_>, common: &Common, place: usize, of: &mut Nuisance) {
    let motion = &record.motion;
    let n = motion.model.dof;
    let is_mean = record.kind != RecordKind::Drift;
    let push = |of: &mut Nuisance, name: &str, joint: usize, there: bool, series: Vec<f64>| {
        of.names.push(format!("joint {} {name}", joint + 1));
        of.deviations.push(1.0);
        of.series.push(if there { vec![(joint, series)] } else { Vec::new() });
    };
    for joint in 0..n {
        let scale = motion.scale(joint);
        let senses = &motion.senses[joint];
        let rates = &motion.rates[joint];
        let slow = |(sense, rate): (&f64, &f64)| {
            STICTION * scale.coulomb * sense * (-rate.abs() / SLOW).exp()
        };
        let series = senses.iter().zip(rates).map(slow).collect();
        push(of, "at low speed", joint, is_mean, series);
        for (name, size, series) in
            [("dry", scale.coulomb, senses), ("viscous", scale.viscous, rates)]
        {
            let of_size = |share: f64| series.iter().map(|x| share * size * x).collect();
            push(of, &format!("{name} friction changes"), joint, !is_mean, of_size(VARIES));
            // From log to log as well, where there are several.
            for log in 0..if common.means > 1 { common.means } else { 0 } {
                let there = is_mean && place == log;
                let name = format!("{name} friction in log {}", log + 1);
                push(of, &name, joint, there, of_size(DIFFERS));
            }
        }
    }
    of.errors_from = of.series.len();
    for joint in 0..n {
        let size = OF_ERROR * common.torque[joint][0];
        let [of_position, of_speed] = common.ranges[joint];
        // A line over the speed is viscous friction.
        for (x, [low, high], powers) in [
            (&motion.q[joint], of_position, OF_POSITION),
            (&motion.rates[joint], of_speed, OF_SPEED),
        ] {
            let (middle, half) = (f64::midpoint(low, high), (0.5 * (high - low)).max(1e-9));
            for power in powers {
                // Chebyshev polynomials: none is like another one.
                let wave = |x: &f64| {
                    let angle = ((x - middle) / half).clamp(-1.0, 1.0).acos();
                    size * (power as f64 * angle).cos()
                };
                push(of, "smooth", joint, is_mean, x.iter().map(wave).collect());
            }
        }
    }
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
        let size = spread.inertia * if row == column { own } else { moment };
        let mut inertia: Matrix3<f64> = link.inertia;
        inertia[(row, column)] += size;
        if row != column {
            inertia[(column, row)] += size;
        }
        push(&mut all, Link { inertia, ..link.clone() }, size);
    }
    all
}

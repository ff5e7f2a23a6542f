//! The truth of a case: what the faults change, what is left, and what can be told.

use super::logger::Style;
use super::plant::{Plant, Record};
use super::robot::Robot;
use crate::examine::worlds::api::{HeldOut, by_joint, held_out, minus, nats, single};
use crate::examine::worlds::model::{MAX, PARAMETERS, Row, Spread, one_off};

/// Rows of all logs for which the information is summed.
const ROWS: usize = 150;
/// Speed over which the sign of the model's friction turns \[rad/s\].
const TURN: f64 = 0.004;

/// Torque of a model with plain friction \[Nm\]; `rotor`: reflected inertias that are reported.
pub(super) fn model(robot: &Robot, rotor: &Row, q: &Row, v: &Row, a: &Row) -> Row {
    let mut out = robot.arm.torques(q, v, a);
    for i in 0..robot.arm.n() {
        out[i] +=
            rotor[i] * a[i] + robot.coulomb[i] * (v[i] / TURN).tanh() + robot.viscous[i] * v[i];
    }
    out
}

/// Rows of a record: (q, v, a, reported torque).
fn rows(record: &Record) -> impl Iterator<Item = (&Row, &Row, &Row, &Row)> {
    let motion = record.q.iter().zip(&record.v).zip(&record.a);
    motion.zip(&record.tau).map(|(((q, v), a), tau)| (q, v, a, tau))
}

fn whole_delta(record: &Record, row: usize) -> Row {
    let mut sum = [0.0; MAX];
    for delta in &record.delta {
        if let Some(own) = delta.get(row) {
            for (x, y) in sum.iter_mut().zip(own) {
                *x += y;
            }
        }
    }
    sum
}

/// Rms values of a record by joint; `rotor_in_file`: reflected inertias of the nominal file.
pub(super) fn levels(plant: &Plant, rotor_in_file: &Row, record: &Record) -> Vec<HeldOut> {
    let n = plant.robot.arm.n();
    let mut sums = [[0.0; MAX]; 4];
    let reported = minus(&plant.robot.arm.rotor, &plant.subtract);
    for (row, (q, v, a, tau)) in rows(record).enumerate() {
        let nominal = model(&plant.nominal, rotor_in_file, q, v, a);
        let exact = model(&plant.robot, &reported, q, v, a);
        let delta = whole_delta(record, row);
        for i in 0..n {
            sums[0][i] += tau[i] * tau[i];
            sums[1][i] += (tau[i] - nominal[i]).powi(2);
            sums[2][i] += delta[i] * delta[i];
            sums[3][i] += (tau[i] - delta[i] - exact[i]).powi(2);
        }
    }
    let count = record.t.len().max(1) as f64;
    let rms = sums.map(|sum| sum.map(|x| (x / count).sqrt()));
    held_out(n, [&rms[0], &rms[1], &rms[2], &rms[3]])
}

/// Speed above which a joint moves \[rad/s\].
const MOVING: f64 = 0.02;

/// Mean square of the everyday error by joint while the joint moves \[(Nm)²\]: at rest, the torque
/// within the stiction is anything, and no model tells it.
fn moving(plant: &Plant, records: &[Record]) -> Row {
    let reported = minus(&plant.robot.arm.rotor, &plant.subtract);
    let (mut sums, mut counts) = ([0.0; MAX], [1e-9; MAX]);
    for record in records {
        for (row, (q, v, a, tau)) in rows(record).enumerate().step_by(4) {
            let exact = model(&plant.robot, &reported, q, v, a);
            let delta = whole_delta(record, row);
            for i in 0..plant.robot.arm.n() {
                if v[i].abs() > MOVING {
                    sums[i] += (tau[i] - delta[i] - exact[i]).powi(2);
                    counts[i] += 1.0;
                }
            }
        }
    }
    for (sum, count) in sums.iter_mut().zip(counts) {
        *sum /= count;
    }
    sums
}

/// Squared torques of the faults, by joint.
pub(super) fn squares(n: usize, records: &[Record]) -> Vec<f64> {
    let mut squares = vec![0.0; n];
    for record in records {
        for row in 0..record.t.len() {
            for (sum, x) in squares.iter_mut().zip(whole_delta(record, row)) {
                *sum += x * x;
            }
        }
    }
    squares
}

/// Rows of the mean of the repetitions of all logs: a representative row and the mean of each
/// fault's contribution.
struct Mean {
    motion: Vec<(Row, Row, Row)>,
    delta: Vec<Vec<Row>>,
    cycles: f64,
}

fn mean(records: &[Record], period: f64, faults: usize) -> Mean {
    let mut out = Mean { motion: Vec::new(), delta: vec![Vec::new(); faults], cycles: 0.0 };
    let bins = (ROWS / records.len().max(1)).max(20);
    for record in records {
        let cycles = (record.t.last().copied().unwrap_or(0.0) / period).round().max(1.0);
        out.cycles += cycles / records.len().max(1) as f64;
        let step = if record.t.len() > 1 { record.t[1] - record.t[0] } else { 0.01 };
        let begin = record.t.iter().position(|t| *t >= 0.0).unwrap_or(0);
        for bin in 0..bins {
            let phase = (bin as f64 + 0.5) / bins as f64 * period;
            let mut sums = vec![[0.0; MAX]; faults];
            let mut kept = None;
            let mut count = 0.0;
            for cycle in 0..cycles as usize {
                let row = begin + ((phase + cycle as f64 * period) / step) as usize;
                if row < record.t.len() {
                    kept = kept.or(Some(row));
                    count += 1.0;
                    for (sum, delta) in sums.iter_mut().zip(&record.delta) {
                        for (x, y) in sum.iter_mut().zip(delta.get(row).unwrap_or(&[0.0; MAX])) {
                            *x += y;
                        }
                    }
                }
            }
            if let Some(row) = kept {
                out.motion.push((record.q[row], record.v[row], record.a[row]));
                for (list, sum) in out.delta.iter_mut().zip(&sums) {
                    list.push(sum.map(|x| x / count));
                }
            }
        }
    }
    out
}

/// What one standard deviation of each parameter changes, by parameter, joint and row \[Nm\].
fn columns(plant: &Plant, spread: &Spread, mean: &Mean, rotor_sd: &Row) -> Vec<Vec<Vec<f64>>> {
    let n = plant.nominal.arm.n();
    let base = &plant.nominal.arm;
    let plain: Vec<Row> = mean.motion.iter().map(|(q, v, a)| base.torques(q, v, a)).collect();
    let mut out = Vec::new();
    let mut add = |rows: Vec<Row>| out.push(by_joint(n, &rows));
    for link in 0..n {
        for parameter in 0..PARAMETERS {
            let mut arm = base.clone();
            arm.bodies[link] = one_off(&base.bodies[link], parameter, spread);
            let rows = mean.motion.iter().zip(&plain);
            add(rows.map(|((q, v, a), old)| minus(&arm.torques(q, v, a), old)).collect());
        }
    }
    for i in 0..n {
        let mut own = |f: &dyn Fn(&Row, &Row) -> f64| {
            add(mean.motion.iter().map(|(_, v, a)| single(i, f(v, a))).collect());
        };
        let (dry, wet) = (plant.nominal.coulomb[i], plant.nominal.viscous[i]);
        own(&|_, a| rotor_sd[i] * a[i]);
        own(&|v, _| spread.friction * dry * (v[i] / TURN).tanh());
        own(&|v, _| spread.friction * wet * v[i]);
    }
    out
}

/// Information about each fault \[nats\].
pub(super) fn information(
    plant: &Plant,
    spread: &Spread,
    logs: (&[Record], f64),
    rotor_in_file: &Row,
    style: &Style,
) -> Vec<f64> {
    let (records, period) = logs;
    let n = plant.robot.arm.n();
    let faults = records.first().map_or(0, |record| record.delta.len());
    let mean = mean(records, period, faults);
    let mut rotor_sd = [0.0; MAX];
    for i in 0..n {
        let known = rotor_in_file[i] + plant.subtract[i] > 0.0;
        rotor_sd[i] = plant.nominal.arm.rotor[i] * if known { spread.inertia } else { 1.0 };
    }
    let columns = columns(plant, spread, &mean, &rotor_sd);
    let left = moving(plant, records);
    let sd: Vec<f64> = (0..n)
        .map(|i| (style.deviation(i).powi(2) / mean.cycles.max(1.0) + left[i]).sqrt())
        .collect();
    mean.delta.iter().map(|rows| nats(&by_joint(n, rows), &sd, &columns)).collect()
}

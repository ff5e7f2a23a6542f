//! What is true of a case: sizes of faults, the expected evidence, the gap on the held-out log.

use super::drive::{Rotors, Run, World, logged};
use super::fault::Fault;
use super::motion::STEP;
use super::spatial::Point;
use crate::examine::worlds::api::{HeldOut, by_joint, held_out, minus, nats, rms, single};
use crate::examine::worlds::model::{MAX, PARAMETERS, Row, Spread, one_off};

/// Rows by log in the evidence.
const ROWS: usize = 100;
/// Everyday error of a lag that a diagnosis cannot tell from a fault \[s\].
const LAG_SD: f64 = 0.002;
/// Everyday offset, share of the usual torque.
const OFFSET_SD: f64 = 0.006;

/// Rms of a difference of two series, by joint.
pub(super) fn apart(a: &[Row], b: &[Row]) -> Row {
    rms(a.iter().zip(b).map(|(a, b)| minus(a, b)))
}

/// The largest ratio over the joints of a change to the torque.
pub(super) fn share(change: &Row, torque: &Row) -> f64 {
    change.iter().zip(torque).map(|(change, torque)| change / torque.max(1e-9)).fold(0.0, f64::max)
}

/// States of a run on its grid, all periods.
fn points(run: &Run) -> impl Iterator<Item = &Point> {
    (0..run.cycles).flat_map(|cycle| match &run.entry {
        Some(entry) if cycle == 0 => &entry.points,
        _ => &run.track.points,
    })
}

/// Everyday error by joint: what the robot without faults differs from the plain model with its
/// own parameters.
pub(super) fn everyday(world: &World, run: &Run, clean: &[Row]) -> Row {
    rms(points(run).zip(clean).map(|(at, torque)| minus(torque, &world.plain(&world.real, at))))
}

/// The gap on a held-out log.
pub(super) fn heldout(world: &World, run: &Run, faults: &[Fault]) -> Vec<HeldOut> {
    let clean = logged(world, run, &[]);
    let all = if faults.is_empty() { clean.clone() } else { logged(world, run, faults) };
    let torque = rms(all.iter().copied());
    let model = rms(points(run)
        .zip(&all)
        .map(|(at, torque)| minus(torque, &world.plain(&world.nominal, at))));
    let effects = apart(&all, &clean);
    let left = everyday(world, run, &clean);
    held_out(world.nominal.axes(), [&torque, &model, &effects, &left])
}

/// Thinned phases \[steps\] of a run.
fn phases(run: &Run) -> impl Iterator<Item = usize> {
    let count = run.track.points.len();
    (0..ROWS).map(move |row| row * count / ROWS)
}

/// Mean over the repetitions of a difference at the thinned phases, by joint.
fn mean_change(run: &Run, with: &[Row], without: &[Row], axes: usize) -> Vec<Vec<f64>> {
    let count = run.track.points.len();
    let first = usize::from(run.entry.is_some() && run.cycles > 1);
    let mut out = vec![Vec::with_capacity(ROWS); axes];
    for phase in phases(run) {
        let mut sum = [0.0; MAX];
        for cycle in first..run.cycles {
            let at = cycle * count + phase;
            if let (Some(a), Some(b)) = (with.get(at), without.get(at)) {
                for (sum, change) in sum.iter_mut().zip(minus(a, b)) {
                    *sum += change / (run.cycles - first) as f64;
                }
            }
        }
        for (rows, sum) in out.iter_mut().zip(sum) {
            rows.push(sum);
        }
    }
    out
}

/// Evidence of the faults of a case.
pub(super) struct Evidence<'a> {
    world: &'a World,
    runs: &'a [Run],
    /// Standard deviation of a row by joint.
    sd: Vec<f64>,
    /// Nuisances: by nuisance, by joint, rows of all logs and baselines.
    columns: Vec<Vec<Vec<f64>>>,
    /// Rows of the baselines, where no fault acts.
    before: usize,
}

impl<'a> Evidence<'a> {
    /// Evidence of logs, perhaps with baselines, of a robot with a spread of its parameters.
    pub(super) fn new(
        world: &'a World,
        runs: &'a [Run],
        baselines: &[Run],
        spread: &Spread,
        left: &Row,
    ) -> Self {
        let mut sd = Vec::new();
        for (i, habit) in world.everyday.joints.iter().enumerate() {
            let cycles = runs.iter().map(|run| run.cycles).max().unwrap_or(1) as f64;
            let noise =
                (habit.white.powi(2) + habit.coloured.powi(2) + habit.quantum.powi(2) / 12.0)
                    / cycles;
            sd.push((left[i] * left[i] + noise).sqrt());
        }
        let states: Vec<Point> = runs
            .iter()
            .chain(baselines)
            .flat_map(|run| phases(run).filter_map(|k| run.track.points.get(k).copied()))
            .collect();
        let columns = nuisances(world, &states, spread);
        Self { world, runs, sd, columns, before: ROWS * baselines.len() }
    }

    /// Nats of one fault (by its place in the list) with the others present.
    pub(super) fn nats(&self, faults: &[Fault], which: usize, with: &[Vec<Row>]) -> f64 {
        let axes = self.world.nominal.axes();
        let mut others = faults.to_vec();
        if which < others.len() {
            others.remove(which);
        }
        let mut delta = vec![Vec::new(); axes];
        for (run, with) in self.runs.iter().zip(with) {
            let without = logged(self.world, run, &others);
            for (rows, change) in delta.iter_mut().zip(mean_change(run, with, &without, axes)) {
                rows.extend(change);
            }
        }
        for rows in &mut delta {
            rows.resize(rows.len() + self.before, 0.0);
        }
        nats(&delta, &self.sd, &self.columns)
    }
}

/// By nuisance and joint: what one standard deviation changes, at some states.
fn nuisances(world: &World, states: &[Point], spread: &Spread) -> Vec<Vec<Vec<f64>>> {
    let arm = &world.nominal;
    let axes = arm.axes();
    let plain: Vec<Row> = states.iter().map(|at| arm.rigid(at)).collect();
    let mut columns = Vec::new();
    let mut add = |rows: Vec<Row>| columns.push(by_joint(axes, &rows));
    for link in 0..axes {
        for parameter in 0..PARAMETERS {
            let mut off = arm.clone();
            off.bodies[link] = one_off(&arm.bodies[link], parameter, spread);
            add(states
                .iter()
                .zip(&plain)
                .map(|(at, plain)| minus(&off.rigid(at), plain))
                .collect());
        }
    }
    let rotor_sd = if world.rotors == Rotors::Left { 1.0 } else { spread.inertia };
    for i in 0..axes {
        let mut of_joint = |value: &dyn Fn(&Point) -> f64| {
            add(states.iter().map(|at| single(i, value(at))).collect());
        };
        let (coulomb, viscous) = (arm.coulomb[i], arm.viscous[i]);
        of_joint(&|at| spread.friction * coulomb * (at.v[i] / 0.01).tanh());
        of_joint(&|at| spread.friction * viscous * at.v[i]);
        of_joint(&|at| rotor_sd * arm.rotor[i] * at.a[i]);
        of_joint(&|_| OFFSET_SD * arm.usual[i]);
        // Everyday shapes of friction: dip at low rates, unevenness over the angle, bend.
        of_joint(&|at| 0.04 * coulomb * at.v[i].signum() / (1.0 + (at.v[i] / 0.04).powi(2)));
        of_joint(&|at| 0.03 * coulomb * at.v[i].signum() * at.q[i].cos());
        of_joint(&|at| 0.03 * coulomb * at.v[i].signum() * at.q[i].sin());
        of_joint(&|at| 0.05 * viscous * at.v[i] * at.v[i].abs() / arm.speed[i]);
    }
    // Everyday loss per torque through the gear.
    for i in 0..axes {
        let loss =
            |(at, plain): (&Point, &Row)| single(i, 0.004 * plain[i].abs() * at.v[i].signum());
        add(states.iter().zip(&plain).map(loss).collect());
    }
    // The lag of all torques: the torque a little later, extrapolated with the present acceleration.
    let late = |(at, plain): (&Point, &Row)| {
        let mut next = *at;
        for i in 0..axes {
            next.q[i] += STEP * at.v[i];
            next.v[i] += STEP * at.a[i];
        }
        minus(&arm.rigid(&next), plain).map(|change| change * LAG_SD / STEP)
    };
    add(states.iter().zip(&plain).map(late).collect());
    columns
}

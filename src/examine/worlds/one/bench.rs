//! The measuring bench: what a fault changes in the mean of the repetitions, how large the everyday
//! error is, and what the truth says of both.

use crate::api::{self, HeldOut};
use crate::arm::{Arm, Body, M3, MAX, Row, Spread, V3};
use crate::dynamics::model;
use crate::everyday::Day;
use crate::faults::Fault;
use crate::motion::{STEP, Track};
use crate::plant::{Robot, Run, Sample, Tables};

/// Rows per log and joint in which means are compared: the smooth parts of a motion need no more.
pub const ROWS: usize = 120;
/// Time before the rows for which friction and gears settle \[s\].
const PREROLL: f64 = 4.0;
/// With a baseline, what is known of bodies narrows to this share of its spread.
const KNOWN: f64 = 0.25;
/// Friction changes by this share between days, where the baseline tells its level.
const DAYS: f64 = 0.03;
/// Offsets of drives that nobody trusts, over the rms torque.
const OFFSET: f64 = 0.01;

/// One motion, its tables and its day.
pub struct Stage<'a> {
    /// The motion.
    pub track: &'a Track,
    /// Its tables.
    pub tables: &'a Tables,
    /// Its day.
    pub day: &'a Day,
}

/// A robot and its nominal model.
pub struct Bench<'a> {
    /// The real robot.
    pub robot: &'a Robot<'a>,
    /// The model.
    pub nominal: &'a Arm,
    /// Whether the model has rotors.
    pub rotors: bool,
}

/// Times \[s\] of the rows: of one steady period, or of all periods.
fn times(track: &Track, drifts: bool) -> Vec<f64> {
    let period = track.period();
    let (first, cycles) = if drifts { (0, track.cycles) } else { (2.min(track.cycles - 1), 1) };
    let mut out = Vec::with_capacity(ROWS * cycles);
    for cycle in first..first + cycles {
        for row in 0..ROWS {
            out.push(period * (cycle as f64 + (row as f64 + 0.5) / ROWS as f64));
        }
    }
    out
}

/// Rms of some numbers.
fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for x in values {
        sum += x * x;
        count += 1.0;
    }
    if count > 0.0 { f64::sqrt(sum / count) } else { 0.0 }
}

impl Bench<'_> {
    /// Samples of a stage at the rows, without noise.
    pub fn rows(&self, stage: &Stage, faults: &[&Fault], drifts: bool) -> Vec<Sample> {
        let times = times(stage.track, drifts);
        let first = times.first().copied().unwrap_or(0.0) / STEP;
        // In steady repetition a few seconds before the rows are enough.
        let from = if drifts || stage.track.cycles < 3 {
            0
        } else {
            (first as usize).saturating_sub((PREROLL / STEP) as usize).max(stage.track.steps)
        };
        let place = (stage.track, stage.tables);
        Run::starting(self.robot, place, faults, stage.day, from).samples(&times)
    }

    /// Torque less the nominal model's \[Nm\]; friction follows the direction of `sign`.
    fn residual(&self, s: &Sample, sign: &Row) -> Row {
        let told = model(self.nominal, (&s.q, &s.v, &s.a), sign, self.rotors);
        let mut out = [0.0; MAX];
        for j in 0..self.nominal.count() {
            out[j] = s.tau[j] - told[j];
        }
        out
    }

    /// What faults change in the residual \[Nm\], by joint and row of the mean.
    pub fn change(&self, with: &[Sample], without: &[Sample]) -> Vec<Vec<f64>> {
        let count = self.nominal.count();
        let cycles = (with.len() / ROWS).max(1);
        let mut out = vec![vec![0.0; ROWS]; count];
        for (n, (a, b)) in with.iter().zip(without).enumerate() {
            let (ra, rb) = (self.residual(a, &b.sign), self.residual(b, &b.sign));
            for j in 0..count {
                out[j][n % ROWS] += (ra[j] - rb[j]) / cycles as f64;
            }
        }
        out
    }

    /// Rms of the changes of each row itself \[Nm\], not of their mean.
    pub fn spread(&self, with: &[Sample], without: &[Sample]) -> Row {
        let mut out = [0.0; MAX];
        for (a, b) in with.iter().zip(without) {
            let (ra, rb) = (self.residual(a, &b.sign), self.residual(b, &b.sign));
            for j in 0..self.nominal.count() {
                out[j] += (ra[j] - rb[j]).powi(2) / with.len() as f64;
            }
        }
        out.map(f64::sqrt)
    }

    /// Rms \[Nm\] of what the model with the real parameters does not say, by joint.
    pub fn left(&self, without: &[Sample]) -> Row {
        let mut out = [0.0; MAX];
        let rows: Vec<Row> = without
            .iter()
            .map(|s| {
                let mut tau = model(self.robot.arm, (&s.q, &s.v, &s.a), &s.sign, true);
                for j in 0..MAX {
                    tau[j] -= self.robot.removed[j] * s.a[j];
                }
                tau
            })
            .collect();
        for (j, value) in out.iter_mut().enumerate().take(self.nominal.count()) {
            *value = rms(without.iter().zip(&rows).map(|(s, tau)| s.tau[j] - tau[j]));
        }
        out
    }

    /// The gap on a held-out log.
    pub fn heldout(&self, with: &[Sample], without: &[Sample]) -> Vec<HeldOut> {
        let (effects, left) = (self.spread(with, without), self.left(without));
        let residuals: Vec<Row> = with.iter().map(|s| self.residual(s, &s.sign)).collect();
        (0..self.nominal.count())
            .map(|j| HeldOut {
                joint: j + 1,
                torque: rms(with.iter().map(|s| s.tau[j])),
                model: rms(residuals.iter().map(|r| r[j])),
                effects: effects[j],
                left: left[j],
            })
            .collect()
    }

    /// What one standard deviation of each parameter changes in the rows, by column and joint.
    pub fn columns(
        &self,
        rows: &[&[Sample]],
        spread: Spread,
        baseline: bool,
    ) -> Vec<Vec<Vec<f64>>> {
        let arm = self.robot.arm;
        let count = arm.count();
        let mut out = Vec::new();
        let known = if baseline { KNOWN } else { 1.0 };
        let friction = if baseline { DAYS.min(spread.friction) } else { spread.friction };
        for k in 0..count {
            for body in deltas(&arm.bodies[k], spread, known) {
                out.push(self.column(rows, &|s| {
                    let pose = crate::dynamics::pose(arm, &s.q);
                    let bodies = [(k, &body.0, 1.0), (k, &body.1, -1.0)];
                    let mut tau = [0.0; MAX];
                    for (link, b, sign) in bodies {
                        let part = crate::dynamics::torques(
                            std::iter::once((link, b)),
                            &pose,
                            (&s.v, &s.a),
                            &crate::dynamics::down(),
                        );
                        for j in 0..count {
                            tau[j] += sign * part[j];
                        }
                    }
                    tau
                }));
            }
            let single = |f: &dyn Fn(&Sample) -> f64, s: &Sample| {
                let mut tau = [0.0; MAX];
                tau[k] = f(s);
                tau
            };
            let rotor = spread.inertia * known * arm.rotor[k];
            let (c, b) = (friction * arm.coulomb[k], friction * arm.viscous[k]);
            let offset = OFFSET * self.robot.level.torque[k] * known;
            out.push(self.column(rows, &|s| single(&|s| rotor * s.a[k], s)));
            out.push(self.column(rows, &|s| single(&|s| c * s.sign[k], s)));
            out.push(self.column(rows, &|s| single(&|s| b * s.v[k], s)));
            out.push(self.column(rows, &|s| single(&|_| offset, s)));
        }
        out
    }

    /// One column: a torque of each row, logs behind one another, by joint.
    fn column(&self, rows: &[&[Sample]], torque: &dyn Fn(&Sample) -> Row) -> Vec<Vec<f64>> {
        let mut out = vec![Vec::new(); self.nominal.count()];
        for samples in rows {
            for s in samples.iter().take(ROWS) {
                let tau = torque(s);
                for (j, column) in out.iter_mut().enumerate() {
                    column.push(tau[j]);
                }
            }
        }
        out
    }

    /// Expected log-likelihood ratio \[nats\] of a change.
    pub fn nats(&self, change: &[Vec<f64>], sd: &Row, columns: &[Vec<Vec<f64>>]) -> f64 {
        api::nats(change, &sd[..self.nominal.count()], columns)
    }
}

/// A body one deviation off, and the body as it is, for each parameter.
fn deltas(body: &Body, spread: Spread, known: f64) -> Vec<(Body, Body)> {
    let mut out = Vec::new();
    let scaled = |by: f64| Body { mass: body.mass * by, com: body.com, inertia: body.inertia * by };
    let none = || Body { mass: 0.0, com: V3::zeros(), inertia: M3::zeros() };
    out.push((scaled(spread.mass * known), none()));
    for axis in 0..3 {
        let mut moved = body.clone();
        moved.com[axis] += spread.com * known;
        out.push((moved, body.clone()));
        let mut turned = none();
        turned.inertia[(axis, axis)] = spread.inertia * known * body.inertia[(axis, axis)];
        out.push((turned, none()));
    }
    out
}

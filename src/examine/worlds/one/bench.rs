//! The measuring bench: what a fault changes in the mean of the repetitions, how large the everyday
//! error is, and what the truth says of both.

use super::arm::Arm;
use super::dynamics::{down, model, pose, torques};
use super::everyday::Day;
use super::faults::Fault;
use super::motion::{STEP, Track};
use super::plan::Rotors;
use super::plant::{Robot, Run, Sample, Tables};
use crate::examine::worlds::api::{HeldOut, by_joint, held_out, minus, nats, rms, single};
use crate::examine::worlds::model::{MAX, PARAMETERS, Row, Spread, one_off};
use std::iter::once;

/// Rows per log and joint in which means are compared: the smooth parts of a motion need no more.
pub(super) const ROWS: usize = 120;
/// Time before the rows for which friction and gears settle \[s\].
const PREROLL: f64 = 4.0;
/// With a baseline, what is known of bodies narrows to this share of its spread.
const KNOWN: f64 = 0.25;
/// Friction changes by this share between days, where the baseline tells its level.
const DAYS: f64 = 0.03;
/// Offsets of drives that nobody trusts, over the rms torque.
const OFFSET: f64 = 0.01;

/// One motion, its tables and its day.
pub(super) struct Stage<'a> {
    pub(super) track: &'a Track,
    pub(super) tables: &'a Tables,
    pub(super) day: &'a Day,
}

/// The real robot and its nominal model.
pub(super) struct Bench<'a> {
    pub(super) robot: &'a Robot<'a>,
    pub(super) nominal: &'a Arm,
    pub(super) rotors: Rotors,
}

/// Times \[s\] of the rows: of one steady period, or of all periods.
fn times(track: &Track, drifts: bool) -> Vec<f64> {
    let (first, cycles) = if drifts { (0, track.cycles) } else { (2.min(track.cycles - 1), 1) };
    let row = |k: usize| track.period() * (first as f64 + (k as f64 + 0.5) / ROWS as f64);
    (0..cycles * ROWS).map(row).collect()
}

impl Bench<'_> {
    /// Samples of a stage at the rows, without noise.
    pub(super) fn rows(&self, stage: &Stage, faults: &[&Fault], drifts: bool) -> Vec<Sample> {
        let times = times(stage.track, drifts);
        // In steady repetition a few seconds before the rows are enough.
        let from = if drifts || stage.track.cycles < 3 {
            0
        } else {
            (((times[0] - PREROLL) / STEP) as usize).max(stage.track.steps)
        };
        let place = (stage.track, stage.tables);
        Run::starting(self.robot, place, faults, stage.day, from).samples(&times)
    }

    /// Torque less the nominal model's \[Nm\]; friction follows the direction of `sign`.
    fn residual(&self, s: &Sample, sign: &Row) -> Row {
        let rotors = self.rotors == Rotors::InModel;
        minus(&s.tau, &model(self.nominal, (&s.q, &s.v, &s.a), sign, rotors))
    }

    /// What faults change in the residual \[Nm\], by row.
    fn changes(&self, with: &[Sample], without: &[Sample]) -> impl Iterator<Item = Row> {
        let one = |(a, b): (&Sample, &Sample)| {
            minus(&self.residual(a, &b.sign), &self.residual(b, &b.sign))
        };
        with.iter().zip(without).map(one)
    }

    /// The same by joint and row of the mean of the repetitions.
    pub(super) fn change(&self, with: &[Sample], without: &[Sample]) -> Vec<Vec<f64>> {
        let cycles = (with.len() / ROWS).max(1) as f64;
        let mut out = vec![vec![0.0; ROWS]; self.nominal.count()];
        for (n, change) in self.changes(with, without).enumerate() {
            for (rows, value) in out.iter_mut().zip(change) {
                rows[n % ROWS] += value / cycles;
            }
        }
        out
    }

    /// Rms of the changes of each row itself \[Nm\], not of their mean.
    pub(super) fn spread(&self, with: &[Sample], without: &[Sample]) -> Row {
        rms(self.changes(with, without))
    }

    /// Rms \[Nm\] of what the model with the real parameters does not say, by joint.
    pub(super) fn left(&self, without: &[Sample]) -> Row {
        rms(without.iter().map(|s| {
            let mut told = model(self.robot.arm, (&s.q, &s.v, &s.a), &s.sign, true);
            for j in 0..MAX {
                told[j] -= self.robot.removed[j] * s.a[j];
            }
            minus(&s.tau, &told)
        }))
    }

    /// The gap on a held-out log.
    pub(super) fn heldout(&self, with: &[Sample], without: &[Sample]) -> Vec<HeldOut> {
        let torque = rms(with.iter().map(|s| s.tau));
        let model = rms(with.iter().map(|s| self.residual(s, &s.sign)));
        let (effects, left) = (self.spread(with, without), self.left(without));
        held_out(self.nominal.count(), [&torque, &model, &effects, &left])
    }

    /// What one standard deviation of each parameter changes in the rows, by column and joint.
    pub(super) fn columns(
        &self,
        rows: &[Sample],
        spread: Spread,
        baseline: bool,
    ) -> Vec<Vec<Vec<f64>>> {
        let arm = self.robot.arm;
        let mut out = Vec::new();
        let mut add = |torque: &dyn Fn(&Sample) -> Row| {
            let column: Vec<Row> = rows.iter().map(torque).collect();
            out.push(by_joint(arm.count(), &column));
        };
        let known = if baseline { KNOWN } else { 1.0 };
        let friction = if baseline { DAYS.min(spread.friction) } else { spread.friction };
        for k in 0..arm.count() {
            let body = &arm.bodies[k];
            for parameter in 0..PARAMETERS {
                let off = one_off(body, parameter, &spread);
                add(&|s| {
                    let pose = pose(arm, &s.q);
                    let of = |body| torques(once((k, body)), &pose, (&s.v, &s.a), &down());
                    minus(&of(&off), &of(body)).map(|tau| known * tau)
                });
            }
            let rotor = spread.inertia * known * arm.rotor[k];
            let (c, b) = (friction * arm.coulomb[k], friction * arm.viscous[k]);
            add(&|s| single(k, rotor * s.a[k]));
            add(&|s| single(k, c * s.sign[k]));
            add(&|s| single(k, b * s.v[k]));
            add(&|_| single(k, OFFSET * self.robot.level.torque[k] * known));
        }
        out
    }

    /// Expected log-likelihood ratio \[nats\] of a change.
    pub(super) fn nats(&self, change: &[Vec<f64>], sd: &Row, columns: &[Vec<Vec<f64>>]) -> f64 {
        nats(change, &sd[..self.nominal.count()], columns)
    }
}

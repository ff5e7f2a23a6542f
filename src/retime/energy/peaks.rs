//! The peak torque of each joint over plausible robots.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::along::{Along, Instant};
use super::change::Changes;
use crate::arm::dynamics::{Data, torque};
use crate::arm::robot::{MAX_DOF, Model};
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Event, Run, What};

/// Sample step \[s\] and number of its parts around a peak.
const STEP: f64 = 0.02;
const PARTS: i32 = 8;
/// Number of instants per joint at which plausible robots are evaluated: the largest torques of the
/// model that are at least this time \[s\] apart.
const MOST: usize = 6;
const APART: f64 = 0.1;
/// Candidates per instant: samples of one peak are close together.
const NEAR: usize = 12;

/// Peak torques in a simulation \[Nm\], per joint and robot; 0 without motion.
pub(super) fn peaks(model: &Model, robots: &Changes, simulation: &Simulation) -> Vec<Vec<f64>> {
    let instants = largest(model, simulation);
    let along = Along::new(model, &instants, Vec::new());
    let torques = along.torques(robots);
    let largest = |torques: DMatrix<f64>| -> Vec<f64> {
        torques.column_iter().map(|of_robot| of_robot.amax()).collect()
    };
    torques.into_iter().map(largest).collect()
}

/// A sample of a run of a simulation.
struct Sample<'s> {
    event: &'s Event,
    run: &'s Run,
    /// Time in the run \[s\].
    t: f64,
    /// Absolute torques of the model \[Nm\].
    torque: [f64; MAX_DOF],
}

impl<'s> Sample<'s> {
    fn at(
        model: &Model,
        data: &mut Data,
        (event, run): (&'s Event, &'s Run),
        t: f64,
    ) -> Sample<'s> {
        let state = run.at(t);
        let tau = torque(model, data, &run.load, &state.q, &state.qd, &state.qdd);
        let torque = std::array::from_fn(|j| (tau.rigid[j] + tau.friction[j]).abs());
        Sample { event, run, t, torque }
    }

    /// Time in the simulation \[s\].
    fn time(&self) -> f64 {
        self.event.t_start + self.t
    }

    /// The instant of the peak torque of a joint near this sample.
    fn peak(&self, model: &Model, data: &mut Data, joint: usize) -> Instant {
        let around = (1 - PARTS..PARTS).map(|i| self.t + STEP * f64::from(i) / f64::from(PARTS));
        let (mut t, mut most) = (self.t, self.torque[joint]);
        for near in around.filter(|t| (0.0..=self.event.duration).contains(t)) {
            let torque = Sample::at(model, data, (self.event, self.run), near).torque[joint];
            if torque > most {
                (t, most) = (near, torque);
            }
        }
        Instant { load: self.run.load.clone(), state: self.run.at(t).list() }
    }
}

/// The instants of the largest torques of each joint.
fn largest(model: &Model, simulation: &Simulation) -> Vec<Instant> {
    let samples: Vec<Sample> =
        simulation.events.par_iter().flat_map_iter(|event| samples(model, event)).collect();
    let mut data = Data::new();
    let mut instants = Vec::new();
    for j in 0..model.dof {
        let mut order: Vec<&Sample> = samples.iter().collect();
        let larger = |a: &&Sample, b: &&Sample| b.torque[j].total_cmp(&a.torque[j]);
        if order.len() > MOST * NEAR {
            order.select_nth_unstable_by(MOST * NEAR, larger);
            order.truncate(MOST * NEAR);
        }
        order.sort_by(larger);
        let mut own: Vec<&Sample> = Vec::new();
        for sample in order {
            if own.len() < MOST && own.iter().all(|it| (it.time() - sample.time()).abs() > APART) {
                own.push(sample);
            }
        }
        instants.extend(own.into_iter().map(|sample| sample.peak(model, &mut data, j)));
    }
    instants
}

fn samples<'s>(model: &Model, event: &'s Event) -> Vec<Sample<'s>> {
    let What::Run(run) = &event.what else { return Vec::new() };
    let mut data = Data::new();
    let steps = (event.duration / STEP).ceil().max(1.0);
    let times = (0..=steps as usize).map(|i| event.duration * i as f64 / steps);
    times.map(|t| Sample::at(model, &mut data, (event, run), t)).collect()
}

//! A limit on joint torques for robots whose torque limits are estimated.
//!
//! The robot is known to be able to do its original motion. Accelerations of streams always stay
//! within those of the original cycle (`optimize::allowed::Loads`). With estimated torque limits,
//! the same holds for the peak torque of each joint in 95 % of the plausible robots.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::candidate::{Candidate, State};
use super::job::Job;
use super::planning::Planning;
use crate::arm::robot::{Model, Provenance};
use crate::retime::energy::along::{Along, Instant};
use crate::retime::energy::plausible::{Robots, moments};
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Event, What};
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::retime::{Goal, retime};
use crate::retime::path::joint_path::DOF;

/// Share of the plausible robots in which the torque must stay within the limit.
const ENOUGH: f64 = 0.95;
/// Sampling step \[s\], and the factor that allows for peaks between samples.
const STEP: f64 = 0.01;
const SAMPLING_MARGIN: f64 = 1.01;

/// Maximum number of plans of a stream, and the extra reduction of torque per plan: a torque at its
/// limit in one robot exceeds it in others.
const MAX_PLANS: usize = 4;
const REDUCTION: f64 = 0.99;

/// Whether the torque limits are estimates.
fn is_estimated(model: &Model) -> bool {
    model.provenance_of("limits", "torque") == Some(Provenance::Estimated)
}

/// The mean over the plausible robots, whose energy is minimised, if torque limits are estimates.
pub(super) fn mean_robot(
    model: &Model,
    robots: Option<&Robots>,
    simulation: &Simulation,
) -> Option<Model> {
    robots.filter(|_| is_estimated(model))?.mean(model, &moments(model, simulation))
}

/// Peak torque of each joint in a motion \[Nm\], one entry per robot.
struct PeakTorques(Vec<[f64; DOF]>);

impl PeakTorques {
    /// The peaks over the runs among some events.
    fn in_runs<'e>(
        model: &Model,
        robots: &Robots,
        events: impl Iterator<Item = &'e Event>,
    ) -> PeakTorques {
        let mut instants = Vec::new();
        for event in events {
            let What::Run(run) = &event.what else { continue };
            let count = (event.duration / STEP).ceil();
            instants.extend((0..=count as usize).map(|i| {
                let state = run.at(event.duration * i as f64 / count.max(1.0));
                Instant { load: run.load.clone(), state: [state.q, state.qd, state.qdd] }
            }));
        }
        let along = Along::new(model, &instants, Vec::new());
        let torques = along.torques(robots.drawn());
        let count = torques.first().map_or(0, nalgebra::Matrix::ncols);
        let largest = |robot| std::array::from_fn(|j| torques[j].column(robot).amax());
        PeakTorques((0..count).map(largest).collect())
    }

    /// The 95 % quantile over the robots of each joint's torque ratio to `original`; and the first
    /// joint beyond the limit (from 1) with the share of robots within it.
    fn over(&self, original: &PeakTorques) -> ([f64; DOF], Option<(usize, f64)>) {
        let mut exceeds = None;
        let ratios = std::array::from_fn(|j| {
            let pairs = self.0.iter().zip(&original.0);
            let mut ratios: Vec<f64> =
                pairs.map(|(new, old)| new[j] / old[j].max(f64::MIN_POSITIVE)).collect();
            let within = ratios.iter().filter(|ratio| **ratio <= SAMPLING_MARGIN).count();
            let share = within as f64 / ratios.len().max(1) as f64;
            if share < ENOUGH && exceeds.is_none() {
                exceeds = Some((j + 1, share));
            }
            ratios.sort_by(f64::total_cmp);
            let place = (ENOUGH * ratios.len() as f64).ceil() as usize;
            ratios.get(place.saturating_sub(1)).copied().unwrap_or(1.0)
        });
        (ratios, exceeds)
    }
}

/// Plans streams again that exceed the torques of the original cycle.
pub(super) struct TorqueBound<'a> {
    job: &'a Job<'a>,
    robots: &'a Robots,
    original: PeakTorques,
    /// Per candidate beyond the limit: number of plans, torque limits relative to the original.
    planned: BTreeMap<usize, (usize, [f64; DOF])>,
}

impl<'a> TorqueBound<'a> {
    /// `None` if the torque limits are not estimates.
    pub(super) fn new(job: &'a Job<'a>) -> Option<TorqueBound<'a>> {
        let robots = job.robots.as_ref().filter(|_| is_estimated(job.model))?;
        let events = job.original.cycle.simulation.events.iter();
        let original = PeakTorques::in_runs(job.model, robots, events);
        Some(TorqueBound { job, robots, original, planned: BTreeMap::new() })
    }

    /// New states of the candidates whose streams exceed the torques of the original in the
    /// simulation `after`: a stream with less torque, or the reason for refusal.
    pub(super) fn replanned(
        &mut self,
        after: &Simulation,
        candidates: &[Candidate],
        planning: &Planning<'_>,
    ) -> Vec<(usize, State)> {
        let mut exceeding = Vec::new();
        for (index, candidate) in candidates.iter().enumerate() {
            let Some(stream) = candidate.retiming() else { continue };
            let Some(event) = self.job.original.events(candidate).first() else { continue };
            let event = after.events.get(*event).into_iter();
            let own = PeakTorques::in_runs(self.job.model, self.robots, event);
            let (ratios, exceeds) = own.over(&self.original);
            if let Some((joint, share)) = exceeds {
                let (plans, torques) = self.planned.entry(index).or_insert((1, [1.0; DOF]));
                *plans += 1;
                for (torque, ratio) in torques.iter_mut().zip(ratios) {
                    if ratio > 1.0 {
                        *torque *= REDUCTION / ratio;
                    }
                }
                let again = (*plans <= MAX_PLANS).then_some((*torques, stream.duration_s));
                exceeding.push((index, again, Reason::AsksMore(joint, share)));
            }
        }
        let states = exceeding.par_iter().map(|(index, again, reason)| {
            let stream = again.and_then(|(torques, within)| {
                let mut freedom = planning.settings.freedom.clone();
                let loads = freedom.loads.as_mut()?;
                loads.torque.iter_mut().zip(torques).for_each(|(torque, share)| *torque *= share);
                let task = planning.task(&candidates[*index], &freedom)?;
                retime(&task, Goal::Within(within)).ok()
            });
            (*index, State::from(stream.ok_or_else(|| reason.clone())))
        });
        states.collect()
    }
}

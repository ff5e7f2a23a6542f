//! How much time each run gets.

use rayon::prelude::*;

use super::work::{Budget, Objective, RetrofitError, Settings, Way, rounded_up};
use crate::energy::power::holding_w;
use crate::motion::Simulation;
use crate::motion::timeline::{Event, WaitBasis, What};
use crate::optimize::cycle::{Part, TradeOff, cycle_time, share};
use crate::optimize::energy_curve::{thriftiest, trade_off};
use crate::optimize::retime::{Goal, Task, fastest};
use crate::optimize::site::Site;
use crate::robot::Model;

/// A run is not asked for less than this share of its time where the cycle may stay as it is.
const QUICKEST: f64 = 0.87;
/// Nor for more than this share.
const LAZIEST: f64 = 1.3;
/// Nor for more than this share where it may use up a wait.
const AWAITED: f64 = 3.0;
/// Rounding of a sum of times, s.
const TIME_TOLERANCE: f64 = 1e-6;

/// The times of a cycle's runs.
pub(super) struct Plan {
    /// One for each task.
    pub(super) goals: Vec<Goal>,
    /// The cycle, if its time is shared.
    shared: Option<(Vec<Part>, f64)>,
}

/// The goal of each task: its share of the time.
pub(super) fn goals(
    model: &Model,
    settings: &Settings,
    simulation: &Simulation,
    sites: &[Site],
    ways: &[Way],
    tasks: &[(usize, Task<'_>)],
) -> Result<Plan, RetrofitError> {
    let before = |task: &Task<'_>| task.run.duration();
    let each = |goal: &dyn Fn(&Task<'_>) -> Goal| Plan {
        goals: tasks.iter().map(|(_, task)| goal(task)).collect(),
        shared: None,
    };
    if settings.objective == Objective::Time {
        return Ok(each(&|_| Goal::Fastest));
    }
    let (takt, bounds): (f64, Vec<(f64, f64)>) = match settings.budget {
        Budget::Factor(x) => return Ok(each(&|task| Goal::Exactly(x * before(task)))),
        Budget::AsBefore => {
            let is_awaited = |event: &Event| match &event.what {
                What::Wait(record) => record.basis == WaitBasis::Input && event.duration > 0.0,
                _ => false,
            };
            let awaited = simulation.events.iter().any(is_awaited);
            let laziest = if awaited { AWAITED } else { LAZIEST };
            let bounds =
                |(_, task): &(usize, Task<'_>)| (QUICKEST * before(task), laziest * before(task));
            (simulation.cycle_s, tasks.iter().map(bounds).collect())
        }
        Budget::Takt(takt) => (takt, possible(simulation, sites, ways, tasks, takt)?),
    };
    let parts = parts(model, settings, simulation, sites, ways, tasks);
    let curves: Vec<TradeOff> = tasks
        .par_iter()
        .zip(&bounds)
        .map(|((_, task), (shortest, longest))| {
            // Where nothing is known of its energy, a run keeps its time.
            trade_off(task, *shortest, *longest)
                .or_else(|| TradeOff::new(vec![(before(task).clamp(*shortest, *longest), 0.0)]))
        })
        .collect::<Option<_>>()
        .unwrap_or_default();
    match share(&curves, &parts, takt) {
        Some(times) => Ok(Plan {
            goals: times.into_iter().map(Goal::Exactly).collect(),
            shared: Some((parts, takt)),
        }),
        None => Ok(each(&|task| Goal::Within(before(task)))),
    }
}

impl Plan {
    /// Whether the cycle takes no longer than it may where the tasks take `times` (s).
    pub(super) fn holds(&self, times: &[f64]) -> bool {
        let shared = self.shared.as_ref();
        shared.is_none_or(|(parts, takt)| cycle_time(parts, times) <= takt + TIME_TOLERANCE)
    }
}

/// The shortest and longest useful time of each task, s.
fn possible(
    simulation: &Simulation,
    sites: &[Site],
    ways: &[Way],
    tasks: &[(usize, Task<'_>)],
    takt: f64,
) -> Result<Vec<(f64, f64)>, RetrofitError> {
    let before = |task: &Task<'_>| task.run.duration();
    let executions = |i: usize| sites[ways[i].site].variants[ways[i].variant].events.len() as f64;
    let least: Vec<f64> =
        tasks.par_iter().map(|(_, task)| fastest(task).unwrap_or(before(task))).collect();
    let movable: f64 = tasks.iter().map(|(i, task)| executions(*i) * before(task)).sum();
    let shortest: f64 = tasks.iter().zip(&least).map(|((i, _), t)| executions(*i) * t).sum();
    let fixed = simulation.cycle_s - movable;
    if takt < fixed + shortest {
        let least = rounded_up(fixed + shortest);
        return Err(RetrofitError::Takt { takt, least, fixed });
    }
    let bounds = |((_, task), least): (&(usize, Task<'_>), &f64)| {
        (*least, thriftiest(task).unwrap_or(before(task)).max(*least))
    };
    Ok(tasks.par_iter().zip(&least).map(bounds).collect())
}

/// The cycle as the tasks see it.
pub(super) fn parts(
    model: &Model,
    settings: &Settings,
    simulation: &Simulation,
    sites: &[Site],
    ways: &[Way],
    tasks: &[(usize, Task<'_>)],
) -> Vec<Part> {
    let mut parts: Vec<Part> =
        simulation.events.iter().map(|event| Part::Fixed(event.duration)).collect();
    for (task, (way, _)) in tasks.iter().enumerate() {
        for event in &sites[ways[*way].site].variants[ways[*way].variant].events {
            parts[*event] = Part::Run(task);
        }
    }
    for (index, event) in simulation.events.iter().enumerate() {
        let What::Wait(record) = &event.what else { continue };
        let Some(signal) = record.wait.signal.as_ref().map(|name| name.to_lowercase()) else {
            continue;
        };
        let delay = settings.options.inputs.get(&signal).copied();
        if let (WaitBasis::Input, Some(delay)) = (record.basis, delay) {
            let is_same = |event: &Event| match &event.what {
                What::Wait(other) => {
                    other.wait.signal.as_ref().is_some_and(|name| name.to_lowercase() == signal)
                }
                _ => false,
            };
            parts[index] = Part::Arrival {
                since: simulation.events[..index].iter().rposition(is_same),
                delay,
                holding_w: holding_w(model, &record.load, &record.q).iter().sum(),
            };
        }
    }
    parts
}

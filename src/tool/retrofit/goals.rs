//! How much time each run gets.

use rayon::prelude::*;

use super::lower_limits::{Lowered, lateness};
use super::notes::end;
use super::settings::{Budget, Objective, Settings};
use super::work::{RetrofitError, Way, rounded_up, run_of};
use crate::arm::dynamics::Load;
use crate::arm::robot::Model;
use crate::retime::energy::power::holding_w;
use crate::retime::energy::{Account, EnergyParts};
use crate::retime::motion::Simulation;
use crate::retime::motion::timeline::{Event, WaitBasis, What};
use crate::retime::optimize::cycle::{Cycle, Part, TradeOff};
use crate::retime::optimize::energy_curve::Curve;
use crate::retime::optimize::freedom::Freedom;
use crate::retime::optimize::retime::{Goal, SLOWEST, Task, fastest};
use crate::retime::optimize::site::Site;
use crate::retime::path::joint_path::Joints;

/// Times at which the curves are looked at besides the first ones.
const LOOKS: usize = 4;
/// Goals that differ by less are the same, s.
const QUANTUM: f64 = 1e-4;
/// Rounding of a sum of times, s.
const TIME_TOLERANCE: f64 = 1e-6;

/// What streams are planned for.
pub(super) struct Planning<'a> {
    /// The robot whose energy is minimised.
    pub(super) model: &'a Model,
    pub(super) settings: &'a Settings,
    /// The original, and what it takes with that robot.
    pub(super) simulation: &'a Simulation,
    pub(super) before: &'a Account,
    pub(super) sites: &'a [Site],
}

impl<'a> Planning<'a> {
    /// The task of timing a way anew.
    pub(super) fn task<'f>(&self, way: &Way, freedom: &'f Freedom) -> Option<Task<'f>>
    where
        'a: 'f,
    {
        let event = *self.sites[way.site].variants[way.variant].events.first()?;
        let parts = self.before.events[event].iter();
        Some(Task {
            model: self.model,
            run: run_of(self.simulation, self.sites, way)?,
            energy_before: parts.fold(EnergyParts::default(), |a, b| a + *b),
            spacing_s: self.settings.spacing_s,
            closest_s: self.settings.closest_s,
            freedom,
            cost: self.settings.cost,
        })
    }
}

/// The times of a cycle's runs.
pub(super) struct Plan {
    /// One for each task.
    pub(super) goals: Vec<Goal>,
    /// The cycle, if its time is shared.
    shared: Option<Shared>,
}

/// A cycle whose time is shared among its runs.
struct Shared {
    curves: Vec<TradeOff>,
    cycle: Cycle,
}

/// The goal of each task: its share of the time.
pub(super) fn goals(
    model: &Model,
    settings: &Settings,
    (simulation, lowered): (&Simulation, &[Lowered]),
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
            if !simulation.events.iter().any(is_awaited) {
                return Ok(each(&|task| Goal::Within(before(task))));
            }
            // No run gets quicker so that another one may be slower: where the cell has changed,
            // the quick stream may not run, and the slow one still does. Only waits give time.
            let bounds = |(_, task): &(usize, Task<'_>)| (before(task), SLOWEST * before(task));
            (simulation.cycle_s, tasks.iter().map(bounds).collect())
        }
        Budget::Takt(takt) => (takt, possible(simulation, sites, ways, tasks, takt)?),
    };
    let original = (simulation, lowered);
    let mut cycle = cycle(model, settings, original, sites, ways, tasks, takt);
    let mut curves: Vec<Option<Curve<'_>>> = tasks
        .par_iter()
        .zip(&bounds)
        .map(|((_, task), (shortest, longest))| Curve::new(task, *shortest, *longest))
        .collect();
    let mut looks = 0;
    loop {
        let known = tasks.iter().zip(&bounds).zip(&curves);
        let known: Option<Vec<TradeOff>> = known
            .map(|(((_, task), (shortest, longest)), curve)| {
                // Where nothing is known of its energy, a run keeps its time.
                let kept = || vec![(before(task).max(*shortest).min(*longest), 0.0)];
                curve.as_ref().and_then(Curve::trade_off).or_else(|| TradeOff::new(kept()))
            })
            .collect();
        let shared = Shared { curves: known.unwrap_or_default(), cycle };
        let Some(times) = shared.times() else {
            return Ok(each(&|task| Goal::Within(before(task))));
        };
        looks += 1;
        let learnt = curves
            .par_iter_mut()
            .zip(&times)
            .map(|(curve, time)| curve.as_mut().is_some_and(|curve| curve.learn(*time)));
        if looks > LOOKS || learnt.filter(|learnt| *learnt).count() == 0 {
            let goals = times.into_iter().map(Goal::Exactly).collect();
            return Ok(Plan { goals, shared: Some(shared) });
        }
        cycle = shared.cycle;
    }
}

impl Shared {
    fn times(&self) -> Option<Vec<f64>> {
        self.cycle.share(&self.curves)
    }
}

impl Plan {
    /// Whether the cycle takes no longer than it may where the tasks take `times` (s).
    pub(super) fn holds(&self, times: &[f64]) -> bool {
        let shared = self.shared.as_ref();
        shared.is_none_or(|s| s.cycle.time(times) <= s.cycle.takt + TIME_TOLERANCE)
    }

    /// Energy of motions and known waits of the cycle where the tasks take these times (s) and
    /// energies (J); infinite where the cycle takes longer than it may.
    pub(super) fn cost(&self, taken: &[(f64, f64)]) -> f64 {
        let (times, energies): (Vec<f64>, Vec<f64>) = taken.iter().copied().unzip();
        match &self.shared {
            Some(_) if !self.holds(&times) => f64::INFINITY,
            Some(shared) => shared.cycle.energy(&times, &energies),
            None => energies.iter().sum(),
        }
    }

    /// Shares the time anew where the tasks take `times` (s), and those that take longer than they
    /// should cannot be quicker. The tasks with new goals; none where that helps no more.
    pub(super) fn share_anew(&mut self, times: &[f64]) -> Vec<usize> {
        let Some(shared) = self.shared.as_mut() else { return Vec::new() };
        let mut is_late = vec![false; times.len()];
        for (task, time) in times.iter().enumerate() {
            if matches!(self.goals[task], Goal::Exactly(goal) if *time > goal + TIME_TOLERANCE)
                && let Some(curve) = TradeOff::new(vec![(*time, 0.0)])
            {
                shared.curves[task] = curve;
                is_late[task] = true;
            }
        }
        let Some(new) = shared.times() else { return Vec::new() };
        let goals = self.goals.iter_mut().zip(new).zip(is_late).enumerate();
        goals
            .filter_map(|(task, ((goal, time), is_late))| {
                let kept = matches!(*goal, Goal::Exactly(old) if (old - time).abs() < QUANTUM);
                *goal = Goal::Exactly(time);
                (!kept && !is_late).then_some(task)
            })
            .collect()
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
    let least: Vec<f64> = tasks
        .par_iter()
        .map(|(_, task)| fastest(task).unwrap_or(f64::MAX).min(before(task)))
        .collect();
    let movable: f64 = tasks.iter().map(|(i, task)| executions(*i) * before(task)).sum();
    let shortest: f64 = tasks.iter().zip(&least).map(|((i, _), t)| executions(*i) * t).sum();
    let fixed = simulation.cycle_s - movable;
    if takt < fixed + shortest {
        let least = rounded_up(fixed + shortest);
        return Err(RetrofitError::Takt { takt, least, fixed: fixed.max(0.0) });
    }
    // As above, where the takt leaves the choice.
    let bounds = |((_, task), least): (&(usize, Task<'_>), &f64)| {
        let shortest = if takt < simulation.cycle_s { *least } else { before(task) };
        (shortest, (SLOWEST * before(task)).max(*least))
    };
    Ok(tasks.iter().zip(&least).map(bounds).collect())
}

/// The cycle as the tasks see it. What is left of the takt (s) is spent at its end. Known waits keep
/// what the original would be late there if its limits were lower than assumed.
pub(super) fn cycle(
    model: &Model,
    settings: &Settings,
    (simulation, lowered): (&Simulation, &[Lowered]),
    sites: &[Site],
    ways: &[Way],
    tasks: &[(usize, Task<'_>)],
    takt: f64,
) -> Cycle {
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
            let since = simulation.events[..index].iter().rposition(is_same);
            parts[index] = Part::Arrival {
                since,
                delay,
                least: lateness(simulation, lowered, since, index).min(event.duration),
                holding_w: holding_w(model, &record.load, &record.q).iter().sum(),
            };
        }
    }
    let holding = |(load, q): (&Load, &Joints)| holding_w(model, load, q).iter().sum();
    Cycle { parts, takt, resting_w: end(simulation).map_or(0.0, holding) }
}

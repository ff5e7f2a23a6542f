//! The time goal of each run.

use rayon::prelude::*;

use super::candidate::Candidate;
use super::cycle_time::{awaits_stated_input, cycle};
use super::error::RetrofitError;
use super::job::Original;
use super::planning::Planning;
use super::settings::{Budget, Objective};
use super::simulated::TIME_TOLERANCE;
use crate::retime::optimize::convex_curve::EnergyCurve;
use crate::retime::optimize::cycle::Cycle;
use crate::retime::optimize::energy_curve::Curve;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::retime::{Goal, Retiming, SLOWEST, Task, fastest};

/// Maximum number of refinements of the energy-time curves.
const MAX_REFINEMENTS: usize = 4;
/// Smaller differences between goals are ignored, s.
const QUANTUM: f64 = 1e-4;

/// The time goals of the runs of a cycle.
pub(super) struct Plan {
    /// One for each task.
    pub(super) goals: Vec<Goal>,
    /// The cycle, if its time is distributed among the runs.
    shared: Option<SharedCycle>,
}

/// A cycle whose time is distributed among its runs.
struct SharedCycle {
    curves: Vec<EnergyCurve>,
    cycle: Cycle,
}

/// The time goal of each task.
pub(super) fn goals(
    planning: &Planning<'_>,
    candidates: &[Candidate],
    tasks: &[(usize, Task<'_>)],
) -> Result<Plan, RetrofitError> {
    let (original, settings) = (&planning.job.original, &planning.settings);
    let simulation = &original.cycle.simulation;
    let before = |task: &Task<'_>| task.run.duration();
    let each = |goal: &dyn Fn(&Task<'_>) -> Goal| Plan {
        goals: tasks.iter().map(|(_, task)| goal(task)).collect(),
        shared: None,
    };
    if settings.objective == Objective::Time {
        return Ok(each(&|_| Goal::Fastest));
    }
    let events = |(i, _): &(usize, Task<'_>)| original.events(&candidates[*i]);
    let events: Vec<&[usize]> = tasks.iter().map(events).collect();
    let (takt, bounds): (f64, Vec<(f64, f64)>) = match settings.budget {
        Budget::Factor(x) => return Ok(each(&|task| Goal::Exactly(x * before(task)))),
        Budget::AsBefore => {
            if !awaits_stated_input(simulation) {
                return Ok(each(&|task| Goal::Within(before(task))));
            }
            // No run becomes faster to give time to others: if the guard of a fast stream fails,
            // its original movements run and the cycle gets longer. Only waits give time.
            let bounds = |(_, task): &(usize, Task<'_>)| (before(task), SLOWEST * before(task));
            (simulation.cycle_s, tasks.iter().map(bounds).collect())
        }
        Budget::Takt(takt) => (takt, time_bounds(original, tasks, &events, takt)?),
    };
    let cycle = cycle(original, planning.model, settings, &events, takt);
    Ok(shared_time(cycle, tasks, &bounds)
        .unwrap_or_else(|| each(&|task| Goal::Within(before(task)))))
}

/// Distributes the time of a cycle, with curves refined at the chosen times; `None` if no
/// distribution exists. `bounds`: the shortest and longest time of each task, s.
fn shared_time(
    mut cycle: Cycle,
    tasks: &[(usize, Task<'_>)],
    bounds: &[(f64, f64)],
) -> Option<Plan> {
    let mut curves: Vec<Option<Curve<'_>>> = tasks
        .par_iter()
        .zip(bounds)
        .map(|((_, task), (shortest, longest))| Curve::new(task, *shortest, *longest))
        .collect();
    let mut refinements = 0;
    loop {
        let known = tasks.iter().zip(bounds).zip(&curves);
        let known: Option<Vec<EnergyCurve>> = known
            .map(|(((_, task), (shortest, longest)), curve)| {
                // A run without an energy curve keeps its time.
                let kept = || vec![(task.run.duration().max(*shortest).min(*longest), 0.0)];
                curve.as_ref().and_then(Curve::energy_curve).or_else(|| EnergyCurve::new(kept()))
            })
            .collect();
        let shared = SharedCycle { curves: known.unwrap_or_default(), cycle };
        let times = shared.cycle.share(&shared.curves)?;
        refinements += 1;
        let learnt = curves
            .par_iter_mut()
            .zip(&times)
            .map(|(curve, time)| curve.as_mut().is_some_and(|curve| curve.add_point(*time)));
        if refinements > MAX_REFINEMENTS || learnt.filter(|learnt| *learnt).count() == 0 {
            let goals = times.into_iter().map(Goal::Exactly).collect();
            return Some(Plan { goals, shared: Some(shared) });
        }
        cycle = shared.cycle;
    }
}

impl Plan {
    /// Whether the cycle keeps its time limit if the tasks take `times` (s).
    pub(super) fn holds(&self, times: &[f64]) -> bool {
        let shared = self.shared.as_ref();
        shared.is_none_or(|s| s.cycle.time(times) <= s.cycle.takt + TIME_TOLERANCE)
    }

    /// Energy of motions and known waits in the cycle if the tasks take these times (s) and
    /// energies (J); infinite if the cycle exceeds its time limit.
    pub(super) fn cost(&self, taken: &[(f64, f64)]) -> f64 {
        let (times, energies): (Vec<f64>, Vec<f64>) = taken.iter().copied().unzip();
        match &self.shared {
            Some(_) if !self.holds(&times) => f64::INFINITY,
            Some(shared) => shared.cycle.energy(&times, &energies),
            None => energies.iter().sum(),
        }
    }

    /// Distributes the time again after the tasks took `times` (s); tasks slower than their goal
    /// are fixed at that time. Returns the other tasks whose goals changed.
    pub(super) fn redistribute(&mut self, times: &[f64]) -> Vec<usize> {
        let Some(shared) = self.shared.as_mut() else { return Vec::new() };
        let mut is_late = vec![false; times.len()];
        for (task, time) in times.iter().enumerate() {
            if matches!(self.goals[task], Goal::Exactly(goal) if *time > goal + TIME_TOLERANCE)
                && let Some(curve) = EnergyCurve::new(vec![(*time, 0.0)])
            {
                shared.curves[task] = curve;
                is_late[task] = true;
            }
        }
        let Some(new) = shared.cycle.share(&shared.curves) else { return Vec::new() };
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

/// The shortest and longest useful time of each task, s. `events`: the events of each task.
fn time_bounds(
    original: &Original<'_>,
    tasks: &[(usize, Task<'_>)],
    events: &[&[usize]],
    takt: f64,
) -> Result<Vec<(f64, f64)>, RetrofitError> {
    let cycle_s = original.cycle.simulation.cycle_s;
    let before = |task: &Task<'_>| task.run.duration();
    // A takt of at least the original cycle makes no run faster, as in `goals`.
    if takt >= cycle_s {
        return Ok(tasks.iter().map(|(_, task)| (before(task), SLOWEST * before(task))).collect());
    }
    let least: Vec<f64> = tasks
        .par_iter()
        .map(|(_, task)| fastest(task).unwrap_or(f64::MAX).min(before(task)))
        .collect();
    let executions = || events.iter().map(|events| events.len() as f64);
    let movable: f64 = tasks.iter().zip(executions()).map(|((_, task), n)| n * before(task)).sum();
    let shortest: f64 = least.iter().zip(executions()).map(|(t, n)| n * t).sum();
    let fixed = cycle_s - movable;
    if takt < fixed + shortest {
        let least = rounded_up(fixed + shortest);
        return Err(RetrofitError::Takt { takt, least, fixed: fixed.max(0.0) });
    }
    let bounds = |((_, task), least): (&(usize, Task<'_>), &f64)| {
        (*least, (SLOWEST * before(task)).max(*least))
    };
    Ok(tasks.iter().zip(&least).map(bounds).collect())
}

/// Refuses a factor that no run can reach; if some run can, the others keep their reasons.
pub(super) fn check_factor(
    factor: f64,
    tasks: &[(usize, Task<'_>)],
    outcomes: &[Result<Retiming, Reason>],
) -> Result<(), RetrofitError> {
    let share =
        |((_, task), outcome): (&(usize, Task<'_>), &Result<Retiming, Reason>)| match outcome {
            Err(Reason::TooShort(least)) => Some(least / task.run.duration()),
            _ => None,
        };
    let shares: Option<Vec<f64>> = tasks.iter().zip(outcomes).map(share).collect();
    match shares.and_then(|list| list.into_iter().reduce(f64::min)) {
        Some(least) => Err(RetrofitError::Factor { factor, least: rounded_up(least) }),
        None => Ok(()),
    }
}

/// Rounded up to three decimals, so that the value in the message is feasible.
fn rounded_up(x: f64) -> f64 {
    (x * 1e3).ceil() / 1e3
}

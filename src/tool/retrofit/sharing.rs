//! Streams for the time goals, and corrections if goals are missed.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::goals::Plan;
use super::settings::Budget;
use crate::retime::optimize::reason::Reason;
use crate::retime::optimize::retime::{Goal, Retiming, Task, retime};

/// Maximum number of new distributions of the cycle time.
const MAX_REDISTRIBUTIONS: usize = 4;

/// A stream for each task of a plan, or the reason for none. `progress` receives the number of
/// finished tasks and the total.
pub(super) fn streams(
    plan: &Plan,
    tasks: &[(usize, Task<'_>)],
    budget: Budget,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Vec<Outcome> {
    let done = AtomicUsize::new(0);
    let outcomes = tasks.par_iter().zip(&plan.goals).map(|((_, task), goal)| {
        let outcome = match budget {
            Budget::AsBefore => retimed_or_as_before(task, *goal),
            Budget::Takt(_) | Budget::Factor(_) => retime(task, *goal),
        };
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, tasks.len());
        outcome
    });
    outcomes.collect()
}

type Outcome = Result<Retiming, Reason>;

/// A stream for the goal, or else in the original time of the run.
fn retimed_or_as_before(task: &Task<'_>, goal: Goal) -> Outcome {
    let outcome = retime(task, goal);
    if goal == within_before(task) { outcome } else { outcome.or_else(|_| as_before(task)) }
}

/// A stream in the original time of the run.
fn as_before(task: &Task<'_>) -> Outcome {
    retime(task, within_before(task))
}

fn within_before(task: &Task<'_>) -> Goal {
    Goal::Within(task.run.duration())
}

/// Time \[s\] and motion energy \[J\] of the original run.
fn original_time_and_energy(task: &Task<'_>) -> (f64, f64) {
    (task.run.duration(), task.energy_before.motion_energy_j())
}

/// Time \[s\] and motion energy \[J\] of each run after its outcome.
fn times_and_energies(tasks: &[(usize, Task<'_>)], outcomes: &[Outcome]) -> Vec<(f64, f64)> {
    let pairs = tasks.iter().zip(outcomes);
    pairs.map(|((_, task), outcome)| time_and_energy(task, outcome)).collect()
}

fn time_and_energy(task: &Task<'_>, outcome: &Outcome) -> (f64, f64) {
    match outcome {
        Ok(retiming) => (retiming.duration_s, retiming.energy.motion_energy_j()),
        Err(_) => original_time_and_energy(task),
    }
}

/// The existing streams, planned again in the original time of their runs.
fn all_as_before(tasks: &[(usize, Task<'_>)], outcomes: Vec<Outcome>) -> Vec<Outcome> {
    let pairs = tasks.par_iter().zip(outcomes);
    pairs.map(|((_, task), outcome)| outcome.and_then(|_| as_before(task))).collect()
}

/// If a run misses its goal, the others have too much time: the time is distributed again. If that
/// fails, every run returns to its original time.
pub(super) fn enforce_cycle_time(
    mut plan: Plan,
    tasks: &[(usize, Task<'_>)],
    mut outcomes: Vec<Outcome>,
) -> (Plan, Vec<Outcome>) {
    let times = |outcomes: &[Outcome]| -> Vec<f64> {
        times_and_energies(tasks, outcomes).into_iter().map(|(time, _)| time).collect()
    };
    for _ in 0..MAX_REDISTRIBUTIONS {
        let times = times(&outcomes);
        if plan.holds(&times) {
            break;
        }
        let changed = plan.redistribute(&times);
        if changed.is_empty() {
            break;
        }
        let found: Vec<Outcome> = changed
            .par_iter()
            .map(|i| retimed_or_as_before(&tasks[*i].1, plan.goals[*i]))
            .collect();
        for (i, outcome) in changed.into_iter().zip(found) {
            outcomes[i] = outcome;
        }
    }
    if !plan.holds(&times(&outcomes)) {
        outcomes = all_as_before(tasks, outcomes);
    }
    (plan, outcomes)
}

/// A run may take more energy than before if its time saves more in other runs or in waits. If the
/// cycle costs less without it, it returns to its original time; if the whole saves nothing, all
/// runs do.
pub(super) fn undo_costly_streams(
    plan: &Plan,
    tasks: &[(usize, Task<'_>)],
    mut outcomes: Vec<Outcome>,
) -> Vec<Outcome> {
    let mut now = times_and_energies(tasks, &outcomes);
    let before: Vec<(f64, f64)> =
        tasks.iter().map(|(_, task)| original_time_and_energy(task)).collect();
    let excess = |i: usize| now[i].1 - before[i].1;
    let mut costly: Vec<usize> = (0..tasks.len()).filter(|i| excess(*i) > 0.0).collect();
    costly.sort_by(|a, b| excess(*b).total_cmp(&excess(*a)));
    for i in costly {
        let task = &tasks[i].1;
        let cost = plan.cost(&now);
        let slower = std::mem::replace(&mut now[i], before[i]);
        if plan.cost(&now) < cost {
            outcomes[i] = as_before(task);
            now[i] = time_and_energy(task, &outcomes[i]);
        } else {
            now[i] = slower;
        }
    }
    if plan.cost(&now) >= plan.cost(&before) {
        outcomes = all_as_before(tasks, outcomes);
    }
    outcomes
}

/// The outcomes without streams that are no faster than their run.
pub(super) fn faster(tasks: &[(usize, Task<'_>)], outcomes: Vec<Outcome>) -> Vec<Outcome> {
    let is_faster = |task: &Task<'_>, outcome: Outcome| match outcome {
        Ok(found) if found.duration_s >= task.run.duration() => {
            Err(Reason::TooShort(found.duration_s))
        }
        outcome => outcome,
    };
    tasks.iter().zip(outcomes).map(|((_, task), outcome)| is_faster(task, outcome)).collect()
}

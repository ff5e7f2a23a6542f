//! What runs make of their shares of the cycle's time, and what follows for the others.

use rayon::prelude::*;

use super::goals::Plan;
use super::work::Outcome;
use crate::retime::optimize::retime::{Goal, Task, retime};

/// Times that the cycle's time is shared anew, at most.
const MOST_SHARINGS: usize = 4;

/// A stream in the run's share of the cycle; where there is none, in its time before.
pub(super) fn useful(task: &Task<'_>, goal: Goal) -> Outcome {
    let before = Goal::Within(task.run.duration());
    let outcome = retime(task, goal);
    if goal == before { outcome } else { outcome.or_else(|_| retime(task, before)) }
}

/// What a run takes with its outcome: time, s, and energy of the motion, J.
fn taken(task: &Task<'_>, outcome: &Outcome) -> (f64, f64) {
    match outcome {
        Ok(retiming) => (retiming.duration_s, retiming.energy.motion_energy_j()),
        Err(_) => (task.run.duration(), task.energy_before.motion_energy_j()),
    }
}

/// Where a run did not get quicker as it should have, so that the others were given too much time,
/// the time is shared anew; where that does not help, every run goes back to its time before.
pub(super) fn keep_to_the_cycle(
    plan: &mut Plan,
    tasks: &[(usize, Task<'_>)],
    outcomes: &mut [(usize, Outcome)],
) {
    let time =
        |((_, task), (_, outcome)): (&(usize, Task<'_>), &(usize, Outcome))| taken(task, outcome).0;
    for _ in 0..MOST_SHARINGS {
        let times: Vec<f64> = tasks.iter().zip(outcomes.iter()).map(time).collect();
        if plan.holds(&times) {
            return;
        }
        let changed = plan.share_anew(&times);
        if changed.is_empty() {
            break;
        }
        let found: Vec<Outcome> =
            changed.par_iter().map(|i| useful(&tasks[*i].1, plan.goals[*i])).collect();
        for (i, outcome) in changed.into_iter().zip(found) {
            outcomes[i].1 = outcome;
        }
    }
    let times: Vec<f64> = tasks.iter().zip(outcomes.iter()).map(time).collect();
    if plan.holds(&times) {
        return;
    }
    outcomes.par_iter_mut().zip(tasks).filter(|((_, outcome), _)| outcome.is_ok()).for_each(
        |((_, outcome), (_, task))| *outcome = retime(task, Goal::Within(task.run.duration())),
    );
}

/// A run that takes more energy than before has to give its time to others that save more, or to
/// spare the arm a wait. Where the cycle is no worse without it, it goes back to its time before,
/// and so do all where nothing is saved in all.
pub(super) fn leave_what_does_not_pay(
    plan: &Plan,
    tasks: &[(usize, Task<'_>)],
    outcomes: &mut [(usize, Outcome)],
) {
    let before = |task: &Task<'_>| (task.run.duration(), task.energy_before.motion_energy_j());
    let mut now: Vec<(f64, f64)> = tasks
        .iter()
        .zip(&*outcomes)
        .map(|((_, task), (_, outcome))| taken(task, outcome))
        .collect();
    let excess = |i: usize| now[i].1 - before(&tasks[i].1).1;
    let mut costly: Vec<usize> = (0..tasks.len()).filter(|i| excess(*i) > 0.0).collect();
    costly.sort_by(|a, b| excess(*b).total_cmp(&excess(*a)));
    for i in costly {
        let task = &tasks[i].1;
        let cost = plan.cost(&now);
        let patient = std::mem::replace(&mut now[i], before(task));
        if plan.cost(&now) < cost {
            outcomes[i].1 = retime(task, Goal::Within(task.run.duration()));
            now[i] = taken(task, &outcomes[i].1);
        } else {
            now[i] = patient;
        }
    }
    let all_before: Vec<(f64, f64)> = tasks.iter().map(|(_, task)| before(task)).collect();
    if plan.cost(&now) >= plan.cost(&all_before) {
        outcomes.par_iter_mut().zip(tasks).filter(|((_, outcome), _)| outcome.is_ok()).for_each(
            |((_, outcome), (_, task))| *outcome = retime(task, Goal::Within(task.run.duration())),
        );
    }
}

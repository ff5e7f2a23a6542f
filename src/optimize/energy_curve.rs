//! The curve of least energy over time of a run, and what is read from it.

use super::cycle::{Known, TradeOff};
use super::energy_program::{energy_bound, minimize_energy, minimize_energy_from};
use super::margins::Margins;
use super::retime::{SLOWEST, Task, Work, fastest_profile};
use crate::energy::account;

/// The curve begins at the least time times this, where programs have room.
const RESERVE_OF_CURVE: f64 = 1.001;
/// And goes on to this many times that, at least.
const CURVE: f64 = 2.0;

/// A stream needs this much more time than the fastest profile, at least.
const RESERVE: f64 = 1.05;
/// Times this much longer than before are worth a look of their own.
const FAR: f64 = 1.5;

/// A point of the curve of energy over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeEnergy {
    /// Time of the run, settling included, s.
    pub time_s: f64,
    /// Energy of the run with the best timing of its path in this time, all six parts, J.
    pub energy_j: f64,
    /// No timing of the path takes less in this time, J.
    pub lower_bound_j: f64,
}

/// `count` points of the curve of energy over time of a run, from the least time of its path to
/// the longest that is asked for or a multiple of the least. Without a limit on the jerk: what a
/// stream can be compared with. Empty where the path has no timing.
pub fn pareto(task: &Task<'_>, count: usize) -> Vec<TimeEnergy> {
    let curve = || {
        let work = Work::new(task).ok()?;
        let (grid, limits) = work.bare_grid(&Margins::none()).ok()?;
        let fast = fastest_profile(&grid, &limits).ok()?;
        let (run, robot) = (task.run, task.model);
        let least = RESERVE_OF_CURVE * fast.duration();
        let longest = (CURVE * least).max(run.duration() - run.settling);
        let held = account::at_rest(robot, &run.load, &run.end, run.settling).energy_j();
        let point = |i: usize| {
            let share = if count > 1 { i as f64 / (count - 1) as f64 } else { 0.0 };
            let time = least * (longest / least).powf(share);
            let bound = energy_bound(&grid, &limits, &work.electrical, &fast, time);
            let from = bound.as_ref();
            let model = &work.electrical;
            let optimum = minimize_energy_from(&grid, &limits, model, &fast, time, from);
            let optimum = optimum.into_optimum()?;
            let idle = account::base(robot, time).energy_j() + held;
            Some(TimeEnergy {
                time_s: time + run.settling,
                energy_j: optimum.energy.total() + idle,
                lower_bound_j: optimum.lower_bound.min(optimum.energy.total()) + idle,
            })
        };
        Some((0..count).filter_map(point).collect())
    };
    curve().unwrap_or_default()
}

/// The time, s, beyond which a run takes more motion energy again since the motors hold the arm up
/// for longer; at most [`SLOWEST`] times as long as before. `None` where there is no stream. Base
/// power does not count: the rest of a takt has to be waited for anyway.
pub fn thriftiest(task: &Task<'_>) -> Option<f64> {
    let work = Work::new(task).ok()?;
    let (grid, limits) = work.grid(&Margins::first(work.tolerance())).ok()?;
    let fast = fastest_profile(&grid, &limits).ok()?;
    let longest = SLOWEST * task.run.duration();
    let model = &work.electrical;
    let optimum = minimize_energy(&grid, &limits, model, &fast, longest).into_optimum()?;
    Some(optimum.profile.duration() + task.run.settling)
}

/// What a run takes over the time that it gets, settling included: the energies are of the
/// motion alone. `shortest` and `longest` bound the time, s. `None` where there is no stream.
pub fn trade_off(task: &Task<'_>, shortest: f64, longest: f64) -> Option<TradeOff> {
    let work = Work::new(task).ok()?;
    let (grid, limits) = work.grid(&Margins::first(work.tolerance())).ok()?;
    let fast = fastest_profile(&grid, &limits).ok()?;
    let settling = task.run.settling;
    let shortest = shortest.max(RESERVE * fast.duration() + settling);
    let known = |time: f64| {
        let outcome =
            minimize_energy_from(&grid, &limits, &work.electrical, &fast, time - settling, None);
        let optimum = outcome.into_optimum()?;
        Some(Known { time, energy: optimum.energy.total(), slope: -optimum.marginal })
    };
    let before = task.run.duration().max(shortest);
    let far = if longest > FAR * before { Some(known(longest)?) } else { None };
    TradeOff::about(known(before)?, shortest, longest.max(before), far)
}

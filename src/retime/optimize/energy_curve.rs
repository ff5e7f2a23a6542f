//! The curve of least energy over time of a run.

use super::cycle::{Known, TradeOff};
use super::energy_program::{EnergyBound, energy_bound, minimize_energy};
use super::margins::Margins;
use super::path_energy::evaluate;
use super::run_problem::{RunProblem, Task, fastest_profile};
use crate::retime::energy::account;
use crate::retime::motion::timing::grid::PathGrid;
use crate::retime::motion::timing::limits::PathLimits;
use crate::retime::motion::timing::profile::Profile;

/// The curve begins at the least time times this, where programs have room.
const RESERVE_OF_CURVE: f64 = 1.001;
/// And ends at this multiple of that, at least.
const CURVE: f64 = 2.0;

/// A stream needs this much more time than the fastest profile, at least.
const RESERVE: f64 = 1.05;
/// Intervals of the grid of a curve besides those of zones: its slopes need no more.
const COARSE: usize = 20;
/// Share of a time within which a curve is known well enough.
const NEAR: f64 = 0.03;
/// Share by which a profile is lengthened for a finite difference of its energy.
const LONGER: f64 = 1e-3;

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
        let problem = RunProblem::new(task).ok()?;
        let (grid, limits) = problem.bare_grid(&Margins::none()).ok()?;
        let fast = fastest_profile(&grid, &limits).ok()?;
        let (run, robot) = (task.run, task.model);
        let least = RESERVE_OF_CURVE * fast.duration();
        let longest = (CURVE * least).max(run.duration() - run.settling);
        let held = account::at_rest(robot, &run.load, &run.end, run.settling).energy_j();
        let point = |i: usize| {
            let share = if count > 1 { i as f64 / (count - 1) as f64 } else { 0.0 };
            let time = least * (longest / least).powf(share);
            let bound = energy_bound(&grid, &limits, &problem.electrical, &fast, time);
            let from = bound.as_ref();
            let model = &problem.electrical;
            let optimum = minimize_energy(&grid, &limits, model, &fast, time, from);
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

/// Least energy of the motion of a run over its time (settling included), computed at the times that
/// are asked for.
pub struct Curve<'a> {
    problem: RunProblem<'a>,
    grid: PathGrid,
    limits: PathLimits,
    fast: Profile,
    /// Of rising time, with ṡ² at the nodes.
    known: Vec<(Known, Vec<f64>)>,
    range: (f64, f64),
}

impl<'a> Curve<'a> {
    /// The curve of a run from `shortest` (s, 0 where that is not known) to `longest`, known at
    /// the time that the run takes now. `None` where there is no stream.
    pub fn new(task: &'a Task<'a>, shortest: f64, longest: f64) -> Option<Curve<'a>> {
        let problem = RunProblem::new(task).ok()?;
        let (grid, limits) = problem.grid_of(&Margins::first(problem.tolerance()), COARSE).ok()?;
        let fast = fastest_profile(&grid, &limits).ok()?;
        // The shortest possible time may be below that of the coarse grid.
        let reserve = RESERVE * fast.duration() + task.run.settling;
        let shortest = if shortest > 0.0 { shortest } else { reserve };
        let range = (shortest, longest.max(shortest));
        let mut curve = Curve { problem, grid, limits, fast, known: Vec::new(), range };
        curve.learn(task.run.duration()).then_some(curve)
    }

    /// Computes the energy of the run in a time, s, unless it is known near that time. Returns
    /// whether a point was added.
    pub fn learn(&mut self, time: f64) -> bool {
        let least = RESERVE * self.fast.duration() + self.problem.task.run.settling;
        let time = time.clamp(self.range.0, self.range.1).max(least);
        let place = self.known.partition_point(|(known, _)| known.time < time);
        let near = |(known, _): &(Known, Vec<f64>)| (known.time - time).abs() <= NEAR * time;
        let neighbours = self.known[place.saturating_sub(1)..].iter().take(2);
        if neighbours.into_iter().any(near) {
            return false;
        }
        let found = self.at(time);
        let is_new = !found.is_empty();
        self.known.extend(found);
        self.known.sort_by(|a, b| a.0.time.total_cmp(&b.0.time));
        is_new
    }

    /// The point of the curve at a time, s; for a time beyond that of least energy, both points.
    fn at(&self, time: f64) -> Vec<(Known, Vec<f64>)> {
        let settling = self.problem.task.run.settling;
        let moving = time - settling;
        let (grid, model) = (&self.grid, &self.problem.electrical);
        // The speeds at another time are a good guess of those at this one.
        let far = |(known, _): &&(Known, Vec<f64>)| (known.time / time).ln().abs();
        let nearest = self.known.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
        let guess = nearest.map(|(known, b)| {
            let slower = ((known.time - settling) / moving).powi(2);
            let b = b.iter().map(|b| b * slower).collect();
            EnergyBound { lower_bound: f64::NEG_INFINITY, b }
        });
        let (limits, guess) = (&self.limits, guess.as_ref());
        let outcome = minimize_energy(grid, limits, model, &self.fast, moving, guess);
        let Some(optimum) = outcome.into_optimum() else { return Vec::new() };
        let b = optimum.profile.b().to_vec();
        let least = optimum.energy.total();
        if optimum.marginal > 0.0 {
            return vec![(Known { time, energy: least, slope: -optimum.marginal }, b)];
        }
        // The motors hold the arm up for longer: more time costs energy then.
        let energy = |duration: f64| {
            let slow = optimum.profile.scaled_to(duration)?;
            Some(evaluate(grid, &slow, model).total())
        };
        let thriftiest = optimum.profile.duration() + settling;
        let mut found = Vec::new();
        if thriftiest < time * (1.0 - NEAR) {
            found.push((Known { time: thriftiest, energy: least, slope: 0.0 }, b.clone()));
        }
        if let (Some(here), Some(later)) = (energy(moving), energy(moving * (1.0 + LONGER))) {
            let slope = (later - here) / (moving * LONGER);
            found.push((Known { time, energy: here, slope }, b));
        }
        found
    }

    /// The curve through the points so far.
    pub fn trade_off(&self) -> Option<TradeOff> {
        let known: Vec<Known> = self.known.iter().map(|(known, _)| *known).collect();
        TradeOff::through(&known, self.range)
    }
}

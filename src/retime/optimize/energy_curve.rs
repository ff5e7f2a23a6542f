//! Least energy of a run as a function of its time.

use super::convex_curve::{EnergyCurve, Known};
use super::energy_program::{EnergyBound, EnergyOptimum, energy_bound, minimize_energy};
use super::margins::{Margins, SPACINGS};
use super::path_energy::evaluate;
use super::run_problem::{INTERVALS, RunProblem, Task, fastest_profile};
use crate::retime::energy::account;
use crate::retime::motion::timing::grid::PathGrid;
use crate::retime::motion::timing::limits::PathLimits;
use crate::retime::motion::timing::profile::Profile;

/// First time of the curve relative to the least time, so that the programs have an interior.
const RESERVE_OF_CURVE: f64 = 1.001;
/// Smallest ratio of the last time of the curve to the first.
const CURVE: f64 = 2.0;

/// Smallest ratio of the time of a stream to that of the fastest profile.
const RESERVE: f64 = 1.05;
/// Grid intervals for a curve, in addition to those of zones; enough for its slopes.
const COARSE: usize = 20;
/// Relative distance of times within which no further point is computed.
const NEAR: f64 = 0.03;
/// Relative distance of times that count as one.
const ROUNDING: f64 = 1e-6;
/// Relative time step of the finite difference of the energy.
const LONGER: f64 = 1e-3;

/// A point of the curve of energy over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeEnergy {
    /// Duration of the run with settling, s.
    pub time_s: f64,
    /// Least energy of the run on its path in this time, sum of all six parts, J.
    pub energy_j: f64,
    /// Lower bound of the energy on the path in this time, J.
    pub lower_bound_j: f64,
}

/// `count` points of the curve of energy over time, from the least time of the path to that of
/// the run or to a multiple of the least. The jerk is not limited. Empty if the path has no timing.
pub fn pareto(task: &Task<'_>, count: usize) -> Vec<TimeEnergy> {
    let Some(path) = FullPath::new(task) else { return Vec::new() };
    let (run, robot) = (task.run, task.model);
    let longest = (CURVE * path.least).max(run.duration() - run.settling);
    let held = account::at_rest(robot, &run.load, &run.end, run.settling).energy_j();
    let point = |i: usize| {
        let share = if count > 1 { i as f64 / (count - 1) as f64 } else { 0.0 };
        let time = path.least * (longest / path.least).powf(share);
        let optimum = path.optimum(time)?;
        let idle = account::base(robot, time).energy_j() + held;
        Some(TimeEnergy {
            time_s: time + run.settling,
            energy_j: optimum.energy.total() + idle,
            lower_bound_j: optimum.lower_bound.min(optimum.energy.total()) + idle,
        })
    };
    (0..count).filter_map(point).collect()
}

/// The path of a run on a fine grid, without reserves.
struct FullPath<'a> {
    problem: RunProblem<'a>,
    grid: PathGrid,
    limits: PathLimits,
    fast: Profile,
    /// Least moving time with an interior, s.
    least: f64,
}

impl<'a> FullPath<'a> {
    fn new(task: &'a Task<'a>) -> Option<FullPath<'a>> {
        let problem = RunProblem::new(task).ok()?;
        let (grid, limits) = problem.bare_grid(&Margins::none(), INTERVALS).ok()?;
        let fast = fastest_profile(&grid, &limits).ok()?;
        let least = RESERVE_OF_CURVE * fast.duration();
        Some(FullPath { problem, grid, limits, fast, least })
    }

    /// Least energy in a moving time (s), with its bound.
    fn optimum(&self, time: f64) -> Option<EnergyOptimum> {
        let (grid, limits, model) = (&self.grid, &self.limits, &self.problem.electrical);
        let bound = energy_bound(grid, limits, model, &self.fast, time);
        minimize_energy(grid, limits, model, &self.fast, time, bound.as_ref()).into_optimum()
    }
}

/// Times of a trade-off before and after the time of the run.
const FASTER: usize = 5;
const SLOWER: usize = 10;

/// Motion energy of a run over its time with settling: curves from the least time to a multiple of
/// the time of the run.
pub struct TradeOff {
    /// Least energy; what lies on it or above can be reached.
    pub reachable: EnergyCurve,
    /// Lower bound of the energy. Between computed times it follows from convexity.
    pub bound: EnergyCurve,
}

/// The trade-off of a run on its path, up to `longest` (s). `also`: further times (s) with energies
/// (J) that can be reached. The jerk is not limited. `None` if the path has no timing.
pub fn trade_off(task: &Task<'_>, longest: f64, also: &[(f64, f64)]) -> Option<TradeOff> {
    let path = FullPath::new(task)?;
    let settling = task.run.settling;
    let now = (task.run.duration() - settling).max(path.least);
    // Close to each other where the curve is steep.
    let between = |from: f64, to: f64, count: usize| {
        (0..count).map(move |i| from * (to / from).powf((i as f64 / count as f64).powi(2)))
    };
    let last = (longest - settling).max(now);
    let times = between(path.least, now, FASTER).chain(between(now, last, SLOWER)).chain([last]);
    let (mut reachable, mut bound) = (also.to_vec(), Vec::<(f64, f64)>::new());
    for time in times {
        if bound.last().is_some_and(|(before, _)| time + settling <= before * (1.0 + ROUNDING)) {
            continue;
        }
        let Some(optimum) = path.optimum(time) else { continue };
        let least = optimum.energy.total();
        bound.push((time + settling, optimum.lower_bound.min(least)));
        reachable.push((optimum.profile.duration() + settling, least));
        // The optimum may take less time than it may.
        if let Some(slow) = optimum.profile.scaled_to(time) {
            let energy = evaluate(&path.grid, &slow, &path.problem.electrical).total();
            reachable.push((time + settling, energy));
        }
    }
    Some(TradeOff {
        reachable: EnergyCurve::new(reachable)?,
        bound: EnergyCurve::below(&bound, longest)?,
    })
}

/// Least energy of the motion of a run over its time (with settling), computed at chosen times.
pub struct Curve<'a> {
    problem: RunProblem<'a>,
    grid: PathGrid,
    limits: PathLimits,
    fast: Profile,
    /// Points of rising time, with ṡ² at the nodes.
    known: Vec<(Known, Vec<f64>)>,
    range: (f64, f64),
}

impl<'a> Curve<'a> {
    /// The curve of a run from `shortest` (s; 0 if unknown) to `longest`, with one point at the
    /// current time of the run. `None` if no stream is possible.
    pub fn new(task: &'a Task<'a>, shortest: f64, longest: f64) -> Option<Curve<'a>> {
        let problem = RunProblem::new(task).ok()?;
        let (grid, limits) =
            problem.grid(&Margins::first(problem.tolerance(), SPACINGS[0]), COARSE).ok()?;
        let fast = fastest_profile(&grid, &limits).ok()?;
        // The shortest time may be below the least time on the coarse grid.
        let reserve = RESERVE * fast.duration() + task.run.settling;
        let shortest = if shortest > 0.0 { shortest } else { reserve };
        let range = (shortest, longest.max(shortest));
        let mut curve = Curve { problem, grid, limits, fast, known: Vec::new(), range };
        curve.add_point(task.run.duration()).then_some(curve)
    }

    /// Computes the energy at a time (s) unless a point is near. Returns whether one was added.
    pub fn add_point(&mut self, time: f64) -> bool {
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

    /// The point at a time, s; beyond the time of least energy also the point of least energy.
    fn at(&self, time: f64) -> Vec<(Known, Vec<f64>)> {
        let settling = self.problem.task.run.settling;
        let moving = time - settling;
        let (grid, model) = (&self.grid, &self.problem.electrical);
        // Start from the scaled speeds of the nearest point.
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
        // Beyond the optimum more time costs holding energy.
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

    /// The curve through the computed points.
    pub fn energy_curve(&self) -> Option<EnergyCurve> {
        let known: Vec<Known> = self.known.iter().map(|(known, _)| *known).collect();
        EnergyCurve::through(&known, self.range)
    }
}

//! The speed profile of least energy on a fixed path in a given time.
//!
//! An interior point method finds the profile. Where it does not converge, cone programs with tangents of
//! the concave viscous terms lower the energy in steps (difference of convex functions), from a relaxation
//! that also gives the lower bound. A solution is accepted only after its profile has been checked and
//! evaluated.

use super::energy_cones::{Programs, Step};
use super::energy_costs::Root;
use super::path_energy::{EnergyModel, EnergyParts, evaluate};
use crate::retime::motion::stream::DOF;
use crate::retime::motion::timing::grid::{PathGrid, PathPoint};
use crate::retime::motion::timing::limits::{PathLimits, worst_ratio};
use crate::retime::motion::timing::profile::Profile;
use crate::retime::motion::timing::reachability::{speed_range, time_optimal};

/// A profile with its energy and a lower bound.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyOptimum {
    /// The profile, with all limits and the time verified.
    pub profile: Profile,
    /// Its energies.
    pub energy: EnergyParts,
    /// Lower bound of the energy of profiles on this grid in this time, J.
    pub lower_bound: f64,
    /// Energy saving per additional time, W; without base power.
    pub marginal: f64,
}

/// Outcome of the search for the profile of least energy.
#[derive(Clone, Debug, PartialEq)]
pub enum EnergyOutcome {
    /// The programs converged.
    Converged(EnergyOptimum),
    /// A solve failed or the iterations ended: the best verified profile.
    Improved(EnergyOptimum),
    /// No program gave a better verified profile than the start: the start.
    Kept(EnergyOptimum),
    /// The time is below that of the fastest profile.
    TooShort {
        /// The time of the fastest profile, s.
        fastest: f64,
    },
}

impl EnergyOutcome {
    /// The best verified profile, if the time is possible.
    pub fn into_optimum(self) -> Option<EnergyOptimum> {
        match self {
            EnergyOutcome::Converged(o) | EnergyOutcome::Improved(o) | EnergyOutcome::Kept(o) => {
                Some(o)
            }
            EnergyOutcome::TooShort { .. } => None,
        }
    }
}

/// Accepted relative excess of a limit or of the time.
const ACCEPTED: f64 = 1e-9;
/// Relative excess over the fastest time below which the programs have no interior.
const NO_INTERIOR: f64 = 1e-5;
/// Largest overestimation by the tangents at convergence, as a share of the energy.
const CONVERGED: f64 = 1e-3;
/// Largest number of programs with tangents.
const MAX_TANGENTS: usize = 8;
/// Largest time of the uniformly slowed start, relative to the fastest profile.
const SLOWEST: f64 = 1e3;
/// Relative tolerance of the best time of the start: it sets scales alone.
const PACE_TOLERANCE: f64 = 0.02;
/// Time relative to the fastest profile beyond which the speed range has little effect.
const SLOW: f64 = 4.0;
/// Bisection steps for the speed cap of a slow profile.
const CAP_STEPS: usize = 40;

/// The solution of the relaxation of a problem.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyBound {
    /// Lower bound of the energy of profiles on the grid in the time, J.
    pub lower_bound: f64,
    /// ṡ² at the nodes of the relaxed optimum, which may be infeasible.
    pub b: Vec<f64>,
}

/// A lower bound of the energy; arguments as for [`minimize_energy`]. None if the time is too
/// short or the solver fails.
pub fn energy_bound(
    grid: &PathGrid,
    limits: &PathLimits,
    model: &EnergyModel,
    fastest: &Profile,
    duration: f64,
) -> Option<EnergyBound> {
    // At the fastest time the programs have no interior.
    if duration.is_nan() || duration < fastest.duration() * (1.0 + NO_INTERIOR) {
        return None;
    }
    let start = slowed(grid, limits, fastest, best_pace(grid, model, fastest, duration))?;
    let mut programs = Programs::new(grid, limits, model, &start, duration);
    if duration <= SLOW * fastest.duration() {
        programs = programs.within(&speed_range(grid, limits, duration));
    }
    let relaxed = programs.solve(Root::Relaxed)?;
    let lower_bound = path_constant(grid, model) + relaxed.bound.max(0.0);
    Some(EnergyBound { lower_bound, b: relaxed.b })
}

/// The profile of least energy from rest to rest in at most `duration` (s, may be infinite)
/// within the limits at both ends of each interval. `fastest` is the fastest profile on the same
/// grid; `relaxed` the relaxation of this problem, or of one on the same nodes with wider limits.
pub fn minimize_energy(
    grid: &PathGrid,
    limits: &PathLimits,
    model: &EnergyModel,
    fastest: &Profile,
    duration: f64,
    relaxed: Option<&EnergyBound>,
) -> EnergyOutcome {
    let too_short = EnergyOutcome::TooShort { fastest: fastest.duration() };
    if duration.is_nan() || duration < fastest.duration() {
        return too_short;
    }
    let pace = best_pace(grid, model, fastest, duration);
    let Some(start) = slowed(grid, limits, fastest, pace) else {
        return too_short;
    };
    let constant = path_constant(grid, model);
    let mut search = Search {
        grid,
        limits,
        model,
        duration,
        improved: false,
        best: EnergyOptimum {
            energy: evaluate(grid, &start, model),
            profile: start,
            lower_bound: relaxed.map_or(constant, |r| r.lower_bound),
            marginal: 0.0,
        },
    };
    if duration < fastest.duration() * (1.0 + NO_INTERIOR) {
        return EnergyOutcome::Kept(search.best);
    }
    let mut programs = Programs::new(grid, limits, model, &search.best.profile, duration);
    if let Some(step) = programs.interior(search.best.profile.b()) {
        search.offer(&step);
        if search.improved {
            return EnergyOutcome::Converged(search.best);
        }
    }
    let mut tangent = relaxed.map_or_else(|| search.best.profile.b().to_vec(), |r| r.b.clone());
    let mut converged = false;
    for _ in 0..MAX_TANGENTS {
        let Some(step) = programs.solve(Root::Tangent(&tangent)) else {
            break;
        };
        search.offer(&step);
        let settled = step.excess <= CONVERGED * (constant + step.energy).abs();
        converged = search.improved && (settled || programs.is_convex());
        if converged {
            break;
        }
        tangent = step.b;
    }
    match (converged, search.improved) {
        (true, _) => EnergyOutcome::Converged(search.best),
        (false, true) => EnergyOutcome::Improved(search.best),
        (false, false) => EnergyOutcome::Kept(search.best),
    }
}

/// The best verified profile so far.
struct Search<'a> {
    grid: &'a PathGrid,
    limits: &'a PathLimits,
    model: &'a EnergyModel,
    duration: f64,
    improved: bool,
    best: EnergyOptimum,
}

impl Search<'_> {
    /// Accepts the solution of a program if it is verified and better.
    fn offer(&mut self, step: &Step) {
        let Some(profile) = Profile::new(self.grid.s().to_vec(), step.b.clone()) else {
            return;
        };
        let kept = worst_ratio(self.grid, self.limits, profile.b()) <= 1.0 + ACCEPTED
            && profile.duration() <= self.duration * (1.0 + ACCEPTED);
        let energy = evaluate(self.grid, &profile, self.model);
        if kept && energy.total() <= self.best.energy.total() {
            self.improved = true;
            self.best.profile = profile;
            self.best.energy = energy;
            self.best.marginal = step.marginal;
        }
    }
}

/// The time up to `duration` at which the uniformly slowed fastest profile costs least, s; holding
/// and base power can make slow motions expensive. It sets the scales of the programs.
fn best_pace(grid: &PathGrid, model: &EnergyModel, fastest: &Profile, duration: f64) -> f64 {
    let cost = |log: f64| {
        let slower = fastest.scaled_to(fastest.duration() * log.exp());
        slower.map_or(f64::INFINITY, |p| evaluate(grid, &p, model).total())
    };
    let whole = (duration / fastest.duration()).min(SLOWEST).ln();
    let (mut lo, mut hi) = (0.0, whole);
    while hi - lo > PACE_TOLERANCE {
        let (a, b) = (lo + (hi - lo) / 3.0, hi - (hi - lo) / 3.0);
        if cost(a) > cost(b) {
            lo = a;
        } else {
            hi = b;
        }
    }
    let inner = 0.5 * (lo + hi);
    if cost(inner) < cost(whole) {
        fastest.duration() * inner.exp()
    } else {
        duration.min(SLOWEST * fastest.duration())
    }
}

/// The slowed fastest profile: uniformly if the limits permit it (friction does not fall with the
/// other loads), otherwise by a cap on the path speed.
fn slowed(
    grid: &PathGrid,
    limits: &PathLimits,
    fastest: &Profile,
    duration: f64,
) -> Option<Profile> {
    let allowed = worst_ratio(grid, limits, fastest.b()).max(1.0);
    let kept = |p: &Profile| worst_ratio(grid, limits, p.b()) <= allowed;
    if let Some(profile) = fastest.scaled_to(duration).filter(kept) {
        return Some(profile);
    }
    let mut slow = 0.0;
    let mut fast = fastest.b().iter().copied().fold(0.0, f64::max).sqrt();
    let mut best = None;
    for _ in 0..CAP_STEPS {
        let cap = 0.5 * (slow + fast);
        let capped = time_optimal(&grid.capped(|_| cap), limits).into_profile();
        match capped.filter(|p| p.duration() <= duration) {
            Some(profile) => {
                fast = cap;
                best = Some(profile);
            }
            None => slow = cap,
        }
    }
    best.or_else(|| Some(fastest.clone()).filter(kept))
}

/// Potential energy and Coulomb work of the path, J, with the work weight of the model. Simpson's
/// rule is exact for coefficients that are linear in s.
fn path_constant(grid: &PathGrid, model: &EnergyModel) -> f64 {
    let force =
        |p: &PathPoint| -> f64 { (0..DOF).map(|j| (p.g[j] + p.coulomb[j]) * p.q1[j]).sum() };
    let work = |(k, [begin, end]): (usize, &[PathPoint; 2])| {
        let middle = begin.toward(end, 0.5);
        grid.delta(k) / 6.0 * (force(begin) + 4.0 * force(&middle) + force(end))
    };
    model.work * grid.ends().iter().enumerate().map(work).sum::<f64>()
}

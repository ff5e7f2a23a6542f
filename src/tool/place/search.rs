//! The search for placements: candidates over the whole range are checked for reach; some are simulated;
//! a surrogate of energy and time proposes further ones; the most promising ones are simulated, too.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::bounds::Bounds;
use super::candidate::{Placed, Ways};
use super::error::PlaceError;
use super::placement::{Placement, Refusals};
use super::pool::{BASES, Today, Tried, even};
use super::surrogate::Surrogate;
use crate::arm::kinematics::Obstacle;
use crate::arm::robot::Model;
use crate::retime::energy::EnergyParts;
use crate::retime::energy::plausible::{Interval, Robots};
use crate::tool::retrofit::{Cell, Simulated, read_program};

/// Rounds of the surrogate.
const ROUNDS: u32 = 6;
/// Candidates of which each round looks at mean and deviation.
const LOOKED_AT: usize = 1000;
/// Factor on the predicted energy of a candidate whose cycle would be too long: the others come first.
const LATE: f64 = 2.0;
/// New candidates around the best one in each round.
const NEAR: u32 = 200;
/// How far those are from the best one in the first round, of the range.
const RADIUS: f64 = 0.25;
/// Radius of a round over that of the round before.
const SHRINK: f64 = 0.6;
/// Placements that are shown.
const SHOWN: usize = 20;
/// Least saving of a shown placement, of today's energy: less is within the grids of the simulation.
const LEAST_SAVING: f64 = 1e-3;
/// Least distance of shown placements along some axis, of the range.
const APART: f64 = 0.1;

/// What is searched for.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// Number of candidates over the whole range.
    pub candidates: u32,
    /// Without intervals over plausible robots.
    pub point_estimate: bool,
}

/// How many candidates are simulated.
#[derive(Clone, Copy)]
struct Simulations {
    /// Before the first surrogate.
    first: usize,
    /// In each round.
    per_round: usize,
    /// At the end.
    last: usize,
}

impl Simulations {
    /// A tenth of the candidates at most, where these are many.
    fn of(candidates: u32) -> Simulations {
        let share = |divisor: usize, least: usize, most: usize| {
            (candidates as usize / divisor).clamp(least, most)
        };
        Simulations {
            first: share(60, 40, 160),
            per_round: share(250, 10, 40),
            last: share(16, 20, 600),
        }
    }

    fn all(self) -> usize {
        self.first + ROUNDS as usize * self.per_round + self.last
    }
}

/// One of the best placements.
pub struct Best {
    /// What it is.
    pub placement: Placement,
    /// Its program.
    pub placed: Placed,
    /// Saving over plausible robots, %: of all energy, of the motion energy.
    pub saving_percent: Option<[Interval; 2]>,
}

/// How many candidates there were.
#[derive(Clone, Copy, Debug, Default)]
pub struct Count {
    /// Tried in all.
    pub tried: usize,
    /// With all targets in reach.
    pub reached: usize,
    /// Simulated as a whole.
    pub simulated: usize,
}

/// What is known of a candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outlook {
    /// A target is out of reach.
    OutOfReach,
    /// It was refused, or is predicted to take longer than today.
    Refused,
    /// Energy of its cycle as simulated or predicted, J.
    Energy(f64),
}

/// The result of a search.
pub struct Found {
    /// The program as it is.
    pub today: Placement,
    /// The best placements, the best first; each uses less energy than today.
    pub best: Vec<Best>,
    /// All accepted placements in the order in which they were tried.
    pub accepted: Vec<Placement>,
    /// All candidates, for a picture.
    pub map: Vec<(Vec<f64>, Outlook)>,
    /// How many there were.
    pub count: Count,
    /// Why simulated ones were refused.
    pub refusals: Refusals,
    /// Root mean square error of the surrogate where it was checked, % of the energy.
    pub surrogate_error_percent: Option<f64>,
}

/// Searches for placements; `obstacles` are in the base frame of the robot. `progress` receives the number
/// of finished candidates and the total.
///
/// # Errors
/// The program cannot be read; a frame cannot be moved or no movement depends on it; nothing moves.
pub fn place(
    cell: Cell<'_>,
    obstacles: &[Obstacle],
    bounds: &[Bounds],
    goal: Goal,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Found, PlaceError> {
    let (program, _) = read_program(cell.files, cell.entry)?;
    let ways = Ways::new((cell, obstacles), &program, bounds)?;
    let dimension = ways.freedom();
    if dimension > BASES.len() {
        return Err(PlaceError::Cycle(format!(
            "frames may move along {dimension} axes; give at most {}",
            BASES.len()
        )));
    }
    let today = ways
        .look()
        .filter(|today| today.placement.energy.motion_energy_j() > 0.0)
        .ok_or_else(|| {
            PlaceError::Cycle(
                "the cycle has no movement whose energy is known: joulepath simulate shows why"
                    .into(),
            )
        })?;
    ways.require_effect(&today)?;
    let simulations = Simulations::of(goal.candidates);
    let all = (goal.candidates + ROUNDS * NEAR) as usize + simulations.all();
    let done = AtomicUsize::new(0);
    let tick = || progress(done.fetch_add(1, Ordering::Relaxed) + 1, all);
    let mut search = Search {
        ways: &ways,
        today: &today,
        tick: &tick,
        simulations,
        tried: Vec::new(),
        rest: Vec::new(),
        beyond: Vec::new(),
        refusals: Refusals::default(),
        count: Count::default(),
    };
    search.spread(goal.candidates, dimension);
    for round in 0..ROUNDS {
        search.refine(round, dimension);
    }
    let surrogate_error_percent = search.confirm();
    let map = search.map();
    let (count, refusals) = (search.count, search.refusals);
    let accepted: Vec<Placement> =
        search.tried.into_iter().filter_map(|tried| tried.accepted).collect();
    let robots = if goal.point_estimate { None } else { Robots::new(cell.model) };
    let mut best = Vec::new();
    for placement in shown(&accepted, &today.placement) {
        let Some((placed, after)) = ways.cycle_at(&placement.point) else { continue };
        let saving_percent = robots.as_ref().map(|robots| {
            let of = |model: &Model, cycle: &Simulated| {
                robots.energies(model, &cycle.simulation, cycle.account.total)
            };
            saving_percent(&of(cell.model, &today.cycle), &of(&placed.model, &after))
        });
        best.push(Best { placement, placed, saving_percent });
    }
    Ok(Found {
        today: today.placement,
        best,
        accepted,
        map,
        count,
        refusals,
        surrogate_error_percent,
    })
}

struct Search<'a> {
    ways: &'a Ways<'a>,
    today: &'a Today,
    tick: &'a (dyn Fn() + Sync),
    simulations: Simulations,
    /// Simulated.
    tried: Vec<Tried>,
    /// In reach, and not simulated.
    rest: Vec<Vec<f64>>,
    /// With a target out of reach.
    beyond: Vec<Vec<f64>>,
    refusals: Refusals,
    count: Count,
}

impl Search<'_> {
    /// Candidates over the whole range, and the first simulations.
    fn spread(&mut self, candidates: u32, dimension: usize) {
        let points = (1..=candidates).map(|n| even(n, dimension)).collect();
        self.add(points);
        let first = self.rest.drain(..self.simulations.first.min(self.rest.len())).collect();
        self.simulate(first);
    }

    /// Simulates what the surrogate finds promising, near the best candidate and elsewhere.
    fn refine(&mut self, round: u32, dimension: usize) {
        if let Some(best) = self.best() {
            let radius = RADIUS * SHRINK.powi(round.cast_signed());
            let first = round * NEAR + 1;
            let near = (first..first + NEAR).map(|n| {
                let around = even(n, dimension);
                let moved = best.iter().zip(around).map(|(x, u)| x + radius * (2.0 * u - 1.0));
                moved.map(|x| x.clamp(0.0, 1.0)).collect()
            });
            self.add(near.collect());
        }
        let Some(surrogates) = self.surrogates() else { return };
        let predicted = self.predicted(&surrogates);
        let mut order: Vec<usize> = (0..predicted.len()).collect();
        order.sort_by(|a, b| predicted[*a].total_cmp(&predicted[*b]));
        let mut worth = vec![f64::INFINITY; predicted.len()];
        // Deviations take time: of the most promising ones only.
        for index in order.into_iter().take(LOOKED_AT) {
            let [[j, j_sd], [s, s_sd]] = surrogates.each_ref().map(|of| of.at(&self.rest[index]));
            if s - s_sd <= self.today.placement.cycle_s {
                worth[index] = j - j_sd;
            }
        }
        let chosen = self.take(&worth, self.simulations.per_round);
        self.simulate(chosen);
    }

    /// Simulates the candidates of least predicted energy. The error of the predictions, % of the energy.
    fn confirm(&mut self) -> Option<f64> {
        let surrogates = self.surrogates()?;
        let worth = self.predicted(&surrogates);
        let chosen = self.take(&worth, self.simulations.last);
        let before = self.tried.len();
        self.simulate(chosen);
        let errors = self.tried[before..].iter().filter_map(|tried| {
            let [simulated, _] = tried.figures?;
            Some((surrogates[0].mean_at(&tried.point) / simulated - 1.0).powi(2))
        });
        let errors: Vec<f64> = errors.collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        (!errors.is_empty()).then(|| 100.0 * mean.sqrt())
    }

    /// Predicted energies of the candidates that are left, J; more where the cycle would be late.
    fn predicted(&self, [energy, time]: &[Surrogate; 2]) -> Vec<f64> {
        let limit = self.today.placement.cycle_s;
        let one = |point: &Vec<f64>| {
            let late = if time.mean_at(point) > limit { LATE } else { 1.0 };
            late * energy.mean_at(point)
        };
        self.rest.par_iter().map(one).collect()
    }

    fn add(&mut self, points: Vec<Vec<f64>>) {
        self.count.tried += points.len();
        let (reached, beyond) = self.ways.in_reach(points, self.today, self.tick);
        self.count.reached += reached.len();
        self.rest.extend(reached);
        self.beyond.extend(beyond);
    }

    fn simulate(&mut self, points: Vec<Vec<f64>>) {
        self.count.simulated += points.len();
        let tried = self.ways.simulated(points, self.today, &mut self.refusals, self.tick);
        self.tried.extend(tried);
    }

    /// Takes the points of least worth.
    fn take(&mut self, worth: &[f64], count: usize) -> Vec<Vec<f64>> {
        let mut order: Vec<usize> = (0..worth.len()).filter(|i| worth[*i].is_finite()).collect();
        order.sort_by(|a, b| worth[*a].total_cmp(&worth[*b]));
        order.truncate(count);
        let mut is_taken = vec![false; worth.len()];
        for i in &order {
            is_taken[*i] = true;
        }
        let taken = order.iter().map(|i| self.rest[*i].clone()).collect();
        let mut taken_flags = is_taken.iter();
        self.rest.retain(|_| !taken_flags.next().copied().unwrap_or(false));
        taken
    }

    /// The point of least energy among the accepted ones.
    fn best(&self) -> Option<Vec<f64>> {
        let accepted = self.tried.iter().filter_map(|tried| tried.accepted.as_ref());
        let best = accepted.min_by(|a, b| a.energy.energy_j().total_cmp(&b.energy.energy_j()))?;
        Some(best.point.clone())
    }

    /// Surrogates of energy and duration.
    fn surrogates(&self) -> Option<[Surrogate; 2]> {
        let known = self.tried.iter().filter_map(|tried| Some((&tried.point, tried.figures?)));
        let (points, figures): (Vec<Vec<f64>>, Vec<[f64; 2]>) =
            known.map(|(point, figures)| (point.clone(), figures)).unzip();
        let of = |which: usize| {
            let figures: Vec<f64> = figures.iter().map(|of| of[which]).collect();
            Surrogate::new(&points, &figures)
        };
        let (energy, time) = rayon::join(|| of(0), || of(1));
        Some([energy?, time?])
    }

    fn map(&self) -> Vec<(Vec<f64>, Outlook)> {
        let outlook = |energy: Option<f64>| energy.map_or(Outlook::Refused, Outlook::Energy);
        let tried = self.tried.iter().map(|tried| {
            let energy = tried.accepted.as_ref().map(|accepted| accepted.energy.energy_j());
            (tried.point.clone(), outlook(energy))
        });
        let surrogates = self.surrogates();
        let limit = self.today.placement.cycle_s;
        let predicted = self.rest.iter().map(|point| {
            let energy = surrogates.as_ref().and_then(|[energy, time]| {
                (time.mean_at(point) <= limit).then(|| energy.mean_at(point))
            });
            (point.clone(), outlook(energy))
        });
        let beyond = self.beyond.iter().map(|point| (point.clone(), Outlook::OutOfReach));
        tried.chain(predicted).chain(beyond).collect()
    }
}

impl Ways<'_> {
    /// An error if the cycle is the same wherever the frames stand.
    fn require_effect(&self, today: &Today) -> Result<(), PlaceError> {
        let was = today.placement.energy.energy_j();
        let dimension = self.freedom();
        let corners = [0.0, 1.0].map(|x| vec![x; dimension]);
        let is_same = |point: &Vec<f64>| {
            self.cycle_at(point).is_some_and(|(_, cycle)| cycle.account.total.energy_j() == was)
        };
        if corners.iter().all(is_same) {
            return Err(PlaceError::Cycle(
                "no movement of the cycle depends on these frames: name those that its movements use"
                    .into(),
            ));
        }
        Ok(())
    }
}

/// The saving over plausible robots, %: of all energy, of the motion energy.
fn saving_percent(before: &[EnergyParts], after: &[EnergyParts]) -> [Interval; 2] {
    let parts: [fn(&EnergyParts) -> f64; 2] = [EnergyParts::energy_j, EnergyParts::motion_energy_j];
    parts.map(|part| {
        let both = before.iter().zip(after);
        let saved = both.map(|(was, is)| 100.0 * (1.0 - part(is) / part(was)));
        Interval::from_values(&saved.collect::<Vec<f64>>())
    })
}

/// The best placements that use less than today, some distance apart.
fn shown(accepted: &[Placement], today: &Placement) -> Vec<Placement> {
    let energy = |of: &Placement| of.energy.energy_j();
    let mut order: Vec<&Placement> =
        accepted.iter().filter(|of| energy(of) < (1.0 - LEAST_SAVING) * energy(today)).collect();
    order.sort_by(|a, b| energy(a).total_cmp(&energy(b)));
    let mut chosen: Vec<Placement> = Vec::new();
    for next in order {
        let is_apart = |other: &Placement| {
            next.point.iter().zip(&other.point).any(|(a, b)| (a - b).abs() >= APART)
        };
        if chosen.len() < SHOWN && chosen.iter().all(is_apart) {
            chosen.push(next.clone());
        }
    }
    chosen
}

//! Replaces a run of movements by a stream of least energy in a given time.
//!
//! The convex program on the path gives a reference motion. A stream is fitted to it and its
//! realised motion is checked. If a limit is exceeded, the next attempt has tighter margins.

use std::cell::Cell;

use super::attempt::{Attempt, Fit};
use super::energy_program::{EnergyBound, energy_bound, minimize_energy};
use super::keep_out;
use super::margins::{Margins, SPACINGS};
use super::reason::Reason;
pub use super::run_problem::Task;
use super::run_problem::{INTERVALS, RunProblem, fastest_profile};
use super::stream_polish::Until;
use super::stream_rounding::{quantum, round_down, round_up, rounded_intervals};
use crate::arm::dynamics::potential_energy;
use crate::retime::energy::power::motion_energy;
use crate::retime::energy::{EnergyParts, account};
use crate::retime::motion::stream::Stream;
use crate::retime::motion::timed::TimedMotion;
use crate::retime::path::joint_path::{DOF, Joints};

/// The required time of a run, with settling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// Least energy in at most this time, s; only if it saves energy.
    Within(f64),
    /// Least energy in this time, s.
    Exactly(f64),
    /// Least time.
    Fastest,
}

/// A stream that replaces a run.
#[derive(Clone, Debug)]
pub struct Retiming {
    /// The stream, rounded as in the emitted text.
    pub stream: Stream,
    /// Energy of the run with the stream and settling.
    pub energy: EnergyParts,
    /// Energy of the original run, J.
    pub energy_before_j: f64,
    /// Duration with the stream and settling, s.
    pub duration_s: f64,
    /// Lower bound of the energy on the path in this time, sum of all six parts, J.
    pub lower_bound_j: f64,
    /// Whether it keeps to the path.
    pub path: PathUse,
}

/// Whether a stream follows the path of its run.
#[derive(Clone, Debug, PartialEq)]
pub enum PathUse {
    /// It stays within the tolerance.
    Kept,
    /// It stays within the tolerance for this reason, although it was free.
    KeptFor(Reason),
    /// It leaves the path within its freedom.
    Left,
}

/// Largest number of attempts with tighter margins, and of those that end far from allowed.
const ATTEMPTS: usize = 8;
const FAR_ATTEMPTS: usize = 4;
/// Relative difference between two integrations of the same energy.
const BOUND_ROUNDING: f64 = 1e-5;
/// Share of a limit beyond which the next attempt starts from the program instead of polishing.
const NEARLY: f64 = 2.0;
/// Smallest saving that is worth a stream, as a share of the motion energy.
const WORTHWHILE: f64 = 1e-3;
/// Share of the motion energy within which a stream is near its lower bound.
const NEAR_BOUND: f64 = 0.01;
/// Largest share of the energy that further polishing may still save.
const HOPELESS: f64 = 0.05;
/// Smallest search step for slow motions, as a share of their duration.
const SLOW_STEP: f64 = 0.02;
/// Largest time added to the fastest profile in the search for the fastest stream, in ramp times, and
/// the smaller ones.
const LONGEST: f64 = 1.8;
const SHORTER: [f64; 7] = [0.25, 0.4, 0.55, 0.7, 0.85, 1.0, 1.3];

/// Steps towards the fastest profile with streams of least energy.
const BISECTIONS: usize = 2;

/// The stream of a run.
///
/// # Errors
/// The reason why the run stays unchanged.
pub fn retime(task: &Task<'_>, goal: Goal) -> Result<Retiming, Reason> {
    let mut moves = task.run.moves.iter();
    if !moves.any(|record| task.freedom.free_deviation(&record.movement) > 0.0) {
        return on_path(task, goal);
    }
    // The free stream is used only if it is better than the one on the path.
    let strict = task.freedom.strict();
    let kept = on_path(&Task { freedom: &strict, ..*task }, goal);
    let body = keep_out::body(task.model, task.run, task.freedom);
    if body.is_some_and(|body| keep_out::enters(&body, task.run)) {
        let path = PathUse::KeptFor(Reason::KeepOut);
        return kept.map(|kept| Retiming { path, ..kept });
    }
    let free = on_path(task, goal).map(|free| {
        let bound = free_bound(task, free.duration_s - task.run.settling);
        let idle = free.energy.energy_j() - free.energy.motion_energy_j();
        Retiming { path: PathUse::Left, lower_bound_j: bound + idle, ..free }
    });
    match (kept, free) {
        (Ok(kept), Ok(free)) => {
            let better = match goal {
                Goal::Fastest => free.duration_s < kept.duration_s,
                _ => free.energy.energy_j() < kept.energy.energy_j(),
            };
            Ok(if better { free } else { kept })
        }
        (Ok(only), Err(_)) | (Err(_), Ok(only)) => Ok(only),
        (Err(reason), Err(_)) => Err(reason),
    }
}

/// Lower bound of the energy of any motion between the ends of a run in this time (s), J: potential
/// energy, Coulomb friction over the distance and viscous friction at constant speed.
fn free_bound(task: &Task<'_>, time: f64) -> f64 {
    let Task { model, run, .. } = task;
    let height = |q: &Joints| potential_energy(model, &run.load, q);
    let friction: f64 = (0..DOF)
        .map(|j| (run.end[j] - run.start[j]).abs())
        .enumerate()
        .map(|(j, way)| way * (model.friction.coulomb[j] + model.friction.viscous[j] * way / time))
        .sum();
    height(&run.end) - height(&run.start) + friction
}

fn on_path(task: &Task<'_>, goal: Goal) -> Result<Retiming, Reason> {
    let problem = RunProblem::new(task)?;
    match goal {
        Goal::Within(time) => {
            let before = task.energy_before.motion_energy_j();
            let worth = before - WORTHWHILE * before.abs();
            let retiming = problem
                .least_energy(time, worth)
                .or_else(|reason| problem.or_fastest_slowed(reason, time))?;
            let saves = retiming.energy.energy_j() < task.energy_before.energy_j();
            if saves { Ok(retiming) } else { Err(Reason::NoSaving) }
        }
        Goal::Exactly(time) => {
            problem.least_energy(time, f64::INFINITY).or_else(|reason| match reason {
                Reason::NoSaving => problem.fastest_slowed(time),
                reason => problem.or_fastest_slowed(reason, time),
            })
        }
        Goal::Fastest => Ok(problem.shortened(problem.least_time()?)),
    }
}

/// The least time of a run as a stream, s; `None` if no stream exists.
pub fn fastest(task: &Task<'_>) -> Option<f64> {
    let problem = RunProblem::new(task).ok()?;
    Some(problem.shortened(problem.least_time().ok()?).duration_s)
}

/// Largest factor by which a run is slowed.
pub const SLOWEST: f64 = 10.0;

impl RunProblem<'_> {
    /// Least energy in a time (s, with settling), if the motion energy is below `worth` (J).
    fn least_energy(&self, time: f64, worth: f64) -> Result<Retiming, Reason> {
        let budget = round_down(time - self.task.run.settling);
        let bound = self.bound(budget);
        let with = |spacing: f64| {
            let margins = Margins::first(self.tolerance(), spacing);
            self.least_energy_with(margins, budget, worth, bound.as_ref())
        };
        let [few, many] = SPACINGS;
        let few = with(few);
        let near = |retiming: &Retiming| {
            let energy =
                retiming.energy.energy_j() - NEAR_BOUND * retiming.energy.motion_energy_j();
            energy < retiming.lower_bound_j
        };
        match few {
            Ok(few) if near(&few) => Ok(few),
            Ok(few) => match with(many) {
                Ok(many) if many.energy.energy_j() < few.energy.energy_j() => Ok(many),
                _ => Ok(few),
            },
            Err(reason) => with(many).or(Err(reason)),
        }
    }

    /// The same with these margins in the first attempt; without settling.
    fn least_energy_with(
        &self,
        mut margins: Margins,
        budget: f64,
        worth: f64,
        bound: Option<&EnergyBound>,
    ) -> Result<Retiming, Reason> {
        let is_tight = Cell::new(false);
        let begin = |margins: &Margins| {
            let program = self.least_energy_program(budget, margins, bound);
            is_tight.set(is_tight.get() || matches!(program, Err(Reason::NoSaving)));
            program.or_else(|reason| self.fit_original(reason, budget, margins))
        };
        // Tighter margins do not lower the energy; polishing lowers it slightly.
        let hopeless = |attempt: &Attempt| {
            let energy = self.moving(&attempt.stream).motion_energy_j();
            energy - HOPELESS * energy.abs() >= worth
        };
        let attempt = self.attempts(&mut margins, Until::Least, &begin, &hopeless);
        let attempt = attempt.map_err(|reason| match reason {
            Reason::NoStream(_) if is_tight.get() => Reason::NoSaving,
            reason => reason,
        })?;
        let retiming = self.retiming(attempt.stream, bound.map(|bound| bound.lower_bound));
        let saves = retiming.energy.motion_energy_j() < worth;
        if saves { Ok(retiming) } else { Err(Reason::NoSaving) }
    }

    /// Attempts at a stream that keeps all limits, from `begin` on with margins that each check
    /// tightens. A hopeless one is not worth another.
    fn attempts(
        &self,
        margins: &mut Margins,
        until: Until,
        begin: &dyn Fn(&Margins) -> Result<Fit, Reason>,
        hopeless: &dyn Fn(&Attempt) -> bool,
    ) -> Result<Attempt, Reason> {
        let mut problem = String::new();
        let mut begun: Option<Fit> = None;
        let mut worst = NEARLY;
        let mut far = 0;
        for _ in 0..ATTEMPTS {
            let fit = begun.take().map_or_else(|| begin(margins), Ok);
            match fit.and_then(|fit| self.realise(fit, margins, until)) {
                Ok(attempt) if attempt.check.holds() => return Ok(attempt),
                Ok(attempt) if hopeless(&attempt) => return Err(Reason::NoSaving),
                Ok(attempt) => {
                    problem = attempt.check.fault();
                    let share = attempt.check.worst();
                    if !attempt.near {
                        far += 1;
                        if far == FAR_ATTEMPTS {
                            break;
                        }
                        margins.closer(&attempt.check);
                    } else if share < worst {
                        worst = share;
                        margins.tighten_a_little(&attempt.check);
                        begun = Some(attempt.fit);
                    } else {
                        worst = NEARLY;
                        margins.tighten(&attempt.check);
                    }
                }
                Err(Reason::NoStream(why)) => {
                    margins.lighten();
                    problem = why;
                }
                Err(other) => return Err(other),
            }
        }
        Err(Reason::NoStream(problem))
    }

    /// The solution of the convex program and a stream fitted to it.
    fn least_energy_program(
        &self,
        budget: f64,
        margins: &Margins,
        bound: Option<&EnergyBound>,
    ) -> Result<Fit, Reason> {
        let (mut grid, limits) = self.grid(margins, INTERVALS)?;
        let mut fast = fastest_profile(&grid, &limits)?;
        if fast.duration() > budget {
            // The grid without shaping permits a shorter time; polishing has to shape the motion.
            (grid, _) = self.bare_grid(margins, INTERVALS)?;
            fast = fastest_profile(&grid, &limits)?;
        }
        // The relaxation bounds the electrical energy only.
        let bound = bound.filter(|_| self.model == self.electrical);
        let optimum = minimize_energy(&grid, &limits, &self.model, &fast, budget, bound)
            .into_optimum()
            .ok_or(Reason::NoSaving)?;
        self.fit_profile(&optimum.profile, budget, margins)
    }

    /// Lower bound of the motion energy on the path in this time at the full limits.
    fn bound(&self, budget: f64) -> Option<EnergyBound> {
        let (grid, limits) = self.bare_grid(&Margins::none(), INTERVALS).ok()?;
        let fast = fastest_profile(&grid, &limits).ok()?;
        energy_bound(&grid, &limits, &self.electrical, &fast, budget)
    }

    /// Least time: the fastest profile, lengthened until it keeps the jerk limit.
    fn least_time(&self) -> Result<Retiming, Reason> {
        let mut margins = Margins::first(self.tolerance(), SPACINGS[0]);
        let begin = |margins: &Margins| self.lengthened(LONGEST, margins);
        let mut found = self.attempts(&mut margins, Until::Kept, &begin, &|_| false)?;
        // Bisection for its predicate: a longer stream is easier. The shortest one found is kept.
        let _ = SHORTER.partition_point(|share| {
            let fit = self.lengthened(*share, &margins);
            match fit.and_then(|fit| self.realise(fit, &margins, Until::Kept)) {
                Ok(attempt) if attempt.check.holds() => {
                    found = attempt;
                    false
                }
                _ => true,
            }
        });
        let stream = match self.realise(found.fit, &margins, Until::Least) {
            Ok(polished) if polished.check.holds() => polished.stream,
            _ => found.stream,
        };
        Ok(self.retiming(stream, None))
    }

    /// A faster stream between the fastest profile and this one: one of least energy has its points
    /// where the profile bends.
    fn shortened(&self, mut fastest: Retiming) -> Retiming {
        let bare = self.bare_grid(&Margins::none(), INTERVALS);
        let profile = bare.and_then(|(grid, limits)| fastest_profile(&grid, &limits));
        let Ok(profile) = profile else { return fastest };
        let mut shortest = profile.duration() + self.task.run.settling;
        for _ in 0..BISECTIONS {
            let time = 0.5 * (shortest + fastest.duration_s);
            match self.least_energy(time, f64::INFINITY) {
                Ok(faster) if faster.duration_s < fastest.duration_s => fastest = faster,
                _ => shortest = time,
            }
        }
        fastest
    }

    /// A stream that takes longer than the fastest profile by a share of a ramp.
    fn lengthened(&self, share: f64, margins: &Margins) -> Result<Fit, Reason> {
        let (grid, limits) = self.grid(margins, INTERVALS)?;
        let fast = fastest_profile(&grid, &limits)?;
        let ramp = self.task.model.controller.ramp_s.unwrap_or(0.1);
        let step = ramp.max(SLOW_STEP * fast.duration());
        self.fit_profile(&fast, round_up(fast.duration() + share * step), margins)
    }

    /// The fastest stream, slowed to the given time.
    fn fastest_slowed(&self, time: f64) -> Result<Retiming, Reason> {
        let retiming = self.least_time()?;
        if retiming.duration_s > time + quantum() {
            return Err(Reason::TooShort(retiming.duration_s));
        }
        let slowed = self.slowed(&retiming.stream, round_down(time - self.task.run.settling));
        let better = slowed.filter(|slow| slow.energy.energy_j() < retiming.energy.energy_j());
        Ok(better.unwrap_or(retiming))
    }

    /// The same after failed attempts at a stream; other reasons are returned.
    fn or_fastest_slowed(&self, reason: Reason, time: f64) -> Result<Retiming, Reason> {
        match reason {
            Reason::NoStream(_) => self.fastest_slowed(time).or(Err(reason)),
            other => Err(other),
        }
    }

    /// A stream with lengthened intervals, if it keeps the limits: friction and gravity torques do
    /// not fall with the speed.
    fn slowed(&self, stream: &Stream, duration: f64) -> Option<Retiming> {
        let longer = duration / stream.duration();
        let intervals: Vec<f64> = stream.intervals().iter().map(|x| x * longer).collect();
        let intervals = rounded_intervals(&intervals, duration);
        let slow = Stream::new(*stream.start(), stream.points().to_vec(), intervals).ok()?;
        let holds = self.check(&slow).holds();
        let bound = self.bound(duration).map(|bound| bound.lower_bound);
        holds.then(|| self.retiming(slow, bound))
    }

    /// Energy of the motion of a stream without settling.
    fn moving(&self, stream: &Stream) -> EnergyParts {
        let motion = TimedMotion::Stream(stream.clone());
        motion_energy(self.task.model, &self.task.run.load, &motion, 0.0, stream.duration())
    }

    fn retiming(&self, stream: Stream, bound: Option<f64>) -> Retiming {
        let task = self.task;
        let duration = stream.duration();
        let moving = self.moving(&stream);
        let energy = moving
            + account::base(task.model, duration)
            + account::at_rest(task.model, &task.run.load, &task.run.end, task.run.settling);
        let idle = energy.energy_j() - energy.motion_energy_j();
        // The realised motion may cut corners within the tolerance and fall below the bound of the
        // path: then the bound is lowered to its energy.
        let achieved = moving.motion_energy_j();
        let bound =
            bound.unwrap_or(f64::NEG_INFINITY).min(achieved - BOUND_ROUNDING * achieved.abs());
        Retiming {
            stream,
            energy,
            energy_before_j: task.energy_before.energy_j(),
            duration_s: duration + task.run.settling,
            lower_bound_j: bound + idle,
            path: PathUse::Kept,
        }
    }
}

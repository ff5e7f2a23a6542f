//! D-optimal Fourier series within all limits (J. Swevers, C. Ganseman, D. Tükel, J. De Schutter,
//! H. Van Brussel, "Optimal robot excitation and identification", IEEE T-RA 13, 1997).
//!
//! The variables are unbounded: amplitudes are scaled and offsets moved so that the limits of
//! position, speed and acceleration hold. A penalty and finally a smaller amplitude enforce the
//! limits of torque and clearance.

use nalgebra::{DMatrix, DVector, Vector3};
use rayon::prelude::*;

use crate::arm::dynamics::{
    BaseParameters, Load, RIGID, base_parameters, base_parameters_among, base_parameters_at_rest,
};
use crate::arm::kinematics::{Body, Obstacle};
use crate::arm::robot::Model;

use super::error::ExciteError;
use super::feasible::{Checked, Ratios, check, rate_limits};
use super::information::{Information, Normal, information, log_det};
use super::plateaus::pose;
use super::search::maximise;
use super::series::{Series, State};

/// Sampled states for each period of the fastest harmonic.
const STATES: usize = 10;
/// Factor of the number of states in the check between the states of the objective.
pub(super) const FINER: usize = 4;
/// Random motions from which the best starts are chosen.
const TRIED: usize = 300;
/// Motions that are optimised.
const STARTS: usize = 4;
/// Relative sizes that are tried until a random motion keeps all limits.
const SIZES: [f64; 6] = [1.0, 0.7, 0.5, 0.35, 0.2, 0.1];
/// Iterations of the optimisation.
const ROUNDS: usize = 70;
/// Weights of limit violations, increased while some remain.
const PENALTIES: [f64; 3] = [200.0, 2000.0, 20000.0];
/// Weight of the logarithm of the condition number above [`GOOD`].
const CONDITION: f64 = 20.0;
/// Scaled condition number without penalty.
const GOOD: f64 = 12.0;
/// Additional clearance \[m\].
const ROOM: f64 = 0.01;
/// Interval of the final check \[s\].
const FINE: f64 = 0.001;
#[cfg(feature = "internals")]
/// Milliseconds that one state represents, in the comparison with random motions.
const EVERY: f64 = 10.0;
/// Factor by which a motion that breaks a limit between the states is reduced.
const SMALLER: f64 = 0.985;
/// Largest number of such reductions.
const REPAIRS: usize = 80;
/// Shares of a joint's range, its acceleration and its torque that are used.
const USED: [f64; 3] = [0.95, 0.95, 0.9];

/// Parameters that the motion excites.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Focus {
    /// All base parameters.
    All,
    /// Gravity parameters and Coulomb friction: slow motion, each pose in both directions.
    Gravity,
    /// The load at the flange.
    Payload,
}

/// Settings of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Parameters that the motion excites.
    pub focus: Focus,
    /// Base frequency \[Hz\].
    pub base_frequency: f64,
    /// Harmonics that are used, as multiples of the base frequency.
    pub harmonics: Vec<usize>,
    /// Share of the joints' speed limits that is used.
    pub speed_share: f64,
    /// Obstacles that arm and tool avoid.
    pub obstacles: Vec<Obstacle>,
    /// Tool centre point in tool0 \[m\].
    pub tool: Vector3<f64>,
    /// The load at the flange.
    pub load: Load,
    /// Seed of the random starts.
    pub seed: u64,
}

/// A designed motion.
#[derive(Clone, Debug)]
pub struct Designed {
    /// The motion.
    pub series: Series,
    /// Its information on the base parameters.
    pub information: Information,
    /// Its extremes, sampled every millisecond.
    pub checked: Checked,
}

/// A design problem: the robot, its limits and the base parameters.
pub(super) struct Problem<'a> {
    model: &'a Model,
    settings: &'a Design,
    base: BaseParameters,
    /// Largest allowed ratios to the limits.
    shares: Ratios,
    velocity: &'a [f64],
    acceleration: &'a [f64],
    states: usize,
}

/// The best motion found; `progress` receives the number of completed rounds and the total.
///
/// # Errors
/// The robot lacks limits, or no motion keeps them.
pub fn design(
    model: &Model,
    settings: &Design,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Designed, ExciteError> {
    let problem = Problem::new(model, settings)?;
    // Without a collision-free pose there is no motion; the search would take long to fail.
    pose(model, &problem.body())?;
    let mut random = fastrand::Rng::with_seed(settings.seed);
    let tried: Vec<DVector<f64>> = (0..TRIED).map(|_| problem.random(&mut random)).collect();
    let mut rated: Vec<(f64, DVector<f64>)> = tried
        .into_par_iter()
        .map(|x| {
            let mut work = Work::new(&problem);
            let x = problem.shrunk(&mut work, x);
            (problem.value(&mut work, &x, PENALTIES[1], 1), x)
        })
        .collect();
    rated.sort_by(|a, b| b.0.total_cmp(&a.0));
    rated.truncate(STARTS);
    let done = std::sync::atomic::AtomicUsize::new(0);
    let found: Vec<DVector<f64>> = rated
        .par_iter()
        .map(|(_, start)| {
            let mut work = Work::new(&problem);
            let step = || {
                let count = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
                progress(count.min(STARTS * ROUNDS), STARTS * ROUNDS);
            };
            let [first, heavier @ ..] = PENALTIES;
            let mut value = |x: &DVector<f64>| problem.value(&mut work, x, first, 1);
            let (mut found, _) = maximise(start.clone(), ROUNDS, &mut value, &step);
            for weight in heavier {
                if problem.excess(&mut work, &found, FINER) == 0.0 {
                    break;
                }
                let mut value = |x: &DVector<f64>| problem.value(&mut work, x, weight, FINER);
                found = maximise(found, ROUNDS / 2, &mut value, &|| ()).0;
            }
            found
        })
        .collect();
    // A reduced motion may carry less information than the start of its optimisation.
    let all: Vec<&DVector<f64>> = found.iter().chain(rated.iter().map(|(_, x)| x)).collect();
    let kept: Vec<Option<Designed>> =
        all.into_par_iter().map(|x| problem.repaired(&problem.series(x))).collect();
    let worth = |of: &Designed| {
        let told = &of.information;
        told.log_det - CONDITION * (told.scaled / GOOD).ln().max(0.0)
    };
    let best = kept.into_iter().flatten().max_by(|a, b| worth(a).total_cmp(&worth(b)));
    best.ok_or(ExciteError::Nowhere)
}

/// log det of the best of `count` random motions that keep all limits, for comparison.
///
/// # Errors
/// The robot lacks limits, or none of them keeps them.
#[cfg(feature = "internals")]
pub fn random_feasible(model: &Model, settings: &Design, count: usize) -> Result<f64, ExciteError> {
    let problem = Problem::new(model, settings)?;
    let mut random = fastrand::Rng::with_seed(settings.seed);
    let mut work = Work::new(&problem);
    let mut best = None;
    let mut found = 0;
    // Most random motions break a limit; enough are tried to find the ones that do not.
    for _ in 0..200 * count {
        let series = problem.series(&problem.random(&mut random));
        let states = series.sampled(problem.states);
        let checked = check(model, &work.body, &settings.load, &states);
        if checked.excess(&problem.shares) > 0.0 {
            continue;
        }
        // Scaled to one state per millisecond, as in a design.
        let states = series.sampled((series.period() / (EVERY * FINE)).round() as usize);
        let value = log_det(&(work.normal.matrix(&states) * EVERY)).unwrap_or(f64::NEG_INFINITY);
        best = Some(best.map_or(value, |best: f64| best.max(value)));
        found += 1;
        if found == count {
            break;
        }
    }
    best.ok_or(ExciteError::Nowhere)
}

pub(super) struct Work<'a> {
    normal: Normal<'a>,
    body: Body<'a>,
}

impl<'a> Work<'a> {
    pub(super) fn new(problem: &'a Problem<'_>) -> Work<'a> {
        Work { normal: Normal::new(problem.model, &problem.base), body: problem.body() }
    }
}

impl<'a> Problem<'a> {
    pub(super) fn new(model: &'a Model, settings: &'a Design) -> Result<Problem<'a>, ExciteError> {
        let [velocity, acceleration] = rate_limits(model)?;
        let n = model.dof;
        let base = match settings.focus {
            Focus::All => base_parameters(model),
            Focus::Payload => {
                let last: Vec<usize> = (RIGID * (n - 1)..RIGID * n).collect();
                base_parameters_among(model, &last)
            }
            Focus::Gravity => {
                // First moments, masses, Coulomb friction, offsets: slow motion determines these;
                // inertia has no effect.
                let weights = (0..RIGID * n).filter(|index| index % RIGID < 4);
                let joints = (0..n).flat_map(|joint| {
                    let first = RIGID * n + crate::arm::dynamics::JOINT * joint;
                    [first + 2, first + 3]
                });
                let among: Vec<usize> = weights.chain(joints).collect();
                base_parameters_at_rest(model, &among)
            }
        };
        let fastest = settings.harmonics.iter().copied().max().unwrap_or(1);
        let shares = Ratios {
            position: USED[0],
            velocity: settings.speed_share,
            acceleration: USED[1],
            torque: USED[2],
        };
        let states = STATES * fastest;
        Ok(Problem { model, settings, base, shares, velocity, acceleration, states })
    }

    pub(super) fn body(&self) -> Body<'a> {
        Body::new(self.model, self.settings.tool, &self.settings.obstacles)
    }

    pub(super) fn per_joint(&self) -> usize {
        1 + 2 * self.settings.harmonics.len()
    }

    pub(super) fn random(&self, random: &mut fastrand::Rng) -> DVector<f64> {
        let count = self.per_joint();
        DVector::from_fn(count * self.model.dof, |k, _| {
            let value = 2.0 * random.f64() - 1.0;
            if k % count == 0 { value } else { 1.5 * value }
        })
    }

    /// The motion of the variables `x`: for each joint the position of its middle, then the sine
    /// and cosine of each harmonic relative to the largest amplitude of that harmonic alone.
    pub(super) fn series(&self, x: &DVector<f64>) -> Series {
        let n = self.model.dof;
        let harmonics = &self.settings.harmonics;
        let count = self.per_joint();
        let w0 = std::f64::consts::TAU * self.settings.base_frequency;
        let (mut offset, mut amplitude) = (Vec::new(), Vec::new());
        for joint in 0..n {
            let of = &x.as_slice()[joint * count..(joint + 1) * count];
            let [low, high] = self.model.limits.position[joint];
            let half = self.shares.position * 0.5 * (high - low).min(MOST);
            let (v, a) = (
                self.shares.velocity * self.velocity[joint],
                self.shares.acceleration * self.acceleration[joint],
            );
            let mut pairs: Vec<[f64; 2]> = harmonics
                .iter()
                .zip(of[1..].chunks(2))
                .map(|(k, pair)| {
                    let w = w0 * *k as f64;
                    let alone = half.min(v / w).min(a / (w * w));
                    [alone * pair[0], alone * pair[1]]
                })
                .collect();
            let (reach, fast, hard) = extremes(&pairs, harmonics, w0, self.states);
            let over = (reach[1] - reach[0]) * 0.5 / half;
            let over = over.max(fast / v).max(hard / a).max(1.0);
            // Between the sampled states the value may be slightly larger.
            let share = 0.99 / over;
            pairs.iter_mut().flatten().for_each(|value| *value *= share);
            let [bottom, top] = reach.map(|reach| reach * share);
            let middle = 0.5 * (low + high);
            let room = self.shares.position * 0.5 * (high - low);
            // Interval of the middle within which both ends stay in the joint range.
            let (first, last) = (middle - room - bottom, middle + room - top);
            let place = 0.5 + 0.5 * (1.2 * of[0]).tanh();
            let centre = first + (last - first) * place;
            // A joint with a wide range stays near its middle.
            offset.push(if high - low > MOST { middle + 0.5 * of[0] } else { centre });
            amplitude.push(pairs);
        }
        Series {
            base_frequency: self.settings.base_frequency,
            harmonics: harmonics.clone(),
            offset,
            amplitude,
        }
    }

    /// Size of the limit violations of a motion at `finer` times the states of the objective.
    pub(super) fn excess(&self, work: &mut Work<'_>, x: &DVector<f64>, finer: usize) -> f64 {
        let states = self.series(x).sampled(finer * self.states);
        let mut checked = check(self.model, &work.body, &self.settings.load, &states);
        checked.to_obstacles -= ROOM;
        checked.to_itself -= ROOM;
        checked.excess(&self.shares)
    }

    /// Objective: log det, less penalties of poor condition and of limit violations at `finer` times
    /// its states.
    fn value(&self, work: &mut Work<'_>, x: &DVector<f64>, penalty: f64, finer: usize) -> f64 {
        let states = self.series(x).sampled(self.states);
        told(work, x, &states) - penalty * self.excess(work, x, finer)
    }

    /// A motion of the same shape, reduced until it keeps all limits, if possible.
    pub(super) fn shrunk(&self, work: &mut Work<'_>, x: DVector<f64>) -> DVector<f64> {
        let count = self.per_joint();
        SIZES
            .iter()
            .map(|size| {
                DVector::from_fn(x.len(), |k, _| if k % count == 0 { x[k] } else { size * x[k] })
            })
            .find(|smaller| self.excess(work, smaller, FINER) == 0.0)
            .unwrap_or(x)
    }

    /// The motion, reduced until it keeps all limits at every millisecond.
    pub(super) fn repaired(&self, series: &Series) -> Option<Designed> {
        let mut work = Work::new(self);
        let mut series = series.clone();
        let fine = (series.period() / FINE).round() as usize;
        for _ in 0..REPAIRS {
            let states: Vec<State> = series.sampled(fine);
            let checked = check(self.model, &work.body, &self.settings.load, &states);
            if checked.excess(&self.shares) == 0.0 {
                let information = information(&work.normal.matrix(&states));
                return Some(Designed { series, information, checked });
            }
            series = series.scaled(SMALLER);
        }
        None
    }
}

/// log det less the penalty of a poor condition.
fn told(work: &mut Work<'_>, x: &DVector<f64>, states: &[State]) -> f64 {
    let normal = work.normal.matrix(states);
    let told = log_det(&normal).unwrap_or(-1e4);
    let poor = (condition(&normal) / GOOD).ln().max(0.0);
    // Very large variables give the same motion as smaller ones.
    let idle = 1e-3 * x.norm_squared();
    told - CONDITION * poor - idle
}

/// A joint with a wider range need not use all of it \[rad\].
const MOST: f64 = 6.0;

/// Least and largest value, largest rate and acceleration of a joint's series.
fn extremes(
    pairs: &[[f64; 2]],
    harmonics: &[usize],
    w0: f64,
    states: usize,
) -> ([f64; 2], f64, f64) {
    let (mut reach, mut fast, mut hard) = ([0.0_f64; 2], 0.0_f64, 0.0_f64);
    for i in 0..2 * states {
        let turn = std::f64::consts::TAU * i as f64 / (2 * states) as f64;
        let (mut q, mut qd, mut qdd) = (0.0, 0.0, 0.0);
        for (k, [a, b]) in harmonics.iter().zip(pairs) {
            let w = w0 * *k as f64;
            let (sin, cos) = (turn * *k as f64).sin_cos();
            q += a * sin + b * cos;
            qd += w * (a * cos - b * sin);
            qdd -= w * w * (a * sin + b * cos);
        }
        reach = [reach[0].min(q), reach[1].max(q)];
        fast = fast.max(qd.abs());
        hard = hard.max(qdd.abs());
    }
    (reach, fast, hard)
}

/// The condition number of W with columns of one length, from `WᵀW`.
fn condition(normal: &DMatrix<f64>) -> f64 {
    let lengths: Vec<f64> = normal.diagonal().iter().map(|x| x.sqrt().max(1e-150)).collect();
    let scaled = DMatrix::from_fn(normal.nrows(), normal.ncols(), |a, b| {
        normal[(a, b)] / (lengths[a] * lengths[b])
    });
    let values = scaled.symmetric_eigenvalues();
    (values.max() / values.min().max(1e-12)).sqrt()
}

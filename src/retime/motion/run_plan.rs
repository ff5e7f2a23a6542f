//! Plans the movements between two stop points.

use std::sync::Arc;

use super::controller::{Planning, motion_limits};
use super::late::within_limits;
use super::memo::{Key, Memo, key};
use super::pace::Pace;
use super::planner::plan;
use super::sampling::{Loaded, SpeedCap};
use super::stream::Stream;
use super::tcp_limits;
use super::timed::TimedMotion;
use crate::arm::dynamics::Load;
use crate::arm::robot::Model;
use crate::rapid::builtins::MoveForm;
use crate::rapid::ir::movement::{Movement, Settings};
use crate::retime::path::{Leg, LegKind, build};

/// Least `\T` that is planned, s: a much shorter one vanishes in the sum of the times, and the limits
/// lengthen it anyway.
const SHORTEST: f64 = 1e-6;

/// Planned runs that are kept at least: those of a long program, in some tens of megabytes.
const KEPT: usize = 1_000;

/// The motion of a run.
#[derive(Clone)]
pub(super) struct Planned {
    /// Motions with their start in the run, s.
    pub motions: Vec<(f64, TimedMotion)>,
    /// Duration of each movement (s) and the limit that determines it.
    pub pieces: Vec<(f64, Pace)>,
    /// Index of a leg and the problem on it.
    pub problem: Option<(usize, String)>,
    /// Time at rest before the next movement, s; the time of a timed movement includes it.
    pub settling_s: f64,
    /// The key of the run, if planned runs are kept.
    pub key: Option<Key>,
}

/// The last planned runs of a robot, for simulations of programs that differ little.
#[derive(Debug)]
pub struct Plans {
    model: Model,
    kept: Memo<Arc<Planned>>,
}

impl Plans {
    /// No planned runs.
    #[must_use]
    pub fn new(model: &Model) -> Plans {
        Plans { model: model.clone(), kept: Memo::new(KEPT) }
    }
}

/// A run that is not yet planned.
pub(super) struct RunDraft {
    pub(super) movements: Vec<Movement>,
    pub(super) task: RunTask,
}

/// All that the motion of a run depends on, besides the robot.
#[derive(Clone, Debug)]
pub(super) struct RunTask {
    pub(super) legs: Vec<Leg>,
    /// Programmed limits of the legs.
    caps: Vec<SpeedCap>,
    /// `\T` of the movements under the overrides, s.
    times: Vec<Option<f64>>,
    /// Whether all movements are `MoveAbsJ`.
    absolute: bool,
    pub(super) load: Load,
    /// Settings of the first movement.
    settings: Arc<Settings>,
}

impl RunDraft {
    /// A run of at least one movement, with the legs and `\T` (s, under the overrides) of the movements.
    pub(super) fn new(
        movements: Vec<Movement>,
        legs: Vec<Leg>,
        times: Vec<Option<f64>>,
        load: Load,
    ) -> RunDraft {
        let caps = legs.iter().zip(&movements).map(|(leg, movement)| cap(leg, movement)).collect();
        let absolute = movements.iter().all(|movement| movement.form == MoveForm::AbsJ);
        let settings = movements[0].settings.clone();
        RunDraft { task: RunTask { legs, caps, times, absolute, load, settings }, movements }
    }

    /// Keeps the first `count` movements; the robot stops after them.
    pub(super) fn truncated(mut self, count: usize) -> RunDraft {
        self.movements.truncate(count);
        self.task.legs.truncate(count);
        self.task.times.truncate(count);
        RunDraft::new(self.movements, self.task.legs, self.task.times, self.task.load)
    }
}

impl RunTask {
    /// The motion with a robot. It is not computed again where it is known.
    pub(super) fn plan(&self, model: &Model, known: Option<&Plans>) -> Planned {
        let Some(known) = known.filter(|known| known.model == *model) else {
            return self.motion(model);
        };
        let key = key(self);
        let planned = known.kept.get_or(key, || Arc::new(self.motion(model)));
        Planned { key: Some(key), ..(*planned).clone() }
    }

    fn motion(&self, model: &Model) -> Planned {
        let loaded = Loaded { model, load: &self.load };
        let planning = Planning::new(model, &self.settings);
        match self.as_stream() {
            Some(stream) => realise(loaded, stream, planning, self.settings.acceleration),
            None => self.plan_paths(loaded, planning),
        }
    }

    /// The stream of a run of timed `MoveAbsJ`, if all zones reach half the distance of their
    /// points.
    fn as_stream(&self) -> Option<Stream> {
        if !self.absolute {
            return None;
        }
        let planned = |time: &Option<f64>| time.map(|time| time.max(SHORTEST));
        let intervals: Option<Vec<f64>> = self.times.iter().map(planned).collect();
        // Distances between points only: the start position does not limit zones of later points.
        for pair in self.legs.windows(2) {
            let apart = pair[1].target.translation.vector - pair[0].target.translation.vector;
            if pair[0].zone.tcp < 0.5 * apart.norm() {
                return None;
            }
        }
        let points = self.legs.iter().map(|leg| leg.end).collect();
        Stream::new(self.legs[0].start, points, intervals?).ok()
    }

    fn plan_paths(&self, loaded: Loaded<'_>, planning: Planning) -> Planned {
        let RunTask { legs, caps, times, .. } = self;
        let model = loaded.model;
        // An early end needs a larger acceleration than the rest of the motion.
        let planning = if tcp_limits::limited(caps) { planning.complete() } else { planning };
        let limits = motion_limits(model);
        let mut pieces = vec![(0.0, Pace::None); legs.len()];
        let (paths, mut problem) = match build(model, legs) {
            Ok(paths) => (paths, None),
            Err(error) => {
                // Estimate the time by joint movements to the same points.
                let joint: Vec<Leg> =
                    legs.iter().map(|leg| Leg { kind: LegKind::Joint, ..leg.clone() }).collect();
                let hint = "its time is estimated joint by joint, the real one is longer";
                let problem = Some((error.leg(), format!("{error}; {hint}")));
                (build(model, &joint).unwrap_or_default(), problem)
            }
        };
        let mut motions = Vec::new();
        let mut t = 0.0;
        for path in paths {
            let path = Arc::new(path);
            let indices = path.legs();
            let (motion, paces) = match plan(loaded, &path, caps, &limits, &planning, times) {
                Ok(planned) => planned,
                Err(error) => {
                    problem = Some((indices.start, error.to_string()));
                    break;
                }
            };
            // Without space for a zone the robot stops as at a stop point.
            if let (Some(last), false) = (indices.start.checked_sub(1), motions.is_empty()) {
                let settling = settling_after(pieces[last].1, &planning);
                pieces[last].0 += settling;
                t += settling;
            }
            let mut before = 0.0;
            for (leg, pace) in indices.zip(paces) {
                let at = motion.time_at(path.leg_end(leg));
                pieces[leg].0 += at - before;
                pieces[leg].1 = pace;
                before = at;
            }
            let duration = motion.duration();
            motions.push((t, motion));
            t += duration;
        }
        if problem.is_some() {
            for (_, pace) in &mut pieces {
                *pace = Pace::Estimated;
            }
        }
        let settling_s = settling_after(pieces[pieces.len() - 1].1, &planning);
        Planned { motions, pieces, problem, settling_s, key: None }
    }
}

fn realise(loaded: Loaded<'_>, stream: Stream, planning: Planning, acceleration: f64) -> Planned {
    // Points that cannot be reached in time are reached late.
    let asked = stream.duration();
    let stream = within_limits(loaded, stream, acceleration);
    let pace = if stream.duration() > asked { Pace::Acceleration } else { Pace::Time };
    // The time of a point ends in the middle of its corner.
    let times = stream.knots().times();
    let count = stream.points().len();
    let pieces = (0..count).map(|i| {
        let end =
            if i + 1 == count { stream.duration() } else { 0.5 * (times[i + 1] + times[i + 2]) };
        let begin = if i == 0 { 0.0 } else { 0.5 * (times[i] + times[i + 1]) };
        (end - begin, pace)
    });
    let pieces = pieces.collect();
    // The stream model has no settling of its own: use that of other movements.
    let settling_s = if count > 1 { planning.settling_s } else { settling_after(pace, &planning) };
    let motions = vec![(0.0, TimedMotion::Stream(stream))];
    Planned { motions, pieces, problem: None, settling_s, key: None }
}

fn settling_after(pace: Pace, planning: &Planning) -> f64 {
    if pace == Pace::Time { 0.0 } else { planning.settling_s }
}

/// The speed cap of a movement; a timed one has no speed limit.
fn cap(leg: &Leg, movement: &Movement) -> SpeedCap {
    let settings = &movement.settings;
    let limits = SpeedCap {
        acceleration: settings.acceleration,
        path_acceleration: settings.path_acceleration,
        world_acceleration: settings.world_acceleration,
        ..SpeedCap::NONE
    };
    match movement.time {
        None => SpeedCap { tcp: leg.speed.tcp, orientation: leg.speed.orientation, ..limits },
        Some(_) => limits,
    }
}

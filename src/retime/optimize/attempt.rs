//! A stream near an intended motion: placed, fitted, polished and checked.

use super::check::Check;
use super::margins::Margins;
use super::polish_problem::PathPenalty;
use super::reason::Reason;
use super::run_plant::RunPlant;
use super::run_problem::RunProblem;
use super::stream_fit::{StreamFit, fit_stream};
use super::stream_polish::polish_stream;
use super::stream_reference::Reference;
use super::stream_rounding::{round_down, rounded_intervals, rounded_points};
use super::stream_spacing::{Spacing, adaptive_intervals};
use crate::arm::kinematics::fk;
use crate::retime::motion::stream::{LARGEST_ZONE, Stream};
use crate::retime::motion::timing::profile::Profile;
use crate::retime::path::joint_path::Joints;

/// Points of a stream, at least.
const LEAST_POINTS: usize = 2;
/// Acceleration of the TCP that a motion is expected to have between ceilings, m/s².
const EASING: f64 = 10.0;
/// Largest distance of two points, as a share of the reach of their zones.
const ZONE_SHARE: f64 = 0.95;
/// The share that is asked for where that is exceeded: other rules shift the points, too.
const CLOSER: f64 = 0.6;
/// Step of the samples of an intended motion, s.
const REFERENCE_STEP: f64 = 0.005;

/// A realised stream with its check.
pub(super) struct Attempt {
    pub(super) stream: Stream,
    pub(super) check: Check,
    /// The start for more polishing.
    pub(super) intended: Intended,
}

/// A motion on the path and a stream near it.
pub(super) struct Intended {
    reference: Reference,
    stream: Stream,
}

impl RunProblem<'_> {
    /// Where the margins leave no timing on the path, the polishing starts from the motion of the run
    /// itself, which keeps all limits and takes this time.
    pub(super) fn as_before(
        &self,
        reason: Reason,
        budget: f64,
        margins: &Margins,
    ) -> Result<Intended, Reason> {
        match self.task.run.motions.as_slice() {
            [(_, motion)]
                if reason == Reason::NoSaving && round_down(motion.duration()) <= budget =>
            {
                let state = |t: f64| (motion.at(t).q, motion.at(t).qd);
                self.intend_near(motion.duration(), &state, budget, margins)
            }
            _ => Err(reason),
        }
    }

    /// A stream of this duration fitted to a profile.
    pub(super) fn intend(
        &self,
        profile: &Profile,
        duration: f64,
        margins: &Margins,
    ) -> Result<Intended, Reason> {
        let end = profile.duration();
        let motion = |t: f64| {
            let (s, v, _) = if t < end { profile.at(t) } else { (self.path.length(), 0.0, 0.0) };
            let point = self.path.eval(s);
            (point.q, point.q1.map(|x| x * v))
        };
        self.intend_near(end, &motion, duration, margins)
    }

    /// A stream of this duration fitted to a motion that takes `time`, both in s.
    fn intend_near(
        &self,
        time: f64,
        motion: &dyn Fn(f64) -> (Joints, Joints),
        duration: f64,
        margins: &Margins,
    ) -> Result<Intended, Reason> {
        let failed = |why: &str| Reason::NoStream(why.to_owned());
        let samples = (time / REFERENCE_STEP).ceil().max(8.0) as usize;
        let reference =
            Reference::sample(time, samples, motion).map_err(|error| failed(&error.to_string()))?;
        let mut spacing = Spacing {
            shortest: self.task.spacing_s,
            closest: self.task.closest_s,
            longest: f64::INFINITY,
            tolerance: margins.spacing,
            polygon: margins.polygon,
            lever: self.lever,
        };
        let mut intervals = adaptive_intervals(&reference, duration, &spacing);
        let reach = self.zone_time(&reference, duration);
        if intervals.iter().any(|interval| *interval > ZONE_SHARE * reach) {
            spacing.longest = CLOSER * reach;
            intervals = adaptive_intervals(&reference, duration, &spacing);
        }
        // In the model of the controller a stop after a single point has no settling.
        if intervals.len() < LEAST_POINTS {
            let interval = duration / LEAST_POINTS as f64;
            if interval < self.task.spacing_s {
                return Err(failed("it is too short for two points"));
            }
            intervals = vec![interval; LEAST_POINTS];
        }
        let intervals = rounded_intervals(&intervals, duration);
        let fit = fit_stream(&reference, intervals, &self.limits, &self.lever)
            .map_err(|error| failed(&error.to_string()))?;
        match fit {
            StreamFit::Fitted(fitted) => Ok(Intended { reference, stream: fitted.stream }),
            StreamFit::TooFast { .. } => {
                Err(failed("speed, acceleration and jerk leave no stream in this time"))
            }
            StreamFit::Failed => Err(failed("the solver found no stream")),
        }
    }

    /// The stream polished, rounded as it will be emitted and checked.
    pub(super) fn realise(&self, intended: Intended, margins: &Margins) -> Result<Attempt, Reason> {
        let Intended { reference, stream } = intended;
        let plant = RunPlant {
            problem: self,
            margins,
            ceilings: self.corridor.eased(margins.reach, EASING),
        };
        let penalty = PathPenalty { tolerance: self.looseness(), lever: self.lever };
        let polished =
            polish_stream(&stream, &reference, &plant, &self.limits, &self.model, &penalty)
                .map_err(|error| Reason::NoStream(error.to_string()))?;
        let rounded = rounded_points(&polished.stream)
            .map_err(|error| Reason::NoStream(error.to_string()))?;
        let check = self.check(&rounded);
        let intended = Intended { reference, stream: polished.stream };
        Ok(Attempt { stream: rounded, check, intended })
    }

    /// Time in which the TCP goes no farther than the zones of two points reach, s.
    fn zone_time(&self, reference: &Reference, duration: f64) -> f64 {
        let tool = &self.task.run.legs[0].tool;
        let tcp = |t: f64| tool.pose(&fk(self.task.model, &reference.at(t).0)).translation.vector;
        let n = (reference.duration() / REFERENCE_STEP).ceil().max(1.0) as usize;
        let step = reference.duration() / n as f64;
        let farthest = (0..n)
            .map(|i| (tcp((i + 1) as f64 * step) - tcp(i as f64 * step)).norm())
            .fold(0.0, f64::max);
        let speed = farthest / step * (reference.duration() / duration);
        2.0 * LARGEST_ZONE / speed
    }
}

//! Fits a stream to a motion, polishes it and checks it.

use super::check::Check;
use super::margins::Margins;
use super::polish_problem::PathPenalty;
use super::reason::Reason;
use super::run_plant::RunPlant;
use super::run_problem::RunProblem;
use super::stream_fit::{StreamFit, fit_stream};
use super::stream_polish::{FAR, Until, polish_stream};
use super::stream_reference::Reference;
use super::stream_rounding::{round_down, rounded_intervals, rounded_points};
use super::stream_spacing::{Spacing, adaptive_intervals};
use crate::arm::kinematics::fk;
use crate::retime::motion::stream::{LARGEST_ZONE, Stream};
use crate::retime::motion::timing::profile::Profile;
use crate::retime::path::joint_path::Joints;

/// Smallest number of points of a stream.
const LEAST_POINTS: usize = 2;
/// Largest distance of two points, as a share of the length that their zones cover.
const ZONE_SHARE: f64 = 0.95;
/// The share that is used when [`ZONE_SHARE`] is exceeded; other rules move the points too.
const CLOSER: f64 = 0.6;
/// Sample step of a reference motion, s.
const REFERENCE_STEP: f64 = 0.005;

/// A rounded stream with its check.
pub(super) struct Attempt {
    pub(super) stream: Stream,
    pub(super) check: Check,
    /// Whether polishing came near its limits, with their margins.
    pub(super) near: bool,
    /// The unrounded stream, from which polishing may continue.
    pub(super) fit: Fit,
}

/// A reference motion and a stream that approximates it.
pub(super) struct Fit {
    reference: Reference,
    stream: Stream,
}

impl RunProblem<'_> {
    /// The original motion as the start of polishing, if the margins leave no timing on the path:
    /// it keeps all limits and takes this time.
    pub(super) fn fit_original(
        &self,
        reason: Reason,
        budget: f64,
        margins: &Margins,
    ) -> Result<Fit, Reason> {
        match self.task.run.motions.as_slice() {
            [(_, motion)]
                if reason == Reason::NoSaving && round_down(motion.duration()) <= budget =>
            {
                let state = |t: f64| (motion.at(t).q, motion.at(t).qd);
                self.fit_motion(motion.duration(), &state, budget, margins)
            }
            _ => Err(reason),
        }
    }

    /// A stream of this duration (s) fitted to a profile.
    pub(super) fn fit_profile(
        &self,
        profile: &Profile,
        duration: f64,
        margins: &Margins,
    ) -> Result<Fit, Reason> {
        let end = profile.duration();
        let motion = |t: f64| {
            let (s, v, _) = if t < end { profile.at(t) } else { (self.path.length(), 0.0, 0.0) };
            let point = self.path.eval(s);
            (point.q, point.q1.map(|x| x * v))
        };
        self.fit_motion(end, &motion, duration, margins)
    }

    /// A stream of this duration fitted to a motion that takes `time`, both in s.
    fn fit_motion(
        &self,
        time: f64,
        motion: &dyn Fn(f64) -> (Joints, Joints),
        duration: f64,
        margins: &Margins,
    ) -> Result<Fit, Reason> {
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
        // The controller model has no settling at a stop after a single point.
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
            StreamFit::Fitted(fitted) => Ok(Fit { reference, stream: fitted.stream }),
            StreamFit::TooFast { .. } => {
                Err(failed("speed, acceleration and jerk leave no stream in this time"))
            }
            StreamFit::Failed => Err(failed("the solver found no stream")),
        }
    }

    /// Polishes the stream, rounds its points to the digits of the emitted code and checks it.
    pub(super) fn realise(
        &self,
        fit: Fit,
        margins: &Margins,
        until: Until,
    ) -> Result<Attempt, Reason> {
        let Fit { reference, stream } = fit;
        let plant =
            RunPlant { problem: self, margins, smoothed: self.corridor.smoothed(margins.reach) };
        let penalty = PathPenalty { tolerance: self.free_distance(), lever: self.lever };
        let (limits, model) = (&self.limits, &self.model);
        let polished = polish_stream(&stream, &reference, &plant, limits, model, &penalty, until)
            .map_err(|error| Reason::NoStream(error.to_string()))?;
        let rounded = rounded_points(&polished.stream)
            .map_err(|error| Reason::NoStream(error.to_string()))?;
        let check = self.check(&rounded);
        let fit = Fit { reference, stream: polished.stream };
        let near = polished.realised.excess <= FAR;
        Ok(Attempt { stream: rounded, check, near, fit })
    }

    /// Time in which the TCP travels at most the length that the zones of two points cover, s.
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

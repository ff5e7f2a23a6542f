//! Timed joint motions: a path with its timing, or a stream.

use std::sync::Arc;

use super::averaged::Averaged;
pub use super::joint_state::JointState;
use super::stream::Stream;
use crate::retime::path::JointPath;
use crate::retime::path::joint_path::Joints;

/// A motion from rest to rest.
#[derive(Clone, Debug)]
pub enum TimedMotion {
    /// Along a path with its timing.
    Path(Arc<JointPath>, Box<Averaged>),
    /// A stream of timed points.
    Stream(Stream),
}

impl TimedMotion {
    /// Duration, s.
    pub fn duration(&self) -> f64 {
        match self {
            TimedMotion::Path(_, timing) => timing.duration(),
            TimedMotion::Stream(stream) => stream.duration(),
        }
    }

    /// The state at `t` after the start; outside the motion at rest at the nearer end.
    pub fn at(&self, t: f64) -> JointState {
        match self {
            TimedMotion::Path(_, timing) => timing.at(t),
            TimedMotion::Stream(stream) => {
                let (q, qd, qdd) = stream.eval(t);
                JointState { q, qd, qdd }
            }
        }
    }

    /// Joint velocities at `t`, rad/s.
    pub fn rates(&self, t: f64) -> Joints {
        match self {
            TimedMotion::Path(_, timing) => timing.rates(t),
            TimedMotion::Stream(stream) => stream.eval(t).1,
        }
    }

    /// Times between which the motion is smooth, from 0 to the duration.
    pub fn knots(&self) -> &[f64] {
        match self {
            TimedMotion::Path(_, timing) => timing.knots(),
            TimedMotion::Stream(stream) => stream.knots().times(),
        }
    }

    /// The time at which a path motion passes s; 0 for a stream.
    pub fn time_at(&self, s: f64) -> f64 {
        match self {
            TimedMotion::Path(path, timing) if s >= path.length() => timing.duration(),
            TimedMotion::Path(_, timing) => timing.time_at(s),
            TimedMotion::Stream(_) => 0.0,
        }
    }
}

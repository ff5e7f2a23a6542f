//! Timed joint motions: a path with its timing, or a stream.

use std::sync::Arc;

use super::smooth::Cubic;
use super::stream::Stream;
use crate::path::JointPath;
use crate::path::joint_path::{DOF, Joints};

/// q, q̇, q̈ at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointState {
    /// rad.
    pub q: Joints,
    /// rad/s.
    pub qd: Joints,
    /// rad/s².
    pub qdd: Joints,
}

impl JointState {
    /// Standing at `q`.
    pub fn rest(q: Joints) -> JointState {
        JointState { q, qd: [0.0; DOF], qdd: [0.0; DOF] }
    }
}

/// A motion from rest to rest.
#[derive(Clone, Debug)]
pub enum TimedMotion {
    /// Along a path with s(t) in stretches of constant jerk.
    Path(Arc<JointPath>, Vec<Cubic>),
    /// A stream of timed points.
    Stream(Stream),
}

impl TimedMotion {
    /// s.
    pub fn duration(&self) -> f64 {
        match self {
            TimedMotion::Path(_, pieces) => pieces.last().map_or(0.0, |p| p.t + p.duration),
            TimedMotion::Stream(stream) => stream.duration(),
        }
    }

    /// The state at `t` after the start; outside, at rest at the nearer end.
    pub fn at(&self, t: f64) -> JointState {
        match self {
            TimedMotion::Path(path, pieces) => {
                if t <= 0.0 {
                    return JointState::rest(path.eval(0.0).q);
                }
                if t >= self.duration() {
                    return JointState::rest(path.eval(path.length()).q);
                }
                let after = pieces.partition_point(|p| p.t <= t);
                let piece = &pieces[after.saturating_sub(1)];
                on_path(path, piece.at(t - piece.t))
            }
            TimedMotion::Stream(stream) => {
                let (q, qd, qdd) = stream.eval(t);
                JointState { q, qd, qdd }
            }
        }
    }

    /// Times between which every joint moves smoothly, from 0 to the duration.
    pub fn knots(&self) -> Vec<f64> {
        match self {
            TimedMotion::Path(path, pieces) => {
                let mut knots: Vec<f64> = pieces.iter().map(|p| p.t).collect();
                knots.push(self.duration());
                let mut at = 0;
                for piece in path.pieces().iter().skip(1) {
                    while pieces.get(at + 1).is_some_and(|p| p.state[0] <= piece.s) {
                        at += 1;
                    }
                    if let Some(cubic) = pieces.get(at) {
                        knots.push(cubic.t + time_of(cubic, piece.s));
                    }
                }
                knots.sort_by(f64::total_cmp);
                knots.dedup();
                knots
            }
            TimedMotion::Stream(stream) => stream.knots().times().to_vec(),
        }
    }

    /// ṡ of a path motion at `t`; of a stream, 0.
    pub fn path_speed(&self, t: f64) -> f64 {
        match self {
            TimedMotion::Path(_, pieces) => {
                let after = pieces.partition_point(|p| p.t <= t);
                pieces.get(after.saturating_sub(1)).map_or(0.0, |p| p.at(t - p.t)[1].max(0.0))
            }
            TimedMotion::Stream(_) => 0.0,
        }
    }

    /// The time at which a path motion passes s; of a stream, 0.
    pub fn time_at(&self, s: f64) -> f64 {
        match self {
            TimedMotion::Path(path, pieces) => {
                if s >= path.length() {
                    return self.duration();
                }
                let after = pieces.partition_point(|p| p.state[0] <= s);
                match pieces.get(after.saturating_sub(1)) {
                    Some(cubic) if after > 0 => cubic.t + time_of(cubic, s),
                    _ => 0.0,
                }
            }
            TimedMotion::Stream(_) => 0.0,
        }
    }
}

fn on_path(path: &JointPath, [s, v, a]: [f64; 3]) -> JointState {
    let p = path.eval(s);
    JointState {
        q: p.q,
        qd: p.q1.map(|x| x * v),
        qdd: std::array::from_fn(|j| p.q1[j] * a + p.q2[j] * v * v),
    }
}

/// When a stretch passes s, by bisection: s(t) grows.
fn time_of(cubic: &Cubic, s: f64) -> f64 {
    const HALVINGS: u32 = 60;
    let (mut low, mut high) = (0.0, cubic.duration);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if cubic.at(middle)[0] < s { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

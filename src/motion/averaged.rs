//! Jerk limitation: the joints follow a moving average of a motion along a path.
//!
//! q̄(t) = (1/w) ∫ q over the last w seconds, so q̄̇ = (q(t) − q(t−w))/w and q̄̈ = (q̇(t) − q̇(t−w))/w.
//! The acceleration changes by at most twice its limit in w, the motion takes w longer, and
//! what bounds joint velocity and acceleration before bounds them after. Averaging the joints and
//! not the place on the path lets the motion cut corners by the more the faster it passes them,
//! which runs of an IRC5 show (docs/controller.md).

use super::timing::profile::Profile;
use crate::path::JointPath;
use crate::path::joint_path::{DOF, Joints, PathPoint};

use super::timed::JointState;

/// Gauss-Legendre with four points on [0, 1]: exact up to degree 7. On a stretch without
/// acceleration the joints are of degree 5.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// The timing of a path: a speed profile and the window over which the joints are averaged.
#[derive(Clone, Debug)]
pub struct Averaged {
    profile: Profile,
    window: f64,
    /// Times between which the joints before averaging are polynomials, s.
    knots: Vec<f64>,
    /// ∫ q from the start to each of these times, rad s.
    integral: Vec<Joints>,
}

impl Averaged {
    /// The path run by `profile`, averaged over `window` (s, positive or 0).
    pub fn new(path: &JointPath, profile: Profile, window: f64) -> Averaged {
        let mut knots: Vec<f64> = profile.times().to_vec();
        let mut at = 0;
        for piece in path.pieces().iter().skip(1) {
            while profile.s().get(at + 1).is_some_and(|s| *s <= piece.s) {
                at += 1;
            }
            knots.push(profile.time_in(at, piece.s));
        }
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        let mut averaged = Averaged { profile, window, knots, integral: Vec::new() };
        let mut sum = [0.0; DOF];
        let mut integral = vec![sum];
        for pair in averaged.knots.windows(2) {
            let part = averaged.stretch(path, pair[0], pair[1]);
            sum = std::array::from_fn(|j| sum[j] + part[j]);
            integral.push(sum);
        }
        averaged.integral = integral;
        averaged
    }

    /// The speed profile before averaging.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// s.
    pub fn duration(&self) -> f64 {
        self.profile.duration() + self.window
    }

    /// When the motion is nearest to the place s of the path, s from its start.
    pub fn time_at(&self, s: f64) -> f64 {
        self.profile.time_at(s) + 0.5 * self.window
    }

    /// The state at `t`; outside, at rest at the nearer end.
    pub fn at(&self, path: &JointPath, t: f64) -> JointState {
        if t <= 0.0 {
            return JointState::rest(path.eval(0.0).q);
        }
        if t >= self.duration() {
            return JointState::rest(path.eval(path.length()).q);
        }
        if self.window == 0.0 {
            let (s, v, a) = self.profile.at(t);
            let p = path.eval(s);
            let qdd = std::array::from_fn(|j| p.q1[j] * a + p.q2[j] * v * v);
            return JointState { q: p.q, qd: p.q1.map(|x| x * v), qdd };
        }
        let w = self.window;
        let (now, before) = (self.source(path, t), self.source(path, t - w));
        let (sum, sum_before) = (self.sum(path, t), self.sum(path, t - w));
        JointState {
            q: std::array::from_fn(|j| (sum[j] - sum_before[j]) / w),
            qd: std::array::from_fn(|j| (now.0[j] - before.0[j]) / w),
            qdd: std::array::from_fn(|j| (now.1[j] - before.1[j]) / w),
        }
    }

    /// Times between which every joint moves smoothly, from 0 to the duration.
    pub fn knots(&self) -> Vec<f64> {
        let mut knots = self.knots.clone();
        if self.window > 0.0 {
            knots.extend(self.knots.iter().map(|t| t + self.window));
            knots.sort_by(f64::total_cmp);
            knots.dedup();
        }
        knots
    }

    /// q and q̇ before averaging.
    fn source(&self, path: &JointPath, t: f64) -> (Joints, Joints) {
        let (s, v, _) = self.profile.at(t);
        let PathPoint { q, q1, .. } = path.eval(s);
        (q, q1.map(|x| x * v))
    }

    /// ∫ q from 0 to t, rad s.
    fn sum(&self, path: &JointPath, t: f64) -> Joints {
        if t <= 0.0 {
            return path.eval(0.0).q.map(|q| q * t);
        }
        let last = self.knots.len() - 1;
        if t >= self.knots[last] {
            let rest = t - self.knots[last];
            let end = path.eval(path.length()).q;
            return std::array::from_fn(|j| self.integral[last][j] + end[j] * rest);
        }
        let k = self.knots.partition_point(|knot| *knot <= t) - 1;
        let part = self.stretch(path, self.knots[k], t);
        std::array::from_fn(|j| self.integral[k][j] + part[j])
    }

    /// ∫ q between two times of one stretch, rad s.
    fn stretch(&self, path: &JointPath, from: f64, to: f64) -> Joints {
        let h = to - from;
        let mut sum = [0.0; DOF];
        for (x, weight) in GAUSS {
            let (s, _, _) = self.profile.at(from + h * x);
            let q = path.eval(s).q;
            for j in 0..DOF {
                sum[j] += h * weight * q[j];
            }
        }
        sum
    }
}

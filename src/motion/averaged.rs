//! Jerk limitation: the joints follow a moving average of a motion along a path.
//!
//! With a step density h of length w, q̄(t) = ∫ h(τ) q(t−τ) dτ. Between its edges h is constant, so
//! q̄, q̄̇ and q̄̈ are sums over the edges of ∫ q, q and q̇. The acceleration builds up in w, the
//! motion takes w longer, and what bounds joint velocity and acceleration before bounds them
//! after. Averaging the joints and not the place on the path lets the motion cut corners by the
//! more the faster it passes them, which runs of an IRC5 show (docs/controller.md).
//!
//! When the motion before averaging has ended, a polynomial of degree 5 brings the joints to rest
//! a little earlier than the average would.

use super::controller::Average;
use super::timed::JointState;
use super::timing::profile::Profile;
use crate::path::JointPath;
use crate::path::joint_path::{DOF, Joints, PathPoint};

/// Gauss-Legendre with four points on [0, 1]: exact up to degree 7. On a stretch without
/// acceleration the joints are of degree 5.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// The timing of a path: a speed profile, averaged over time.
#[derive(Clone, Debug)]
pub struct Averaged {
    profile: Profile,
    window: f64,
    /// Edges of the steps of the average as delays (s), with the changes of its density there
    /// (1/s): q̄ = Σ c ∫ q up to t − delay.
    edges: [(f64, f64); 4],
    /// Times between which the joints before averaging are polynomials, s.
    knots: Vec<f64>,
    /// ∫ q from the start to each of these times, rad s.
    integral: Vec<Joints>,
    /// The end of the motion, from where the motion before averaging has ended.
    closing: Closing,
}

/// A polynomial of degree 5 per joint that brings the robot to rest.
#[derive(Clone, Debug)]
struct Closing {
    begin: f64,
    length: f64,
    /// Coefficients of (t − begin), lowest first.
    coefficients: [[f64; 6]; DOF],
}

impl Averaged {
    /// The path run by `profile`, averaged.
    pub fn new(path: &JointPath, profile: Profile, average: Average) -> Averaged {
        let Average { window, core, closing } = average;
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
        let begin = profile.duration();
        let (side, middle) = ((1.0 - core) / window, (1.0 + core) / window);
        let mut averaged = Averaged {
            profile,
            window,
            edges: [
                (0.0, side),
                (0.25 * window, middle - side),
                (0.75 * window, side - middle),
                (window, -side),
            ],
            knots,
            integral: Vec::new(),
            closing: Closing { begin, length: 0.0, coefficients: [[0.0; 6]; DOF] },
        };
        let mut sum = [0.0; DOF];
        let mut integral = vec![sum];
        for pair in averaged.knots.windows(2) {
            let part = averaged.stretch(path, pair[0], pair[1]);
            sum = std::array::from_fn(|j| sum[j] + part[j]);
            integral.push(sum);
        }
        averaged.integral = integral;
        if window > 0.0 {
            let from = averaged.average(path, begin);
            let end = path.eval(path.length()).q;
            averaged.closing = Closing::new(begin, window - closing, &from, &end);
        }
        averaged
    }

    /// The speed profile before averaging.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// s.
    pub fn duration(&self) -> f64 {
        self.closing.begin + self.closing.length
    }

    /// When the motion is nearest to the place s of the path, s from its start.
    pub fn time_at(&self, s: f64) -> f64 {
        (self.profile.time_at(s) + 0.5 * self.window).min(self.duration())
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
        if t >= self.closing.begin {
            return self.closing.at(t);
        }
        self.average(path, t)
    }

    fn average(&self, path: &JointPath, t: f64) -> JointState {
        let mut state = JointState::rest([0.0; DOF]);
        for (delay, c) in self.edges {
            let (q, qd) = self.source(path, t - delay);
            let sum = self.sum(path, t - delay);
            for j in 0..DOF {
                state.q[j] += c * sum[j];
                state.qd[j] += c * q[j];
                state.qdd[j] += c * qd[j];
            }
        }
        state
    }

    /// Times between which every joint moves smoothly, from 0 to the duration.
    pub fn knots(&self) -> Vec<f64> {
        let mut knots = self.knots.clone();
        if self.window > 0.0 {
            for (delay, _) in &self.edges[1..] {
                knots.extend(self.knots.iter().map(|t| t + delay));
            }
            knots.retain(|t| *t < self.closing.begin);
            knots.extend([self.closing.begin, self.duration()]);
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

impl Closing {
    /// From a state to rest at `end` in `length` seconds.
    fn new(begin: f64, length: f64, from: &JointState, end: &Joints) -> Closing {
        let h = length;
        let coefficients = std::array::from_fn(|j| {
            let (v, a) = (from.qd[j] * h, from.qdd[j] * h * h);
            let d = end[j] - from.q[j];
            let unit = [
                from.q[j],
                v,
                0.5 * a,
                10.0 * d - 6.0 * v - 1.5 * a,
                -15.0 * d + 8.0 * v + 1.5 * a,
                6.0 * d - 3.0 * v - 0.5 * a,
            ];
            std::array::from_fn(|k| unit[k] / h.powi(k as i32))
        });
        Closing { begin, length, coefficients }
    }

    fn at(&self, t: f64) -> JointState {
        let x = t - self.begin;
        let mut state = JointState::rest([0.0; DOF]);
        for j in 0..DOF {
            let [c0, c1, c2, c3, c4, c5] = self.coefficients[j];
            state.q[j] = c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))));
            state.qd[j] = c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)));
            state.qdd[j] = 2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5));
        }
        state
    }
}

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

/// Change of the path's acceleration, share of its largest, that makes a kink worth a knot.
const KINK: f64 = 0.02;

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
    /// Between two of them: the interval of the profile and the piece of the path.
    stretches: Vec<(u32, u32)>,
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
        let (knots, stretches) = stretches(path, &profile);
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
            stretches,
            integral: Vec::new(),
            closing: Closing { begin, length: 0.0, coefficients: [[0.0; 6]; DOF] },
        };
        let mut sum = [0.0; DOF];
        let mut integral = vec![sum];
        for k in 0..averaged.stretches.len() {
            let part = averaged.stretch(path, k, averaged.knots[k + 1]);
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
            let source = self.source(path, t - delay);
            for j in 0..DOF {
                state.q[j] += c * source.sum[j];
                state.qd[j] += c * source.q[j];
                state.qdd[j] += c * source.qd[j];
            }
        }
        state
    }

    /// Times between which the joints move smoothly, from 0 to the duration: where the
    /// acceleration before averaging changes by a share that counts, and that time later.
    pub fn knots(&self) -> Vec<f64> {
        let pieces: Vec<f64> = self.profile.pieces().map(|piece| piece.acceleration).collect();
        let largest = pieces.iter().fold(0.0, |max: f64, a| max.max(a.abs()));
        let mut knots = vec![0.0];
        for (pair, t) in pieces.windows(2).zip(&self.profile.times()[1..]) {
            if (pair[1] - pair[0]).abs() > KINK * largest {
                knots.push(*t);
            }
        }
        knots.push(self.profile.duration());
        if self.window > 0.0 {
            let source = knots.clone();
            for (delay, _) in &self.edges[1..] {
                knots.extend(source.iter().map(|t| t + delay));
            }
            knots.retain(|t| *t < self.closing.begin);
            knots.extend([self.closing.begin, self.duration()]);
            knots.sort_by(f64::total_cmp);
            knots.dedup();
        }
        knots
    }

    /// The motion before averaging.
    fn source(&self, path: &JointPath, t: f64) -> Source {
        let last = self.knots.len() - 1;
        if t <= 0.0 {
            let q = path.eval(0.0).q;
            return Source { sum: q.map(|q| q * t), q, qd: [0.0; DOF] };
        }
        if t >= self.knots[last] {
            let q = path.eval(path.length()).q;
            let rest = t - self.knots[last];
            let sum = std::array::from_fn(|j| self.integral[last][j] + q[j] * rest);
            return Source { sum, q, qd: [0.0; DOF] };
        }
        let k = self.knots.partition_point(|knot| *knot <= t) - 1;
        let part = self.stretch(path, k, t);
        let (interval, piece) = self.stretches[k];
        let (s, v, _) = self.profile.in_interval(interval as usize, t);
        let PathPoint { q, q1, .. } = path.pieces()[piece as usize].eval(s);
        Source {
            sum: std::array::from_fn(|j| self.integral[k][j] + part[j]),
            q,
            qd: q1.map(|x| x * v),
        }
    }

    /// ∫ q from the begin of a stretch to a time in it, rad s.
    fn stretch(&self, path: &JointPath, k: usize, to: f64) -> Joints {
        let (interval, piece) = self.stretches[k];
        let piece = &path.pieces()[piece as usize];
        let from = self.knots[k];
        let h = to - from;
        let mut sum = [0.0; DOF];
        for (x, weight) in GAUSS {
            let (s, _, _) = self.profile.in_interval(interval as usize, from + h * x);
            let q = piece.position(s);
            for j in 0..DOF {
                sum[j] += h * weight * q[j];
            }
        }
        sum
    }
}

/// The times at which the profile passes its nodes and the ends of the path's pieces, and between
/// them the interval of the profile and the piece of the path.
fn stretches(path: &JointPath, profile: &Profile) -> (Vec<f64>, Vec<(u32, u32)>) {
    let (s, pieces) = (profile.s(), path.pieces());
    let (mut interval, mut piece) = (0, 0);
    let mut knots = vec![0.0];
    let mut stretches = Vec::with_capacity(s.len() + pieces.len());
    while interval + 1 < s.len() && piece < pieces.len() {
        stretches.push((interval as u32, piece as u32));
        let (node, end) = (s[interval + 1], pieces[piece].s + pieces[piece].length);
        let last = piece + 1 == pieces.len();
        if node <= end || last {
            knots.push(profile.times()[interval + 1]);
            interval += 1;
            if node == end && !last {
                piece += 1;
            }
        } else {
            knots.push(profile.time_in(interval, end));
            piece += 1;
        }
    }
    (knots, stretches)
}

/// q, q̇ and ∫ q from the start, at a time before averaging.
struct Source {
    q: Joints,
    qd: Joints,
    sum: Joints,
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
            let mut scale = 1.0;
            unit.map(|c| {
                let scaled = c / scale;
                scale *= h;
                scaled
            })
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

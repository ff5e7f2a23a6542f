//! Jerk limitation: the joint angles are a moving average of a motion along a path.
//!
//! With a step density h of length w, q̄(t) = ∫ h(τ) q(t−τ) dτ. Between its edges h is constant, so
//! q̄, q̄̇ and q̄̈ are sums over the edges of ∫ q, q and q̇. The acceleration rises within w, the
//! motion takes w longer, and bounds of joint velocity and acceleration remain valid. Since the
//! joint angles are averaged and not s, the motion cuts corners, more so at high speed, as runs of
//! an IRC5 show (docs/controller.md).
//!
//! After the end of the unaveraged motion a quintic brings the joints to rest, slightly earlier
//! than the average would.

use super::controller::Average;
use super::joint_state::JointState;
use super::quintics::Quintics;
use super::timing::profile::Profile;
use crate::retime::path::JointPath;
use crate::retime::path::joint_path::{DOF, Joints, Piece};

/// Four-point Gauss–Legendre rule on [0, 1], exact to degree 7. Without path acceleration the joint
/// angles have degree 5.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Jump of the path acceleration at which a knot is set, as a share of the largest acceleration.
const KINK: f64 = 0.02;

/// Joint speed (rad/s) and acceleration (rad/s²) at rounding level: the sign of such a speed must
/// not cause Coulomb friction.
const STILL: f64 = 1e-9;

/// Error in the middle of a polynomial above which its interval is halved, rad: the same as for the
/// pieces of the path.
const STRETCH_TOLERANCE: f64 = 2e-7;
/// Largest number of halvings.
const HALVINGS: usize = 6;

/// The timing of a path: a speed profile, averaged over time.
#[derive(Clone, Debug)]
pub struct Averaged {
    profile: Profile,
    window: f64,
    /// Edges of the density as delays (s) with the changes of the density there (1/s):
    /// q̄ = Σ c ∫ q up to t − delay.
    edges: [(f64, f64); 4],
    /// Joints at both ends, rad.
    ends: [Joints; 2],
    /// ∫ (q − q₀) of the unaveraged motion, rad s, in order of time.
    stretches: Vec<Quintics>,
    /// Start times of the stretches, s.
    begins: Vec<f64>,
    /// The integral at the end of the unaveraged motion, rad s.
    integral: Joints,
    /// Times between which the motion is smooth, s.
    knots: Vec<f64>,
    /// The motion after the end of the unaveraged motion.
    closing: Quintics,
    /// Duration, s.
    duration: f64,
}

impl Averaged {
    /// The average of the motion along the path with `profile`.
    pub fn new(path: &JointPath, profile: Profile, average: Average) -> Averaged {
        let Average { window, core, closing } = average;
        let begin = profile.duration();
        let (side, middle) = ((1.0 - core) / window, (1.0 + core) / window);
        let ends = [path.start(), path.end()];
        let (stretches, integral) = stretches(path, &profile);
        let rest = [ends[1], [0.0; DOF], [0.0; DOF]];
        let mut averaged = Averaged {
            profile,
            window,
            edges: [
                (0.0, side),
                (0.25 * window, middle - side),
                (0.75 * window, side - middle),
                (window, -side),
            ],
            ends,
            begins: stretches.iter().map(Quintics::begin).collect(),
            stretches,
            integral,
            knots: Vec::new(),
            closing: Quintics::new(begin, 1.0, rest, rest),
            duration: begin,
        };
        if window > 0.0 {
            let JointState { q, qd, qdd } = averaged.average(begin);
            averaged.closing = Quintics::new(begin, window - closing, [q, qd, qdd], rest);
            averaged.duration += window - closing;
        }
        averaged.knots = averaged.smooth_between();
        averaged
    }

    /// Duration, s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Time at which the motion is nearest to s of the path, s.
    pub fn time_at(&self, s: f64) -> f64 {
        (self.profile.time_at(s) + 0.5 * self.window).min(self.duration())
    }

    /// The state at `t`; outside the motion at rest at the nearer end.
    pub fn at(&self, t: f64) -> JointState {
        if t <= 0.0 {
            return JointState::rest(self.ends[0]);
        }
        if t >= self.duration {
            return JointState::rest(self.ends[1]);
        }
        if self.window == 0.0 {
            return self.unaveraged(t);
        }
        if t >= self.closing.begin() {
            let [q, qd, qdd] = self.closing.at(t);
            return JointState { q, qd, qdd };
        }
        self.average(t)
    }

    fn average(&self, t: f64) -> JointState {
        let mut state = JointState::rest(self.ends[0]);
        for (delay, c) in self.edges {
            let [sum, q, qd] = self.source(t - delay);
            for j in 0..DOF {
                state.q[j] += c * sum[j];
                state.qd[j] += c * q[j];
                state.qdd[j] += c * qd[j];
            }
        }
        for (qd, qdd) in state.qd.iter_mut().zip(&mut state.qdd) {
            if qd.abs() < STILL && qdd.abs() < STILL {
                (*qd, *qdd) = (0.0, 0.0);
            }
        }
        state
    }

    /// Joint velocities at `t`, rad/s, as in [`Averaged::at`].
    pub fn rates(&self, t: f64) -> Joints {
        if t <= 0.0 || t >= self.duration || self.window == 0.0 || t >= self.closing.begin() {
            return self.at(t).qd;
        }
        let mut qd = [0.0; DOF];
        for (delay, c) in self.edges {
            let q = self.displacement(t - delay);
            for j in 0..DOF {
                qd[j] += c * q[j];
            }
        }
        qd.map(|qd| if qd.abs() < STILL { 0.0 } else { qd })
    }

    /// q − q₀ of the unaveraged motion.
    fn displacement(&self, t: f64) -> Joints {
        if t <= 0.0 {
            [0.0; DOF]
        } else if t >= self.profile.duration() {
            std::array::from_fn(|j| self.ends[1][j] - self.ends[0][j])
        } else {
            self.stretch(t).first(t)
        }
    }

    fn unaveraged(&self, t: f64) -> JointState {
        let stretch = self.stretch(t);
        let [_, q, qd] = stretch.at(t);
        let q = std::array::from_fn(|j| self.ends[0][j] + q[j]);
        JointState { q, qd, qdd: stretch.third(t) }
    }

    fn stretch(&self, t: f64) -> &Quintics {
        let after = self.begins.partition_point(|begin| *begin <= t);
        &self.stretches[after.saturating_sub(1)]
    }

    /// Times between which the motion is smooth, from 0 to the duration, s.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Times at which the unaveraged acceleration jumps by more than [`KINK`], and these times
    /// delayed by the edges of the density.
    fn smooth_between(&self) -> Vec<f64> {
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
            let begin = self.closing.begin();
            knots.retain(|t| *t < begin);
            knots.extend([begin, self.duration]);
            knots.sort_by(f64::total_cmp);
            knots.dedup();
        }
        knots
    }

    /// ∫ (q − q₀), q − q₀ and q̇ of the unaveraged motion.
    #[inline]
    fn source(&self, t: f64) -> [Joints; 3] {
        if t <= 0.0 {
            return [[0.0; DOF]; 3];
        }
        let rest = t - self.profile.duration();
        if rest >= 0.0 {
            let q: Joints = std::array::from_fn(|j| self.ends[1][j] - self.ends[0][j]);
            let sum = std::array::from_fn(|j| self.integral[j] + q[j] * rest);
            return [sum, q, [0.0; DOF]];
        }
        self.stretch(t).at(t)
    }
}

/// ∫ (q − q₀) as polynomials between the times of the profile nodes and of the ends of the path
/// pieces, and its value at the end.
fn stretches(path: &JointPath, profile: &Profile) -> (Vec<Quintics>, Joints) {
    let (s, pieces) = (profile.s(), path.pieces());
    let (mut interval, mut piece) = (0, 0);
    let mut stretches = Stretches {
        profile,
        start: path.start(),
        sum: [0.0; DOF],
        done: Vec::with_capacity(s.len() + pieces.len()),
    };
    let mut begin = 0.0;
    while interval + 1 < s.len() && piece < pieces.len() {
        let (node, end) = (s[interval + 1], pieces[piece].s + pieces[piece].length);
        let last = piece + 1 == pieces.len();
        let (at, piece_before) = (interval, &pieces[piece]);
        let until = if node <= end || last {
            interval += 1;
            if node == end && !last {
                piece += 1;
            }
            profile.times()[interval]
        } else {
            piece += 1;
            profile.time_in(interval, end)
        };
        if until > begin {
            stretches.add(piece_before, at, (begin, until), HALVINGS);
            begin = until;
        }
    }
    (stretches.done, stretches.sum)
}

struct Stretches<'a> {
    profile: &'a Profile,
    start: Joints,
    sum: Joints,
    done: Vec<Quintics>,
}

impl Stretches<'_> {
    /// Adds the time from `begin` to `end` on one piece and one interval of the profile.
    fn add(&mut self, piece: &Piece, interval: usize, (begin, end): (f64, f64), halvings: usize) {
        let h = end - begin;
        let mut sum = self.sum;
        for (x, weight) in GAUSS {
            let (s, _, _) = self.profile.in_interval(interval, begin + h * x);
            let q = piece.position(s);
            for j in 0..DOF {
                sum[j] += h * weight * (q[j] - self.start[j]);
            }
        }
        let [from, to] = [begin, end].map(|t| {
            let (s, v, _) = self.profile.in_interval(interval, t);
            let at = piece.eval(s);
            let q: Joints = std::array::from_fn(|j| at.q[j] - self.start[j]);
            [q, at.q1.map(|x| x * v)]
        });
        let stretch = Quintics::new(begin, h, [self.sum, from[0], from[1]], [sum, to[0], to[1]]);
        let middle = begin + 0.5 * h;
        if halvings > 0 {
            let q = piece.position(self.profile.in_interval(interval, middle).0);
            let got = stretch.at(middle)[1];
            if (0..DOF).any(|j| (got[j] + self.start[j] - q[j]).abs() > STRETCH_TOLERANCE) {
                self.add(piece, interval, (begin, middle), halvings - 1);
                self.add(piece, interval, (middle, end), halvings - 1);
                return;
            }
        }
        self.done.push(stretch);
        self.sum = sum;
    }
}

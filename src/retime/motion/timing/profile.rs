//! A speed profile on a path: b = ṡ² at the nodes, linear in s between them.
//!
//! Between two nodes the path acceleration u = (b₁ − b₀)/(2 Δs) is constant, so the time of an
//! interval is 2 Δs/(√b₀ + √b₁).

/// A profile with the times at the nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    s: Vec<f64>,
    b: Vec<f64>,
    t: Vec<f64>,
}

/// One interval of a profile, which has constant path acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfilePiece {
    /// ṡ at the start.
    pub speed: f64,
    /// s̈.
    pub acceleration: f64,
    /// Duration, s.
    pub duration: f64,
}

impl Profile {
    /// The profile with `b` = ṡ² at the nodes `s`. None if lengths differ, there are fewer than
    /// two nodes, a value is negative or not finite, or both ends of an interval are at rest.
    pub fn new(s: Vec<f64>, b: Vec<f64>) -> Option<Profile> {
        let positive = b.iter().all(|x| x.is_finite() && *x >= 0.0);
        if s.len() != b.len() || s.len() < 2 || !positive {
            return None;
        }
        let mut t = vec![0.0];
        let mut now = 0.0;
        for k in 1..s.len() {
            now += 2.0 * (s[k] - s[k - 1]) / (b[k - 1].sqrt() + b[k].sqrt());
            t.push(now);
        }
        now.is_finite().then_some(Profile { s, b, t })
    }

    /// The nodes.
    pub fn s(&self) -> &[f64] {
        &self.s
    }

    /// ṡ² at the nodes.
    pub fn b(&self) -> &[f64] {
        &self.b
    }

    /// Times at the nodes from 0, s.
    pub fn times(&self) -> &[f64] {
        &self.t
    }

    /// Duration of the whole path, s.
    pub fn duration(&self) -> f64 {
        self.t[self.t.len() - 1]
    }

    fn piece(&self, k: usize) -> ProfilePiece {
        ProfilePiece {
            speed: self.b[k].sqrt(),
            acceleration: (self.b[k + 1] - self.b[k]) / (2.0 * (self.s[k + 1] - self.s[k])),
            duration: self.t[k + 1] - self.t[k],
        }
    }

    /// The motion on each interval.
    pub fn pieces(&self) -> impl ExactSizeIterator<Item = ProfilePiece> + '_ {
        (0..self.s.len() - 1).map(|k| self.piece(k))
    }

    /// (s, ṡ, s̈) at the time `t` (s), clamped to the duration. At a node the acceleration is that
    /// of the later interval.
    pub fn at(&self, t: f64) -> (f64, f64, f64) {
        let last = self.s.len() - 1;
        if t >= self.duration() {
            return (self.s[last], self.b[last].sqrt(), 0.0);
        }
        if t.is_nan() || t < 0.0 {
            return (self.s[0], self.b[0].sqrt(), 0.0);
        }
        self.in_interval(self.t.partition_point(|node| *node <= t) - 1, t)
    }

    /// (s, ṡ, s̈) at the time `t` (s) within interval k.
    pub(crate) fn in_interval(&self, k: usize, t: f64) -> (f64, f64, f64) {
        let (piece, tau) = (self.piece(k), t - self.t[k]);
        let speed = piece.speed + piece.acceleration * tau;
        let s = self.s[k] + tau * 0.5 * (piece.speed + speed);
        (s.min(self.s[k + 1]), speed.max(0.0), piece.acceleration)
    }

    /// Time at which the motion passes `at`, s; clamped to the path.
    pub fn time_at(&self, at: f64) -> f64 {
        let last = self.s.len() - 1;
        if at >= self.s[last] {
            return self.duration();
        }
        let after = self.s.partition_point(|node| *node <= at);
        after.checked_sub(1).map_or(0.0, |k| self.time_in(k, at))
    }

    /// Time at which the motion passes `at` within interval k, s.
    pub(crate) fn time_in(&self, k: usize, at: f64) -> f64 {
        let piece = self.piece(k);
        let distance = (at - self.s[k]).max(0.0);
        // v² = v₀² + 2 a d; the time is the distance over the mean speed.
        let square = piece.speed.powi(2) + 2.0 * piece.acceleration * distance;
        let sum = piece.speed + square.max(0.0).sqrt();
        let time = if sum > 0.0 { 2.0 * distance / sum } else { 0.0 };
        self.t[k] + time.min(piece.duration)
    }

    /// The same path in `duration` (s), uniformly slower or faster.
    pub fn scaled_to(&self, duration: f64) -> Option<Profile> {
        let ratio = self.duration() / duration;
        Profile::new(self.s.clone(), self.b.iter().map(|b| b * ratio * ratio).collect())
    }
}

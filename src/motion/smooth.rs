//! Jerk limitation: a moving average of a motion with steps in its acceleration.
//!
//! s(t) becomes (1/w) ∫ s over the last w seconds. The acceleration then changes
//! linearly, by at most its former range in w; the motion takes w longer.

/// A stretch of s(t) with constant jerk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cubic {
    /// Begin, s.
    pub t: f64,
    /// Length, s.
    pub duration: f64,
    /// s, ṡ, s̈ at the begin and the jerk.
    pub state: [f64; 4],
}

impl Cubic {
    /// (s, ṡ, s̈) at `tau` after the begin.
    pub fn at(&self, tau: f64) -> [f64; 3] {
        let [s, v, a, j] = self.state;
        [
            s + tau * (v + tau * (a / 2.0 + tau * j / 6.0)),
            v + tau * (a + tau * j / 2.0),
            a + tau * j,
        ]
    }
}

/// Shortest stretch that is kept, s: below lies rounding of sums of times.
const SHORTEST: f64 = 1e-12;

/// The average of a motion over the window `w`.
///
/// `times` and `speeds` are the knots of a piecewise linear ṡ that starts and ends at 0.
pub fn moving_average(times: &[f64], speeds: &[f64], w: f64) -> Vec<Cubic> {
    let mut knots: Vec<f64> = times.to_vec();
    if w > 0.0 {
        knots.extend(times.iter().map(|t| t + w));
        knots.sort_by(f64::total_cmp);
    }
    let source = Ramp { times, speeds };
    let mut pieces: Vec<Cubic> = Vec::with_capacity(knots.len());
    let mut s = 0.0;
    let mut v = speeds.first().copied().unwrap_or(0.0);
    for pair in knots.windows(2) {
        let (t, duration) = (pair[0], pair[1] - pair[0]);
        if duration <= SHORTEST {
            continue;
        }
        let middle = t + 0.5 * duration;
        let (a, jerk) = if w > 0.0 {
            let a = (source.speed(t) - source.speed(t - w)) / w;
            (a, (source.slope(middle) - source.slope(middle - w)) / w)
        } else {
            (source.slope(middle), 0.0)
        };
        let piece = Cubic { t, duration, state: [s, v, a, jerk] };
        let [next_s, next_v, _] = piece.at(duration);
        (s, v) = (next_s, next_v.max(0.0));
        pieces.push(piece);
    }
    pieces
}

/// A piecewise linear speed, 0 outside.
struct Ramp<'a> {
    times: &'a [f64],
    speeds: &'a [f64],
}

impl Ramp<'_> {
    fn interval(&self, t: f64) -> Option<usize> {
        let after = self.times.partition_point(|x| *x <= t);
        (after > 0 && after < self.times.len()).then(|| after - 1)
    }

    fn speed(&self, t: f64) -> f64 {
        self.interval(t).map_or(0.0, |i| self.speeds[i] + self.slope(t) * (t - self.times[i]))
    }

    fn slope(&self, t: f64) -> f64 {
        self.interval(t).map_or(0.0, |i| {
            (self.speeds[i + 1] - self.speeds[i]) / (self.times[i + 1] - self.times[i])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn average_keeps_the_distance_and_limits_the_jerk() {
        let (times, speeds, w) = ([0.0, 0.2, 0.5, 0.8], [0.0, 2.0, 2.0, 0.0], 0.1);
        let distance = 0.5 * 0.2 * 2.0 + 0.3 * 2.0 + 0.5 * 0.3 * 2.0;
        let pieces = moving_average(&times, &speeds, w);
        let last = pieces.last().expect("pieces");
        let [s, v, a] = last.at(last.duration);
        assert!((s - distance).abs() < 1e-12 && v.abs() < 1e-12 && a.abs() < 1e-9);
        assert!((last.t + last.duration - 0.9).abs() < 1e-12);
        for piece in &pieces {
            assert!(piece.state[3].abs() <= 10.0 / w + 1e-9);
        }
        for pair in pieces.windows(2) {
            let end = pair[0].at(pair[0].duration);
            for i in 0..3 {
                assert!((end[i] - pair[1].state[i]).abs() < 1e-9, "continuous in derivative {i}");
            }
        }
    }
}

//! A move from 0 to 1 with limited speed, acceleration and jerk: seven pieces of constant jerk.

/// Halvings that find the peak speed of a short move: to rounding of a double in practice.
const HALVINGS: usize = 40;

/// A profile of a move.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    pieces: [(f64, f64); 7],
    /// Duration \[s\].
    pub(super) duration: f64,
}

/// Duration of the growth of the speed to `v`, duration of each jerk, and the acceleration reached.
fn growth(v: f64, a: f64, jerk: f64) -> (f64, f64, f64) {
    let reached = a.min((v * jerk).sqrt());
    let t = reached / jerk;
    (v / reached + t, t, reached)
}

impl Profile {
    /// The fastest move over the distance 1 with peak speed `v` \[1/s\], acceleration `a` \[1/s²\] and
    /// jerk \[1/s³\].
    pub(super) fn new(v: f64, a: f64, jerk: f64) -> Self {
        let length = |speed: f64| speed * growth(speed, a, jerk).0;
        let mut peak = v;
        if length(v) > 1.0 {
            let (mut low, mut high) = (0.0, v);
            for _ in 0..HALVINGS {
                peak = 0.5 * (low + high);
                if length(peak) > 1.0 { high = peak } else { low = peak }
            }
            peak = low.max(f64::MIN_POSITIVE);
        }
        let (time, t, reached) = growth(peak, a, jerk);
        let flat = (time - 2.0 * t).max(0.0);
        let cruise = ((1.0 - peak * time) / peak).max(0.0);
        let j = reached / t;
        let pieces = [(t, j), (flat, 0.0), (t, -j), (cruise, 0.0), (t, -j), (flat, 0.0), (t, j)];
        Self { pieces, duration: 2.0 * time + cruise }
    }

    /// Place, speed \[1/s\] and acceleration \[1/s²\] at a time \[s\] after the start.
    pub(super) fn at(&self, time: f64) -> (f64, f64, f64) {
        if time <= 0.0 {
            return (0.0, 0.0, 0.0);
        }
        if time >= self.duration {
            return (1.0, 0.0, 0.0);
        }
        let (mut s, mut v, mut a, mut rest) = (0.0, 0.0, 0.0, time);
        for (span, jerk) in self.pieces {
            let t = rest.min(span);
            s += t * (v + t * (0.5 * a + t * jerk / 6.0));
            v += t * (a + 0.5 * t * jerk);
            a += t * jerk;
            rest -= t;
            if rest <= 0.0 {
                break;
            }
        }
        (s, v, a)
    }

    /// The time \[s\] at which a share of the distance is done.
    pub(super) fn when(&self, share: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.duration);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.at(middle).0 < share { low = middle } else { high = middle }
        }
        high
    }
}

//! Rest-to-rest motion with limited rate, acceleration and jerk: seven pieces of constant jerk.
//!
//! L. Biagiotti, C. Melchiorri, Trajectory Planning for Automatic Machines and Robots, 2008, 3.4.

/// A jerk-limited profile over a distance.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    /// Durations \[s\] and jerks of the seven pieces.
    pieces: [(f64, f64); 7],
    distance: f64,
}

/// Limits of rate, acceleration and jerk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Rate \[1/s\].
    pub(super) rate: f64,
    /// Acceleration \[1/s²\].
    pub(super) acceleration: f64,
    /// Jerk \[1/s³\].
    pub(super) jerk: f64,
}

impl Profile {
    /// The fastest profile over a positive distance.
    pub(super) fn new(distance: f64, limits: &Limits) -> Self {
        let Limits { rate, acceleration, jerk } = *limits;
        let (mut ramp, mut rise) = if rate * jerk < acceleration * acceleration {
            let ramp = (rate / jerk).sqrt();
            (ramp, 2.0 * ramp)
        } else {
            let ramp = acceleration / jerk;
            (ramp, ramp + rate / acceleration)
        };
        let mut cruise = distance / rate - rise;
        if cruise < 0.0 {
            cruise = 0.0;
            if distance < 2.0 * acceleration.powi(3) / (jerk * jerk) {
                ramp = (0.5 * distance / jerk).cbrt();
                rise = 2.0 * ramp;
            } else {
                ramp = acceleration / jerk;
                rise = 0.5 * ramp + (0.25 * ramp * ramp + distance / acceleration).sqrt();
            }
        }
        let flat = rise - 2.0 * ramp;
        let pieces = [
            (ramp, jerk),
            (flat, 0.0),
            (ramp, -jerk),
            (cruise, 0.0),
            (ramp, -jerk),
            (flat, 0.0),
            (ramp, jerk),
        ];
        Self { pieces, distance }
    }

    /// Duration \[s\].
    pub(super) fn duration(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.0).sum()
    }

    /// Place, rate and acceleration at a time \[s\] from the start.
    pub(super) fn at(&self, time: f64) -> [f64; 3] {
        if time <= 0.0 {
            return [0.0; 3];
        }
        let mut left = time;
        let [mut s, mut v, mut a] = [0.0; 3];
        for (duration, jerk) in self.pieces {
            let h = left.min(duration);
            s += h * (v + h * (0.5 * a + h * jerk / 6.0));
            v += h * (a + 0.5 * h * jerk);
            a += h * jerk;
            left -= h;
            if left <= 0.0 {
                return [s, v, a];
            }
        }
        [self.distance, 0.0, 0.0]
    }
}

//! What a law lets movements differ by, and how probable a difference then is.

use super::changes::Change;
use super::features::Feature;

/// Deviations by which a healthy robot repeats itself another day, by feature and in its unit: 2 ms
/// of a duration, 3 ms of a rest, 0.5 % of a speed, 1 % in a ramp, 1 ms of a shift, 0.5 mrad at a
/// corner. Chosen on logs of simulated robots, whose repetitions differ by about half of that.
const HEALTHY: [f64; Feature::COUNT] = [0.002, 0.003, 0.005, 0.01, 0.01, 0.001, 0.0005];
/// Widest differences, by feature and in its unit: what any controller may do.
const WIDEST: [f64; Feature::COUNT] = [2.0, 2.0, 2.0, 2.0, 2.0, 0.5, 0.5];

/// A difference between two bounds, give or take a deviation.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Expected {
    low: f64,
    high: f64,
    sd: f64,
}

impl Expected {
    /// This difference, known to a share of itself.
    pub(super) fn exactly(value: f64, share: f64) -> Expected {
        Expected { low: value, high: value, sd: share * value.abs() }
    }

    /// Any difference between two.
    pub(super) fn between(a: f64, b: f64) -> Expected {
        Expected { low: a.min(b), high: a.max(b), sd: 0.0 }
    }

    /// Any difference up to this one, to both sides.
    pub(super) fn within(most: f64) -> Expected {
        Expected::between(-most, most)
    }

    fn and(self, other: Expected) -> Expected {
        Expected {
            low: self.low + other.low,
            high: self.high + other.high,
            sd: self.sd.hypot(other.sd),
        }
    }

    /// Logarithm of the density of a measured difference.
    fn log_density(self, feature: Feature, change: Change) -> f64 {
        let sd = self.sd.hypot(change.sd).hypot(HEALTHY[feature as usize]);
        let (a, b) = ((change.value - self.low) / sd, (change.value - self.high) / sd);
        let density = if a - b < NARROW {
            student(0.5 * (a + b))
        } else {
            (student_below(a) - student_below(b)) / (a - b)
        };
        (density / sd).max(f64::MIN_POSITIVE).ln()
    }
}

/// Width in deviations below which an interval is a value.
const NARROW: f64 = 1e-3;

/// Student's density of 4 degrees of freedom: deviations come from few repetitions, and some
/// movement may be measured badly.
fn student(x: f64) -> f64 {
    0.375 * (1.0 + 0.25 * x * x).powf(-2.5)
}

/// Its distribution function.
fn student_below(x: f64) -> f64 {
    let x2 = 0.25 * x * x;
    let share = x2 / (1.0 + x2);
    0.5 + 0.375 * x / (1.0 + x2).sqrt() * (1.0 - share / 3.0)
}

/// One way in which a law may change a movement.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    /// How probable it is.
    pub weight: f64,
    expected: [Expected; Feature::COUNT],
}

impl Mode {
    /// A movement that stays as it was.
    pub(super) fn unchanged(weight: f64) -> Mode {
        Mode { weight, expected: [Expected::default(); Feature::COUNT] }
    }

    /// The same with another difference of a feature.
    pub(super) fn with(mut self, feature: Feature, expected: Expected) -> Mode {
        self.expected[feature as usize] = expected;
        self
    }

    /// The same with another probability.
    pub(super) fn weighing(mut self, weight: f64) -> Mode {
        self.weight = weight;
        self
    }

    /// What two laws do together.
    pub(super) fn and(&self, other: &Mode) -> Mode {
        let mut both = *self;
        both.weight *= other.weight;
        both.expected.iter_mut().zip(other.expected).for_each(|(to, of)| *to = to.and(of));
        both
    }

    fn log_density(&self, changes: &[Option<Change>; Feature::COUNT]) -> f64 {
        let of = |feature: Feature| {
            let expected = self.expected[feature as usize];
            changes[feature as usize].map_or(0.0, |change| expected.log_density(feature, change))
        };
        self.weight.ln() + Feature::ALL.into_iter().map(of).sum::<f64>()
    }
}

/// Logarithm of the density of a movement's differences if it changes in one of some ways.
pub(super) fn log_density(modes: &[Mode], changes: &[Option<Change>; Feature::COUNT]) -> f64 {
    sum_of_logs(modes.iter().map(|mode| mode.log_density(changes)))
}

/// The same if each feature changes by itself, with a probability, by anything.
pub(super) fn log_density_of_anything(
    share: f64,
    changes: &[Option<Change>; Feature::COUNT],
) -> f64 {
    let of = |feature: Feature| {
        let Some(change) = changes[feature as usize] else { return 0.0 };
        let same = Expected::default().log_density(feature, change);
        let other = Expected::within(WIDEST[feature as usize]).log_density(feature, change);
        sum_of_logs([(1.0 - share).ln() + same, share.ln() + other].into_iter())
    };
    Feature::ALL.into_iter().map(of).sum()
}

/// ln Σ exp.
fn sum_of_logs(logs: impl Iterator<Item = f64> + Clone) -> f64 {
    let most = logs.clone().fold(f64::NEG_INFINITY, f64::max);
    most + logs.map(|log| (log - most).exp()).sum::<f64>().ln()
}

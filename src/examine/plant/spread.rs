//! How long a machine or a person takes: a time that differs from cycle to cycle.

use super::random::Random;

/// Temperature at which a mean holds \[°C\].
const WARM_C: f64 = 40.0;
/// Usual temperature of a day \[°C\].
const USUAL_C: f64 = 33.0;
/// Shares of spreads with outliers, and with a second population.
const WITH_OUTLIERS: f64 = 0.5;
const WITH_SECOND: f64 = 0.25;
/// No time falls below this share of its mean: the slowest part of a process is mechanical.
const LEAST: f64 = 0.2;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    LogNormal,
    Gamma,
}

/// A distribution of times.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spread {
    shape: Shape,
    /// Mean when warm, without outliers and second population \[s\].
    pub(super) mean_s: f64,
    /// Coefficient of variation.
    cv: f64,
    /// Probability of an outlier, and how many times the mean it adds at most.
    outliers: (f64, f64),
    /// A second population: its share, and what it takes longer \[s\]. A second shot of a camera, or
    /// another sort of workpiece.
    second: (f64, f64),
    /// Relative change for 1 K colder.
    per_kelvin: f64,
}

impl Spread {
    /// A time without outliers, second population and drift.
    pub(super) fn plain(mean_s: f64, cv: f64, draws: &mut Random) -> Spread {
        let shape = if draws.chance(0.5) { Shape::LogNormal } else { Shape::Gamma };
        Spread { shape, mean_s, cv, outliers: (0.0, 0.0), second: (0.0, 0.0), per_kelvin: 0.0 }
    }

    /// A time of a small device: gripper, clamp, camera.
    pub(super) fn device(mean_s: f64, draws: &mut Random) -> Spread {
        let cv = draws.log_between(0.02, 0.25);
        let mut spread = Spread::plain(mean_s, cv, draws);
        if draws.chance(WITH_OUTLIERS) {
            spread.outliers = (draws.log_between(0.002, 0.03), draws.between(2.0, 6.0));
        }
        if draws.chance(WITH_SECOND) {
            spread.second = (draws.between(0.05, 0.5), mean_s * draws.between(0.4, 2.0));
        }
        // Cold oil and cold air: up to a tenth slower in the morning.
        spread.per_kelvin = draws.between(0.0, 0.006);
        spread
    }

    /// A time of a machine with a program of its own.
    pub(super) fn machine(mean_s: f64, sd_s: f64, draws: &mut Random) -> Spread {
        let mut spread = Spread::plain(mean_s, (sd_s / mean_s).clamp(1e-3, 0.5), draws);
        if draws.chance(WITH_OUTLIERS) {
            spread.outliers = (draws.log_between(0.002, 0.03), draws.between(0.5, 2.0));
        }
        spread.per_kelvin = draws.between(0.0, 0.001);
        spread
    }

    /// A time of a person: skewed, sometimes several times as long.
    pub(super) fn hands(mean_s: f64, draws: &mut Random) -> Spread {
        let mut spread = Spread::plain(mean_s, draws.between(0.15, 0.4), draws);
        spread.shape = Shape::LogNormal;
        spread.outliers = (draws.between(0.02, 0.08), draws.between(2.0, 6.0));
        spread
    }

    /// Mean of all times of a day \[s\].
    pub(super) fn expected_s(&self) -> f64 {
        let outliers = 0.5 * self.mean_s * self.outliers.0 * self.outliers.1;
        let drift = 1.0 + self.per_kelvin * (WARM_C - USUAL_C);
        (self.mean_s + outliers + self.second.0 * self.second.1) * drift
    }

    /// One time \[s\] at a temperature \[°C\].
    pub(super) fn sample(&self, temperature: f64, draws: &mut Random) -> f64 {
        let factor = match self.shape {
            Shape::LogNormal => draws.lognormal(self.cv),
            Shape::Gamma => draws.gamma(self.cv),
        };
        let outlier = if draws.chance(self.outliers.0) {
            self.mean_s * self.outliers.1 * draws.unit()
        } else {
            0.0
        };
        let second = if draws.chance(self.second.0) { self.second.1 } else { 0.0 };
        let drift = 1.0 + self.per_kelvin * (WARM_C - temperature);
        (self.mean_s * factor.max(LEAST) + outlier + second) * drift
    }
}

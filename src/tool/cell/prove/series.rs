//! The power of a log over time, and its integral.

use super::error::ProveError;
use super::outliers::deviation;
use super::side::PowerLog;
use crate::learn::log::{Channel, Log, median_step};

/// Mean below which a cabinet's power is in kW: no cabinet takes less than this in W, none more in kW.
const KILOWATTS: f64 = 20.0;
/// Standard deviation of the power of a robot that moves, as a share of the mean: it is more than this.
const FLAT: f64 = 1e-3;
/// An interval longer than the usual one by this factor is a gap.
const GAP: f64 = 3.5;

/// Where the energy is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// At the supply of the cabinet.
    Cabinet,
    /// Positive mechanical work at the joints.
    Joints,
}

impl Measure {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Measure::Cabinet => "power of the cabinet",
            Measure::Joints => "mechanical power of the joints",
        }
    }
}

/// Power over time.
#[derive(Clone, Debug)]
pub(super) struct Series {
    pub(super) t: Vec<f64>,
    /// W.
    pub(super) power: Vec<f64>,
    /// Energy up to each sample, J.
    sum: Vec<f64>,
    /// Usual interval, s.
    pub(super) step: f64,
    /// Whether the log was in kW.
    pub(super) kilowatts: bool,
}

impl Series {
    /// The power of a log.
    pub(super) fn of(of: &PowerLog, measure: Measure) -> Result<Series, ProveError> {
        let file = || of.shown.clone();
        let t = of.log.time().to_vec();
        let (power, kilowatts) = match measure {
            Measure::Cabinet => {
                let power = of.log.column(Channel::Power);
                let power = power.ok_or_else(|| ProveError::NoMeasure { file: file() })?;
                let mean = power.iter().sum::<f64>() / power.len().max(1) as f64;
                if mean <= 0.0 {
                    return Err(ProveError::Negative { file: file(), power_w: mean });
                }
                if deviation(power) < FLAT * mean * (power.len() as f64).sqrt() {
                    return Err(ProveError::Constant { file: file() });
                }
                let unit = if mean < KILOWATTS { 1000.0 } else { 1.0 };
                (power.iter().map(|x| unit * x).collect(), mean < KILOWATTS)
            }
            Measure::Joints => {
                let power = joint_power(&of.log);
                (power.ok_or_else(|| ProveError::NoMeasure { file: file() })?, false)
            }
        };
        Ok(Series::new(t, power, kilowatts))
    }

    pub(super) fn new(t: Vec<f64>, power: Vec<f64>, kilowatts: bool) -> Series {
        let mut sum = vec![0.0; t.len()];
        for i in 1..t.len() {
            sum[i] = sum[i - 1] + 0.5 * (power[i] + power[i - 1]) * (t[i] - t[i - 1]);
        }
        let step = median_step(&t);
        Series { t, power, sum, step, kilowatts }
    }

    /// First and last time, s.
    pub(super) fn range(&self) -> [f64; 2] {
        [self.t.first().copied().unwrap_or(0.0), self.t.last().copied().unwrap_or(0.0)]
    }

    /// Energy from the first sample to a time, by the trapezoidal rule, J.
    pub(super) fn energy(&self, at: f64) -> f64 {
        let after = self.t.partition_point(|t| *t <= at);
        let Some(i) = after.checked_sub(1) else { return 0.0 };
        let dt = at - self.t[i];
        let Some(next) = self.t.get(after) else { return self.sum[i] + self.power[i] * dt };
        let slope = (self.power[after] - self.power[i]) / (next - self.t[i]);
        self.sum[i] + dt * (self.power[i] + 0.5 * slope * dt)
    }

    /// Mean power between two times, W.
    pub(super) fn mean(&self, from: f64, to: f64) -> f64 {
        (self.energy(to) - self.energy(from)) / (to - from)
    }

    /// The longest interval without a sample between two times, if it is a gap, s.
    pub(super) fn gap(&self, from: f64, to: f64) -> Option<f64> {
        let begin = self.t.partition_point(|t| *t < from).saturating_sub(1);
        let end = (self.t.partition_point(|t| *t < to) + 1).min(self.t.len());
        let steps = self.t.get(begin..end)?.windows(2).map(|pair| pair[1] - pair[0]);
        let longest = steps.fold(0.0, f64::max);
        (longest > GAP * self.step).then_some(longest)
    }
}

/// What the logs of both sides measure.
pub(super) fn measure(logs: &[&PowerLog]) -> Result<Measure, ProveError> {
    let of = |log: &PowerLog| {
        if log.log.column(Channel::Power).is_some() {
            Some(Measure::Cabinet)
        } else {
            joint_power(&log.log).map(|_| Measure::Joints)
        }
    };
    let mut first: Option<(&PowerLog, Measure)> = None;
    for log in logs {
        let file = log.shown.clone();
        let found = of(log).ok_or(ProveError::NoMeasure { file: file.clone() })?;
        match first {
            Some((other, known)) if known != found => {
                let other = other.shown.clone();
                let [found, known] = [found, known].map(Measure::name);
                return Err(ProveError::Measures { file, found, other, known });
            }
            None => first = Some((log, found)),
            _ => {}
        }
    }
    Ok(first.map_or(Measure::Cabinet, |(_, measure)| measure))
}

/// Σ max(τ q̇, 0): what a joint gives back is lost, as with drives that share nothing.
fn joint_power(log: &Log) -> Option<Vec<f64>> {
    let t = log.time();
    let mut power = vec![0.0; t.len()];
    log.column(Channel::Torque(0))?;
    for joint in 0.. {
        let Some(tau) = log.column(Channel::Torque(joint)) else { break };
        let rate =
            match (log.column(Channel::Velocity(joint)), log.column(Channel::Position(joint))) {
                (Some(rate), _) => rate.to_vec(),
                (None, Some(q)) => central(t, q),
                (None, None) => return None,
            };
        for ((power, tau), rate) in power.iter_mut().zip(tau).zip(&rate) {
            *power += (tau * rate).max(0.0);
        }
    }
    Some(power)
}

/// Central differences.
fn central(t: &[f64], q: &[f64]) -> Vec<f64> {
    let last = t.len().saturating_sub(1);
    let rate = |i: usize| {
        let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
        if b > a { (q[b] - q[a]) / (t[b] - t[a]) } else { 0.0 }
    };
    (0..t.len()).map(rate).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_is_the_integral() {
        // p = 100 + 10 t on uneven times: exact by the trapezoidal rule.
        let t: Vec<f64> = (0..100).map(|i| 0.1 * f64::from(i) + 0.001 * f64::from(i % 3)).collect();
        let power = t.iter().map(|t| 100.0 + 10.0 * t).collect();
        let series = Series::new(t, power, false);
        let exact = |a: f64, b: f64| 100.0 * (b - a) + 5.0 * (b * b - a * a);
        assert!((series.energy(7.77) - series.energy(1.23) - exact(1.23, 7.77)).abs() < 1e-9);
        assert!((series.mean(2.0, 3.0) - 125.0).abs() < 1e-9);
        assert_eq!(series.gap(1.0, 5.0), None);
    }
}

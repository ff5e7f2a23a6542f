//! The meter: what it writes of the power.

use std::fmt::Write as _;

use super::ledger::Ledger;
use super::random::Random;
use super::truth::CycleTruth;

/// Unit of the column `power`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Watts.
    Watts,
    /// Kilowatts.
    Kilowatts,
}

/// A meter, which writes the mean power between two rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Meter {
    /// Rows per second \[Hz\].
    pub rate_hz: f64,
    /// Its reading over the truth, at the start.
    pub gain: f64,
    /// Change of the gain per hour.
    pub drift_per_hour: f64,
    /// Standard deviation of the noise of a row \[W\].
    pub noise_w: f64,
    /// Smallest step of the reading \[W\].
    pub step_w: f64,
    /// Unit of the readings.
    pub unit: Unit,
}

impl Default for Meter {
    fn default() -> Meter {
        Meter {
            rate_hz: 10.0,
            gain: 1.0,
            drift_per_hour: 0.0,
            noise_w: 8.0,
            step_w: 1.0,
            unit: Unit::Watts,
        }
    }
}

/// Step of the temperature in the log \[K\].
const STEP_K: f64 = 0.1;
const HOUR_S: f64 = 3600.0;

impl Meter {
    /// The log of power: a row per interval, with the cycle in which it ends.
    pub(super) fn log(
        &self,
        ledger: &Ledger,
        cycles: &[CycleTruth],
        temperature: impl Fn(u64) -> f64,
        seed: u64,
    ) -> String {
        let mut text = String::from("t,power,cycle,part,temp1\n");
        let mut noise = Random::of(seed, "meter", &[]);
        let mut before_j = 0.0;
        let mut row = 0_u64;
        for cycle in cycles {
            let degrees = (temperature(cycle.index as u64) / STEP_K).round() * STEP_K;
            loop {
                let t = (row + 1) as f64 / self.rate_hz;
                if t > cycle.start_s + cycle.duration_s {
                    break;
                }
                let until_j = ledger.until(t);
                let power = (until_j - before_j) * self.rate_hz;
                let reading = self.reading(power, t, noise.normal());
                // Writing into a string does not fail.
                let _ =
                    writeln!(text, "{t:.3},{reading},{},{},{degrees:.1}", cycle.number, cycle.part);
                before_j = until_j;
                row += 1;
            }
        }
        text
    }

    fn reading(&self, power: f64, t: f64, noise: f64) -> String {
        let gain = self.gain * (1.0 + self.drift_per_hour * t / HOUR_S);
        let seen = gain * power + self.noise_w * noise;
        let seen =
            if self.step_w > 0.0 { (seen / self.step_w).round() * self.step_w } else { seen };
        match self.unit {
            Unit::Watts => format!("{seen:.2}"),
            Unit::Kilowatts => format!("{:.5}", seen / 1000.0),
        }
    }
}

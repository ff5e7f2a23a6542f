//! What a recorder makes of samples: times, noise, quantisation and text.

use super::arm::Arm;
use super::everyday::Everyday;
use super::plant::Sample;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;
use crate::examine::worlds::table::{Table, quantised};
use std::f64::consts::TAU;

/// Sampling rates \[Hz\].
pub(super) const RATES: [f64; 5] = [50.0, 100.0, 125.0, 250.0, 500.0];
/// How often each rate is met.
const RATE_SHARES: [f64; 5] = [0.15, 0.3, 0.2, 0.25, 0.1];
/// Deviation of a time stamp over the interval.
const JITTER: (f64, f64) = (0.000_3, 0.01);
/// Pulses per turn of an encoder at the motor.
const PULSES: (f64, f64) = (2_048.0, 65_536.0);
/// Step of the logged torque over the limit of the torque.
const TORQUE_STEP: (f64, f64) = (0.000_05, 0.001);
/// Share of rows that are lost, in logs that lose rows.
const LOST: (f64, f64) = (0.000_2, 0.003);
/// Start of the clock, in logs that do not start at 0 \[s\].
const CLOCK: (f64, f64) = (10.0, 90_000.0);

/// Habits of a recorder.
#[derive(Clone, Debug)]
pub(super) struct Recorder {
    /// Sampling rate \[Hz\].
    pub(super) rate: f64,
    jitter: f64,
    irregular: bool,
    clock: f64,
    angle_step: Row,
    torque_step: Row,
    speeds: bool,
    lost: f64,
    decimals: [usize; 3],
}

impl Recorder {
    /// A random recorder; `at_zero` keeps the clock at the start of the log.
    pub(super) fn new(arm: &Arm, at_zero: bool, rng: &mut Rng) -> Self {
        let (pulses, step) = (rng.log(PULSES), rng.log(TORQUE_STEP));
        let (mut angle_step, mut torque_step) = ([0.0; MAX], [0.0; MAX]);
        for j in 0..arm.count() {
            angle_step[j] = TAU / (pulses.round() * arm.ratio[j]);
            torque_step[j] = step * arm.effort[j];
        }
        let finest = torque_step[..arm.count()].iter().fold(f64::MAX, |a, b| a.min(*b));
        let torque_decimals = ((1.0 - finest.log10()).ceil().clamp(2.0, 7.0)) as usize;
        Self {
            rate: RATES[rng.weighted(&RATE_SHARES)],
            jitter: rng.log(JITTER),
            irregular: rng.chance(0.5),
            clock: if rng.chance(0.25) && !at_zero { rng.log(CLOCK) } else { 0.0 },
            angle_step,
            torque_step,
            speeds: rng.chance(0.4),
            lost: if rng.chance(0.25) { rng.log(LOST) } else { 0.0 },
            decimals: [4 + rng.below(3), 5 + rng.below(3), torque_decimals],
        }
    }

    /// Times \[s\] at which the robot is sampled, and the stamps that the log gives them.
    pub(super) fn times(&self, duration: f64, rng: &mut Rng) -> (Vec<f64>, Vec<f64>) {
        let count = (duration * self.rate).floor() as usize;
        let mut truth = Vec::with_capacity(count);
        let mut stamps = Vec::with_capacity(count);
        for k in 0..count {
            let t = k as f64 / self.rate;
            let off = self.jitter * rng.spread(1.0) / self.rate;
            if rng.chance(self.lost) {
                continue;
            }
            // Either the sampling is uneven and well stamped, or the stamps are off.
            let (true_off, stamp_off) = if self.irregular { (off, off) } else { (0.0, off) };
            truth.push((t + true_off).max(0.0));
            stamps.push((t + stamp_off).max(0.0) + self.clock);
        }
        (truth, stamps)
    }

    /// A log as CSV. `powers` \[W\] adds the column `power`.
    pub(super) fn csv(
        &self,
        stamps: &[f64],
        samples: &[Sample],
        everyday: &Everyday,
        powers: Option<&[f64]>,
        rng: &mut Rng,
    ) -> String {
        let groups: &[&str] = if self.speeds { &["q", "qd", "tau"] } else { &["q", "tau"] };
        let single: &[&str] = if powers.is_some() { &["power"] } else { &[] };
        let mut out = Table::new(everyday.joints.len(), groups, single);
        let keep = (-1.0 / (self.rate * everyday.noise_time)).exp();
        let fresh = (1.0 - keep * keep).sqrt();
        let mut noise = [0.0; MAX];
        let [dt, dq, dtau] = self.decimals;
        for (k, (stamp, sample)) in stamps.iter().zip(samples).enumerate() {
            out.row(*stamp, dt);
            for (q, step) in sample.q.iter().zip(self.angle_step).take(everyday.joints.len()) {
                out.value(quantised(*q, step), dq);
            }
            if self.speeds {
                for (v, step) in sample.v.iter().zip(self.angle_step).take(everyday.joints.len()) {
                    out.value(v + step * rng.spread(20.0), dq);
                }
            }
            for (j, joint) in everyday.joints.iter().enumerate() {
                if k == 0 {
                    noise[j] = rng.spread(1.0);
                }
                noise[j] = keep * noise[j] + fresh * rng.spread(1.0);
                out.value(
                    quantised(sample.tau[j] + joint.noise * noise[j], self.torque_step[j]),
                    dtau,
                );
            }
            if let Some(powers) = powers {
                out.value(powers[k], 1);
            }
        }
        out.finish()
    }

    /// Deviation \[Nm\] of one logged torque: noise and quantisation.
    pub(super) fn deviation(&self, everyday: &Everyday, j: usize) -> f64 {
        let noise = everyday.joints[j].noise;
        (noise * noise + self.torque_step[j] * self.torque_step[j] / 12.0).sqrt()
    }

    /// Takes a slower rate \[Hz\] where a log of this duration \[s\] would have too many rows.
    pub(super) fn limit(&mut self, duration: f64, rows: f64) {
        for rate in RATES.iter().rev() {
            if self.rate >= *rate && *rate * duration <= rows {
                self.rate = *rate;
                return;
            }
        }
        self.rate = RATES[0];
    }
}

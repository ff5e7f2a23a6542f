//! Noise and quantisation of a log.

use std::fmt::Write as _;

use super::mechanics::Joints;
use super::motion::{PER_ROW, STEP_S};
use super::random::Random;
use super::simulate::Row;
use crate::arm::robot::MAX_DOF;

/// Interval of the rows \[s\].
pub(super) const ROW_S: f64 = STEP_S * PER_ROW as f64;

/// Sensor noise.
#[derive(Clone, Debug)]
pub(super) struct Noise {
    /// Standard deviation of the torques \[Nm\].
    pub(super) torque: Joints,
    /// Correlation of the noise of successive rows.
    pub(super) memory: f64,
    /// Quantisation step of the logged torques \[Nm\] and positions \[rad\].
    torque_step: Joints,
    position_step: f64,
    /// Standard deviation of the power \[W\].
    pub(super) power: f64,
}

impl Noise {
    /// Random noise for torques with the rms `rms` \[Nm\] and a power of the size `watts`.
    pub(super) fn drawn(rms: &Joints, peak: &Joints, watts: f64, random: &mut Random) -> Noise {
        let bits = 2_f64.powf(random.between(11.0, 14.0));
        let level = random.log_between(0.003, 0.02);
        Noise {
            torque: rms.map(|rms| level * rms * random.between(0.6, 1.6)),
            memory: random.between(0.2, 0.8),
            torque_step: peak.map(|peak| peak / bits),
            position_step: random.log_between(1e-6, 2e-5),
            power: random.log_between(0.003, 0.015) * watts,
        }
    }

    /// Standard deviation of the noise innovation in each row of a joint.
    pub(super) fn innovation(&self, joint: usize) -> f64 {
        let step = self.torque_step[joint];
        let white = self.torque[joint] * (1.0 - self.memory * self.memory).sqrt();
        (white * white + step * step / 12.0).sqrt()
    }

    /// The log of rows from the time `clock` \[s\] as CSV; with `marks`, the repetition and the
    /// movement of each row.
    pub(super) fn log(
        &self,
        rows: &[Row],
        dof: usize,
        clock: f64,
        marks: Option<&[[usize; 2]]>,
        random: &mut Random,
    ) -> String {
        let mut csv = String::from("t");
        for name in ["q", "tau"] {
            for joint in 1..=dof {
                let _ = write!(csv, ",{name}{joint}");
            }
        }
        csv.push_str(if marks.is_some() { ",power,cycle,cmd\n" } else { ",power\n" });
        let fresh = (1.0 - self.memory * self.memory).sqrt();
        let mut state: Joints = [0.0; MAX_DOF];
        let mut of_power = 0.0;
        for level in &mut state {
            *level = random.normal();
        }
        for (i, row) in rows.iter().enumerate() {
            let _ = write!(csv, "{:.3}", clock + i as f64 * ROW_S);
            for joint in 0..dof {
                let jitter = 0.3 * self.position_step * random.normal();
                let steps = ((row.q[joint] + jitter) / self.position_step).round();
                let _ = write!(csv, ",{:.6}", steps * self.position_step);
            }
            for joint in 0..dof {
                state[joint] = self.memory * state[joint] + fresh * random.normal();
                let tau = row.tau[joint] + self.torque[joint] * state[joint];
                let step = self.torque_step[joint].max(1e-9);
                let _ = write!(csv, ",{:.4}", (tau / step).round() * step);
            }
            of_power = self.memory * of_power + fresh * random.normal();
            let _ = write!(csv, ",{:.2}", row.power + self.power * of_power);
            if let Some([cycle, movement]) = marks.and_then(|marks| marks.get(i)) {
                let _ = write!(csv, ",{cycle},{movement}");
            }
            csv.push('\n');
        }
        csv
    }
}

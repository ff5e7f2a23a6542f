//! The measured motion, and its states between the rows of the log.

use crate::arm::robot::MAX_DOF;
use crate::learn::log::derivatives;

/// A number for each joint; entries beyond the joints of the robot are 0.
pub(super) type Joints = [f64; MAX_DOF];

/// Positions, rates and accelerations at the rows of a log.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    /// Times \[s\].
    pub(super) t: Vec<f64>,
    /// Positions \[rad\].
    pub(super) q: Vec<Joints>,
    /// Rates \[rad/s\].
    pub(super) qd: Vec<Joints>,
    /// Accelerations \[rad/s²\].
    pub(super) qdd: Vec<Joints>,
}

impl Motion {
    /// The motion with the positions of each joint `q` \[rad\] at the times `t` \[s\].
    pub(super) fn new(t: &[f64], q: &[&[f64]]) -> Motion {
        let mut motion = Motion {
            t: t.to_vec(),
            q: vec![[0.0; MAX_DOF]; t.len()],
            qd: vec![[0.0; MAX_DOF]; t.len()],
            qdd: vec![[0.0; MAX_DOF]; t.len()],
        };
        for (joint, q) in q.iter().enumerate() {
            let found = derivatives(t, q);
            for (row, (q, found)) in q.iter().zip(found).enumerate() {
                let [rate, acceleration] = found.unwrap_or_default();
                motion.q[row][joint] = *q;
                motion.qd[row][joint] = rate;
                motion.qdd[row][joint] = acceleration;
            }
        }
        motion
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.t.len()
    }

    /// Duration \[s\].
    pub(super) fn duration(&self) -> f64 {
        self.t.last().zip(self.t.first()).map_or(0.0, |(last, first)| last - first)
    }

    /// Time since the first row \[s\].
    pub(super) fn since_start(&self, row: usize) -> f64 {
        self.t[row] - self.t[0]
    }

    /// Root mean square of a joint's rate \[rad/s\].
    pub(super) fn rms_rate(&self, joint: usize) -> f64 {
        rms(self.qd.iter().map(|qd| qd[joint]))
    }

    /// The value of |q̇| of a joint that this share of the rows does not exceed \[rad/s\].
    pub(super) fn rate_quantile(&self, joint: usize, share: f64) -> f64 {
        let mut rates: Vec<f64> = self.qd.iter().map(|qd| qd[joint].abs()).collect();
        rates.sort_by(f64::total_cmp);
        rates[((rates.len() - 1) as f64 * share) as usize]
    }

    /// Least and largest position of a joint \[rad\].
    pub(super) fn range(&self, joint: usize) -> [f64; 2] {
        let q = self.q.iter().map(|q| q[joint]);
        q.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| [low.min(q), high.max(q)])
    }
}

/// Root mean square; 0 without values.
pub(super) fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), x| (sum + x * x, count + 1));
    (sum / count.max(1) as f64).sqrt()
}

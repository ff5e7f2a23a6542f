//! The reference motion of a stream as dense samples over time.

use crate::retime::motion::stream::{DOF, Joints};

/// Displacement below which a joint is at rest, rad: less than the resolution of the emitted text.
const ROUNDING: f64 = 5e-9;

/// A reference joint motion, sampled densely enough for cubic interpolation.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    t: Vec<f64>,
    q: Vec<Joints>,
    qd: Vec<Joints>,
}

/// Error in the samples of a reference.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ReferenceError {
    /// Fewer than two samples, or columns of different lengths.
    #[error("a reference motion needs at least two samples of time, position and velocity each")]
    Lengths,
    /// Times that do not rise from 0.
    #[error("the times of a reference motion do not rise from 0 at sample {0}")]
    Time(usize),
    /// A value that is not finite.
    #[error("sample {0} of a reference motion is not finite")]
    Value(usize),
}

impl Reference {
    /// The motion through positions `q` (rad) with velocities `qd` (rad/s) at the times `t` (s).
    ///
    /// # Errors
    /// Too few samples, times that do not rise from 0, values that are not finite.
    pub fn new(t: Vec<f64>, q: Vec<Joints>, qd: Vec<Joints>) -> Result<Reference, ReferenceError> {
        if t.len() < 2 || t.len() != q.len() || t.len() != qd.len() {
            return Err(ReferenceError::Lengths);
        }
        if t[0] != 0.0 {
            return Err(ReferenceError::Time(0));
        }
        if let Some(i) = t.windows(2).position(|w| !(w[1] > w[0] && w[1].is_finite())) {
            return Err(ReferenceError::Time(i + 1));
        }
        let finite = |row: &Joints| row.iter().all(|x| x.is_finite());
        if let Some(i) = (0..t.len()).find(|i| !finite(&q[*i]) || !finite(&qd[*i])) {
            return Err(ReferenceError::Value(i));
        }
        Ok(Reference { t, q, qd })
    }

    /// Samples of `motion`, which returns (q, q̇) at a time, over `duration` (s).
    ///
    /// # Errors
    /// A duration that is not positive, no interval, values that are not finite.
    pub fn sample(
        duration: f64,
        intervals: usize,
        motion: impl Fn(f64) -> (Joints, Joints),
    ) -> Result<Reference, ReferenceError> {
        let t: Vec<f64> = (0..=intervals).map(|i| duration * i as f64 / intervals as f64).collect();
        let (q, qd) = t.iter().map(|t| motion(*t)).unzip();
        Reference::new(t, q, qd)
    }

    /// Duration of the motion, s.
    pub fn duration(&self) -> f64 {
        self.t[self.t.len() - 1]
    }

    /// Joint angles at the start, rad.
    pub fn start(&self) -> &Joints {
        &self.q[0]
    }

    /// Joint angles at the end, rad.
    pub fn end(&self) -> &Joints {
        &self.q[self.q.len() - 1]
    }

    /// Whether joint j leaves its start angle by more than rounding.
    pub(super) fn moves(&self, j: usize) -> bool {
        self.q.iter().any(|q| (q[j] - self.q[0][j]).abs() > ROUNDING)
    }

    /// (q, q̇) at `t` (s) by cubic Hermite interpolation; at rest outside the motion.
    pub fn at(&self, t: f64) -> (Joints, Joints) {
        let last = self.t.len() - 1;
        if t.is_nan() || t < 0.0 {
            return (self.q[0], [0.0; DOF]);
        }
        if t >= self.t[last] {
            let qd = if t > self.t[last] { [0.0; DOF] } else { self.qd[last] };
            return (self.q[last], qd);
        }
        let k = self.t.partition_point(|s| *s <= t) - 1;
        let h = self.t[k + 1] - self.t[k];
        let x = (t - self.t[k]) / h;
        let (mut q, mut qd) = ([0.0; DOF], [0.0; DOF]);
        for j in 0..DOF {
            let (v0, v1) = (h * self.qd[k][j], h * self.qd[k + 1][j]);
            let step = self.q[k + 1][j] - self.q[k][j];
            let (quadratic, cubic) = (3.0 * step - 2.0 * v0 - v1, v0 + v1 - 2.0 * step);
            q[j] = self.q[k][j] + x * (v0 + x * (quadratic + x * cubic));
            qd[j] = (v0 + x * (2.0 * quadratic + x * 3.0 * cubic)) / h;
        }
        (q, qd)
    }
}

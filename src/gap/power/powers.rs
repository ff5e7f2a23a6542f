//! Power of a motion, as a meter shows it.

/// Rate below which a joint rests \[rad/s\].
const REST: f64 = 0.02;

/// Mean power of a motion that repeats, or of a log.
#[derive(Clone, Debug)]
pub struct Powers {
    /// Time from row to row \[s\].
    pub step: f64,
    /// Whether the motion repeats.
    pub closed: bool,
    /// Rates by joint \[rad/s\].
    pub qd: Vec<Vec<f64>>,
    /// Measured torques by joint \[Nm\].
    pub tau: Vec<Vec<f64>>,
    /// Measured power \[W\].
    pub power: Vec<f64>,
}

impl Powers {
    pub(super) fn rows(&self) -> usize {
        self.power.len()
    }

    pub(super) fn mechanical(&self, row: usize) -> f64 {
        self.qd.iter().zip(&self.tau).map(|(qd, tau)| qd[row] * tau[row]).sum()
    }

    /// What passes through the drives of the joints.
    pub(super) fn through(&self, row: usize) -> f64 {
        self.qd.iter().zip(&self.tau).map(|(qd, tau)| (qd[row] * tau[row]).abs()).sum()
    }

    /// Values as a meter of first order shows them, with a time constant \[s\].
    pub(super) fn lagged(&self, mut x: Vec<f64>, lag: f64) -> Vec<f64> {
        if lag <= 0.0 {
            return x;
        }
        let kept = (-self.step / lag).exp();
        // A motion that repeats has been running before.
        let before = if self.closed { x.len() } else { 0 };
        let mut shown = x.first().copied().unwrap_or(0.0);
        for row in 0..before {
            shown = x[row] + (shown - x[row]) * kept;
        }
        for x in &mut x {
            shown = *x + (shown - *x) * kept;
            *x = shown;
        }
        x
    }

    /// Share of the joints that move or did so at most `timeout` \[s\] ago. Joints are taken for ready at the
    /// beginning of a log.
    pub(super) fn released(&self, timeout: f64) -> Vec<f64> {
        let rows = self.rows();
        let mut share = vec![0.0; rows];
        for qd in &self.qd {
            let mut idle = 0.0;
            for round in 0..if self.closed { 2 } else { 1 } {
                for (row, qd) in qd.iter().enumerate() {
                    idle = if qd.abs() > REST { 0.0 } else { idle + self.step };
                    if (round == 1 || !self.closed) && idle <= timeout {
                        share[row] += 1.0 / self.qd.len() as f64;
                    }
                }
            }
        }
        share
    }
}

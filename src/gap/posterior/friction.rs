//! Friction that differs from log to log.

use super::fit::Fit;
use crate::gap::design::Design;

/// Kinds of friction: dry and viscous.
const KINDS: usize = 2;

impl Fit {
    /// Change of the mean friction of a joint since the baseline, over what it usually differs from log to
    /// log: as in any robot, or as the logs of one set show where that is more \[1\]. `is_before` tells
    /// the records of the baseline.
    #[must_use]
    pub(in crate::gap) fn change_of_friction(
        &self,
        design: &Design,
        joint: usize,
        is_before: &[bool],
    ) -> f64 {
        let reduced = &self.reduced[joint];
        let u = reduced.solved.column(0) - reduced.solved.columns(1, self.mean.len()) * &self.mean;
        let change = |kind: usize| {
            let all = design.joints[joint].friction.iter().skip(kind).step_by(KINDS);
            let (before, now): (Vec<_>, Vec<_>) = all.partition(|(record, _)| is_before[*record]);
            let shares = |of: Vec<&(usize, usize)>| -> Vec<f64> {
                of.into_iter().map(|(_, k)| reduced.sizes[*k] * u[*k]).collect()
            };
            change(&shares(before), &shares(now), design.tunables.log_friction)
        };
        (0..KINDS).map(change).fold(0.0, f64::max)
    }
}

/// The difference of two means over that of two single values with the deviation `usual`, or with that
/// within the sets where it is larger.
fn change(before: &[f64], now: &[f64], usual: f64) -> f64 {
    if before.is_empty() || now.is_empty() {
        return 0.0;
    }
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    let squares = |of: &[f64]| of.iter().map(|x| (x - mean(of)).powi(2)).sum::<f64>();
    let [k, m] = [before, now].map(|of| of.len() as f64);
    let within = (squares(before) + squares(now)) / (k + m - 2.0).max(1.0);
    let expected = within.max(usual * usual) * 0.5 * (1.0 / k + 1.0 / m);
    (mean(now) - mean(before)).abs() / expected.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_counts_beside_what_logs_differ_by() {
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(close(change(&[0.0], &[0.03], 0.01), 3.0));
        assert!(close(change(&[], &[0.03], 0.01), 0.0));
        // Logs of one set that differ by ten times the usual make as much of a change usual.
        assert!(change(&[-0.1, 0.1], &[-0.08, 0.12], 0.01) < 1.0);
        assert!(change(&[-0.001, 0.001], &[0.049, 0.051], 0.01) > 5.0);
    }
}

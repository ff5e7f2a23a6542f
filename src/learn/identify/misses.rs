//! Residuals of a model on measured torques.

use nalgebra::DVector;

use super::factors::Factors;

/// Root mean squares; NaN without rows.
#[must_use]
pub(super) fn root_mean(squares: &[f64], rows: &[usize]) -> Vec<f64> {
    squares.iter().zip(rows).map(|(sum, n)| (sum / *n as f64).sqrt()).collect()
}

/// Residuals by joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Misses {
    /// Root mean square of the residuals \[Nm\].
    pub rms: Vec<f64>,
    /// `rms` over the root mean square of the torque \[1\].
    pub relative: Vec<f64>,
}

impl Misses {
    /// The residuals of base parameters β on the samples of `factors`.
    pub(super) fn new(beta: &DVector<f64>, factors: &[Factors]) -> Misses {
        let joints = factors.first().map_or(0, |of| of.layout.columns.len());
        let (mut squares, mut torque, mut rows) =
            (vec![0.0; joints], vec![0.0; joints], vec![0; joints]);
        for of in factors {
            let missed = of.residual_squares(beta, None);
            let counted = of.rows_without(None);
            for joint in 0..joints {
                squares[joint] += missed[joint];
                rows[joint] += counted[joint];
                torque[joint] += of.squares.iter().map(|part| part[joint]).sum::<f64>();
            }
        }
        Misses {
            rms: root_mean(&squares, &rows),
            relative: squares.iter().zip(&torque).map(|(e, t)| (e / t).sqrt()).collect(),
        }
    }

    /// The same torques with the residuals `rms` \[Nm\].
    pub(super) fn with_rms(&self, rms: &[f64]) -> Misses {
        let relative = |(joint, relative): (usize, &f64)| relative * rms[joint] / self.rms[joint];
        Misses {
            rms: rms.to_vec(),
            relative: self.relative.iter().enumerate().map(relative).collect(),
        }
    }
}

//! What a robot takes, fitted to the logs of its baseline.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::powers::Powers;
use crate::arm::robot::Model;

/// Time constants of the meter that are tried \[s\].
const LAGS: [f64; 13] =
    [0.0, 0.002, 0.003, 0.004, 0.006, 0.008, 0.011, 0.016, 0.022, 0.032, 0.045, 0.064, 0.09];
/// Steps of a fit: where the sum is negative depends on what is fitted.
const STEPS: usize = 8;
/// What is told of the losses of a joint that takes no load, of those that do.
const TOLD: f64 = 1e-6;
/// Deviation of the share that is given back, where no joint brakes \[1\].
const GIVEN_BACK: f64 = 0.3;
/// Rows per parameter at least.
const ROWS: usize = 10;

/// Reference of the baseline.
#[derive(Clone)]
pub(super) struct Reference {
    /// Base power \[W\].
    pub base: f64,
    /// Losses by joint \[W/(Nm)²\].
    pub loss: Vec<f64>,
    /// Loss in the drives, of the power that passes through them \[1\].
    through: f64,
    /// Power from the supply, of what the drives need \[1\].
    taken: f64,
    /// Power to the supply, of what the drives give back \[1\].
    pub given_back: f64,
    /// Time constant of the meter \[s\].
    pub lag: f64,
    /// Of what is missed \[W²\].
    pub variance: f64,
    /// Independent samples per row.
    pub independent: f64,
    /// A root of the covariance of the parameters.
    pub root: DMatrix<f64>,
}

/// Products of the columns, each of which is divided by its norm.
struct Products {
    gram: DMatrix<f64>,
    /// With what is missed.
    right: DVector<f64>,
    /// The norms.
    scale: DVector<f64>,
}

impl Reference {
    /// The reference that misses least; `None` of too few rows.
    pub(super) fn new(model: &Model, logs: &[Powers]) -> Option<Reference> {
        let fits = LAGS.iter().filter_map(|lag| Reference::with_lag(model, logs, *lag));
        fits.min_by(|a, b| a.variance.total_cmp(&b.variance))
    }

    fn with_lag(model: &Model, logs: &[Powers], lag: f64) -> Option<Reference> {
        let n = model.dof;
        let count: usize = logs.iter().map(Powers::rows).sum();
        let nominal = model.motors.as_ref().map(|motors| motors.loss_constant.clone());
        let mut reference = Reference {
            base: 0.0,
            loss: nominal.unwrap_or_else(|| vec![0.0; n]),
            through: 0.0,
            taken: 1.0,
            given_back: model.drive.regeneration,
            lag,
            variance: 0.0,
            independent: 1.0,
            root: DMatrix::zeros(0, 0),
        };
        if count < ROWS * reference.parameters() {
            return None;
        }
        for _ in 0..STEPS {
            reference.step(logs)?;
        }
        let missed: Vec<Vec<f64>> = logs.iter().map(|log| reference.missed(log)).collect();
        let sum: f64 = missed.iter().map(|of| of.iter().map(|x| x * x).sum::<f64>()).sum();
        reference.variance = sum / (count - reference.parameters()) as f64;
        let next = missed.iter().flat_map(|of| of.windows(2));
        let memory = next.map(|pair| pair[0] * pair[1]).sum::<f64>() / sum.max(1e-12);
        let memory = memory.clamp(0.0, 0.98);
        reference.independent = (1.0 - memory) / (1.0 + memory);
        reference.root = reference.spread(logs)?;
        Some(reference)
    }

    /// Number of parameters: base, losses by joint and in the drives, the shares that are taken and given
    /// back.
    pub(super) fn parameters(&self) -> usize {
        self.loss.len() + 4
    }

    /// The reference with other parameters.
    pub(super) fn moved(&self, by: &DVector<f64>) -> Reference {
        let mut moved = self.clone();
        let n = self.loss.len();
        moved.base += by[0];
        for (loss, by) in moved.loss.iter_mut().zip(by.iter().skip(1)) {
            *loss += by;
        }
        moved.through += by[n + 1];
        moved.taken += by[n + 2];
        moved.given_back = (moved.given_back + by[n + 3]).clamp(0.0, 1.0);
        moved
    }

    /// A step of Gauss and Newton.
    fn step(&mut self, logs: &[Powers]) -> Option<()> {
        let Products { gram, right, scale } = self.products(logs);
        let moved = Cholesky::new(gram)?.solve(&right).component_div(&scale);
        *self = self.moved(&moved);
        Some(())
    }

    /// A root of the covariance of the parameters.
    fn spread(&self, logs: &[Powers]) -> Option<DMatrix<f64>> {
        let Products { mut gram, scale, .. } = self.products(logs);
        let variance = (self.variance / self.independent).max(f64::MIN_POSITIVE);
        let last = scale.len() - 1;
        gram[(last, last)] += variance / (GIVEN_BACK * scale[last]).powi(2);
        let mut root = Cholesky::new(Cholesky::new(gram)?.inverse())?.l();
        for (mut row, scale) in root.row_iter_mut().zip(scale.iter()) {
            row *= variance.sqrt() / scale;
        }
        Some(root)
    }

    fn products(&self, logs: &[Powers]) -> Products {
        let count = self.parameters();
        let (mut gram, mut right) = (DMatrix::zeros(count, count), DVector::zeros(count));
        for log in logs {
            let columns = self.columns(log);
            gram += columns.tr_mul(&columns);
            right += columns.tr_mul(&DVector::from_vec(self.missed(log)));
        }
        let scale = gram.diagonal().map(|square| square.sqrt().max(1e-12));
        let mut gram = gram.zip_map(&(&scale * scale.transpose()), |x, scale| x / scale);
        // Loads that never vary tell nothing of their losses.
        gram += DMatrix::identity(count, count) * TOLD;
        Products { gram, right: right.component_div(&scale), scale }
    }

    /// What the parameters are multiplied by, row by row, as the meter shows it.
    pub(super) fn columns(&self, log: &Powers) -> DMatrix<f64> {
        let share: Vec<f64> = (0..log.rows()).map(|row| self.share(log, row)).collect();
        let mut all = vec![vec![1.0; log.rows()]];
        all.extend(log.tau.iter().map(|tau| {
            let square = |(tau, share): (&f64, &f64)| share * tau * tau;
            log.lagged(tau.iter().zip(&share).map(square).collect(), self.lag)
        }));
        let sums: Vec<f64> = (0..log.rows()).map(|row| self.sum(log, row)).collect();
        let through = (0..log.rows()).map(|row| share[row] * log.through(row)).collect();
        let taken = sums.iter().map(|sum| sum.max(0.0)).collect();
        let given_back = sums.iter().map(|sum| sum.min(0.0)).collect();
        all.extend([through, taken, given_back].map(|column| log.lagged(column, self.lag)));
        let columns: Vec<DVector<f64>> = all.into_iter().map(DVector::from_vec).collect();
        DMatrix::from_columns(&columns)
    }

    /// Mechanical power and losses \[W\].
    pub(super) fn sum(&self, log: &Powers, row: usize) -> f64 {
        let losses = self.loss.iter().zip(&log.tau).map(|(k, tau)| k * tau[row] * tau[row]);
        log.mechanical(row) + self.through * log.through(row) + losses.sum::<f64>()
    }

    /// Share of it that the supply gives, or takes.
    pub(super) fn share(&self, log: &Powers, row: usize) -> f64 {
        if self.sum(log, row) < 0.0 { self.given_back } else { self.taken }
    }

    /// What the reference misses, row by row \[W\].
    pub(super) fn missed(&self, log: &Powers) -> Vec<f64> {
        let taken = (0..log.rows()).map(|row| self.share(log, row) * self.sum(log, row)).collect();
        let shown = log.lagged(taken, self.lag);
        log.power.iter().zip(shown).map(|(power, shown)| power - self.base - shown).collect()
    }
}

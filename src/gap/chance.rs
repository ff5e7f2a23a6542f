//! What chance alone reaches: the threshold that this motion with this noise has.

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use super::evidence::{Evidence, Given};
use super::search::Search;

/// Measurements that are drawn.
const DRAWS: usize = 40;
/// Share of measurements without any effect in which none may be found.
const CONFIDENT: f64 = 0.98;
/// Share by which the diagonal of the products is raised, so that they have a root.
const RIDGE: f64 = 1e-9;
/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

impl Search<'_, '_> {
    /// The score that the best family reaches in one of 50 measurements of a robot that differs
    /// from its model by noise, its parameters and the model's error alone. \[nats\]
    ///
    /// The largest of many scores is distributed as E. J. Gumbel's law has it (Statistics of
    /// Extremes, 1958), whose two numbers are those of the draws.
    pub(super) fn reached_by_chance(&self) -> f64 {
        let Some(root) = self.evidence.root(RIDGE) else { return 0.0 };
        let mut random = fastrand::Rng::with_seed(1);
        let mut given = self.given(&[]);
        let mut largest = Vec::with_capacity(DRAWS);
        for _ in 0..DRAWS {
            let deviates = DVector::from_fn(root.nrows(), |_, _| normal(&mut random));
            given.measure(&root * deviates);
            largest.push(self.best_alone(&given));
        }
        let mean = largest.iter().sum::<f64>() / DRAWS as f64;
        let variance = largest.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / DRAWS as f64;
        let scale = (6.0 * variance).sqrt() / std::f64::consts::PI;
        mean - scale * (EULER + (-CONFIDENT.ln()).ln())
    }

    fn best_alone(&self, given: &Given) -> f64 {
        let families = (0..self.families.len()).into_par_iter();
        let scores = families.filter_map(|family| self.with(given, &[], family));
        scores.map(|found| found.score).reduce(|| f64::NEG_INFINITY, f64::max)
    }
}

impl Evidence {
    /// Root of the covariance that products of columns and measurement have by chance: that of
    /// the products of the columns.
    fn root(&self, ridge: f64) -> Option<DMatrix<f64>> {
        let mut products = self.products().clone();
        for k in 0..products.nrows() {
            products[(k, k)] += ridge * products[(k, k)] + f64::MIN_POSITIVE.sqrt();
        }
        Some(Cholesky::new(products)?.unpack())
    }
}

/// A standard normal deviate (G. E. P. Box, M. E. Muller 1958).
fn normal(random: &mut fastrand::Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.f64()).cos()
}

//! What chance alone reaches: the threshold that this motion with this noise has.

use rayon::prelude::*;

use super::evidence::Given;
use super::normal::normal;
use super::search::Search;

/// Measurements that are drawn.
const DRAWS: usize = 40;
/// Share of measurements without any effect in which none may be found.
const CONFIDENT: f64 = 0.98;
/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

impl Search<'_, '_> {
    /// The score that the best family reaches in one of 50 measurements of a robot that differs
    /// from its model by noise, its parameters and the model's error alone. \[nats\]
    ///
    /// The largest of many scores is distributed as E. J. Gumbel's law has it (Statistics of
    /// Extremes, 1958), whose two numbers are those of the draws.
    pub(super) fn reached_by_chance(&self) -> f64 {
        let mut random = fastrand::Rng::with_seed(1);
        let mut normal = move || normal(&mut random);
        let noise = self.table.products_with_noise(self.error, DRAWS, &mut normal);
        let products = self.evidence.by_chance(&noise, &mut normal);
        let mut given = self.given(&[]);
        let mut largest = Vec::with_capacity(DRAWS);
        for draw in products.column_iter() {
            given.measure(draw.into_owned());
            largest.push(self.best_alone(&given));
        }
        exceeded_by_few(&largest)
    }

    fn best_alone(&self, given: &Given) -> f64 {
        let scores = self.wanted().into_par_iter().filter_map(|of| self.with(given, &[], of));
        scores.map(|found| found.score).reduce(|| f64::NEG_INFINITY, f64::max)
    }
}

/// What few of such maxima exceed.
fn exceeded_by_few(maxima: &[f64]) -> f64 {
    let count = maxima.len().max(1) as f64;
    let mean = maxima.iter().sum::<f64>() / count;
    let variance = maxima.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
    let scale = (6.0 * variance).sqrt() / std::f64::consts::PI;
    mean - scale * (EULER + (-CONFIDENT.ln()).ln())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draws of Gumbel's law, and how far their quantile may be off, of its scale.
    const MANY: usize = 20_000;
    const NEAR: f64 = 0.1;

    #[test]
    fn one_largest_score_in_fifty_is_beyond() {
        let mut random = fastrand::Rng::with_seed(3);
        let (place, scale) = (-2.0, 1.5);
        let draw = |_| place - scale * (-random.f64().max(f64::MIN_POSITIVE).ln()).ln();
        let maxima: Vec<f64> = (0..MANY).map(draw).collect();
        let exact = place - scale * (-CONFIDENT.ln()).ln();
        assert!((exceeded_by_few(&maxima) - exact).abs() < NEAR * scale);
    }
}

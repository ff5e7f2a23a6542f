//! What chance alone reaches: the threshold that this motion with this noise has.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::evidence::{Evidence, Given};
use super::search::Search;
use super::table::Table;

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

impl Table {
    /// Weighted products of everything with noise, by draw.
    fn products_with_noise(
        &self,
        error: f64,
        draws: usize,
        normal: &mut impl FnMut() -> f64,
    ) -> DMatrix<f64> {
        let columns: Vec<usize> = (0..self.means.len()).collect();
        let places = self.places_of(&columns);
        let mut products = DMatrix::zeros(places.len(), draws);
        for rows in &self.joints {
            let noise = DMatrix::from_fn(rows.len(), draws, |_, _| normal());
            let (part, reached) = rows.products_with(error, |number| places[number], &noise);
            for (row, place) in part.row_iter().zip(reached) {
                let mut to = products.row_mut(place);
                to += row;
            }
        }
        for (k, scale) in self.scales(error).into_iter().enumerate() {
            products.row_mut(1 + k).scale_mut(scale);
        }
        products
    }
}

impl Evidence {
    /// Products of the columns with measurements of noise alone, the parameters being off as they may
    /// be and marginalised.
    fn by_chance(&self, noise: &DMatrix<f64>, normal: &mut impl FnMut() -> f64) -> DMatrix<f64> {
        let count = self.parameter_count();
        let off = DMatrix::from_fn(count, noise.ncols(), |_, _| normal());
        let told = off - noise.rows(1, count);
        let more = self.of_parameters(&told);
        noise.rows(noise.nrows() - more.nrows(), more.nrows()) + more
    }
}

/// A standard normal deviate (G. E. P. Box, M. E. Muller 1958).
fn normal(random: &mut fastrand::Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.f64()).cos()
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::*;

    /// How far columns are apart that are nearly alike.
    const SAME: f64 = 1e-8;
    /// Draws of Gumbel's law, and how far their quantile may be off, of its scale.
    const MANY: usize = 20_000;
    const NEAR: f64 = 0.1;

    /// A difference, two parameters and three columns over some rows, of which two are nearly alike.
    fn rows(random: &mut fastrand::Rng) -> DMatrix<f64> {
        let mut rows = DMatrix::from_fn(30, 6, |_, _| random.f64() - 0.5);
        let alike = rows.column(3) * (1.0 + SAME);
        rows.set_column(4, &alike);
        rows
    }

    #[test]
    fn products_with_noise_are_as_uncertain_as_the_columns_products() {
        let mut random = fastrand::Rng::with_seed(3);
        let rows = rows(&mut random);
        let gram = rows.transpose() * &rows;
        let [means, sds] = [0.0, 1.0].map(|x| DVector::from_element(3, x));
        let evidence = Evidence::new(&gram, 2, means, sds, 0.0, 30);
        let mut normal = || normal(&mut random);
        let noise = rows.transpose() * DMatrix::from_fn(30, MANY, |_, _| normal());
        let drawn = evidence.by_chance(&noise, &mut normal);
        let covariance = &drawn * drawn.transpose() / MANY as f64;
        let exact = evidence.products();
        assert!((covariance - exact).norm() < NEAR * exact.norm());
        // Nothing is where columns alike differ.
        let apart = drawn.row(0) - drawn.row(1);
        assert!(apart.norm() < NEAR * SAME.sqrt() * drawn.row(0).norm());
    }

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

//! A surrogate of a simulated figure: a Gaussian process over the unit cube (C. Rasmussen, C. Williams,
//! Gaussian Processes for Machine Learning, MIT Press 2006, chapters 2, 4 and 5).
//!
//! Its covariance is Matérn's with ν = 5/2, as the energy of a cycle is smooth where the limit that sets
//! the pace stays the same, and has bends where that changes. Lengths by axis and noise are those of
//! largest marginal likelihood.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Most points from which lengths and noise are estimated.
const ESTIMATED_FROM: usize = 200;
/// Lengths that are tried, of the side of the cube.
const LENGTHS: [f64; 7] = [0.15, 0.3, 0.6, 1.2, 2.4, 4.8, 9.6];
/// Standard deviations of the noise that are tried, of that of the figure.
const NOISES: [f64; 5] = [0.003, 0.01, 0.03, 0.1, 0.3];
/// Rounds over all axes of the search for lengths and noise.
const ROUNDS: usize = 3;

/// A surrogate.
pub(super) struct Surrogate {
    points: Vec<Vec<f64>>,
    lengths: Vec<f64>,
    noise: f64,
    mean: f64,
    scale: f64,
    factor: Cholesky<f64, Dyn>,
    /// K⁻¹ y of the standardised figures.
    weights: DVector<f64>,
}

/// Lengths by axis, and noise.
#[derive(Clone)]
struct Shape {
    lengths: Vec<f64>,
    noise: f64,
}

impl Surrogate {
    /// The surrogate of figures at points of the unit cube; `None` for fewer than two points.
    pub(super) fn new(points: &[Vec<f64>], figures: &[f64]) -> Option<Surrogate> {
        let dimension = points.first()?.len();
        let count = figures.len() as f64;
        let mean = figures.iter().sum::<f64>() / count;
        let variance = figures.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let scale = variance.sqrt().max(f64::MIN_POSITIVE);
        let y = DVector::from_iterator(figures.len(), figures.iter().map(|x| (x - mean) / scale));
        let some = points.len().min(ESTIMATED_FROM);
        let (of, y_of) = (&points[..some], y.rows(0, some).into_owned());
        let mut shape = Shape { lengths: vec![1.2; dimension], noise: 0.03 };
        let mut best = evidence(of, &y_of, &shape)?;
        for _ in 0..ROUNDS {
            let before = best;
            for axis in 0..=dimension {
                let tried = if axis < dimension { LENGTHS.as_slice() } else { NOISES.as_slice() };
                for value in tried {
                    let mut other = shape.clone();
                    *other.lengths.get_mut(axis).unwrap_or(&mut other.noise) = *value;
                    let reached = evidence(of, &y_of, &other).filter(|reached| *reached > best);
                    if let Some(reached) = reached {
                        (best, shape) = (reached, other);
                    }
                }
            }
            if best <= before {
                break;
            }
        }
        let factor = Cholesky::new(covariance(points, &shape))?;
        let weights = factor.solve(&y);
        let Shape { lengths, noise } = shape;
        Some(Surrogate { points: points.to_vec(), lengths, noise, mean, scale, factor, weights })
    }

    /// Mean and standard deviation of the figure at a point.
    pub(super) fn at(&self, point: &[f64]) -> [f64; 2] {
        let row = self.points.iter().map(|other| kernel(point, other, &self.lengths));
        let k = DVector::from_iterator(self.points.len(), row);
        let mean = self.mean + self.scale * k.dot(&self.weights);
        let known = self.factor.l_dirty().solve_lower_triangular(&k);
        let known = known.map_or(0.0, |known| known.norm_squared());
        [mean, self.scale * (1.0 + self.noise.powi(2) - known).max(0.0).sqrt()]
    }

    /// The mean alone, which takes less time.
    pub(super) fn mean_at(&self, point: &[f64]) -> f64 {
        let parts = self.points.iter().zip(self.weights.iter());
        let sum: f64 =
            parts.map(|(other, weight)| weight * kernel(point, other, &self.lengths)).sum();
        self.mean + self.scale * sum
    }
}

/// Matérn's covariance, ν = 5/2, for a variance of 1.
fn kernel(a: &[f64], b: &[f64], lengths: &[f64]) -> f64 {
    let squares = a.iter().zip(b).zip(lengths).map(|((a, b), length)| ((a - b) / length).powi(2));
    let r = (5.0 * squares.sum::<f64>()).sqrt();
    (1.0 + r + r * r / 3.0) * (-r).exp()
}

fn covariance(points: &[Vec<f64>], shape: &Shape) -> DMatrix<f64> {
    DMatrix::from_fn(points.len(), points.len(), |i, j| {
        let noise = if i == j { shape.noise.powi(2) } else { 0.0 };
        kernel(&points[i], &points[j], &shape.lengths) + noise
    })
}

/// Logarithm of the marginal likelihood, without its constant.
fn evidence(points: &[Vec<f64>], y: &DVector<f64>, shape: &Shape) -> Option<f64> {
    let factor = Cholesky::new(covariance(points, shape))?;
    let determinant: f64 = factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
    Some(-0.5 * y.dot(&factor.solve(y)) - determinant)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::kinematics::radical_inverse;

    /// Error at points that were not given, of the standard deviation of the figure.
    const ERROR: f64 = 0.1;

    fn figure(x: &[f64]) -> f64 {
        3.0 + (2.0 * x[0]).sin() + 0.5 * (x[1] - 0.3).abs()
    }

    fn points(from: u32, to: u32) -> Vec<Vec<f64>> {
        let axes = |n: u32| [2, 3, 5].map(|base| radical_inverse(n, base)).to_vec();
        (from..to).map(axes).collect()
    }

    #[test]
    fn points_between_are_predicted_within_the_stated_deviation() {
        let given = points(1, 80);
        let figures: Vec<f64> = given.iter().map(|x| figure(x)).collect();
        let surrogate = Surrogate::new(&given, &figures).expect("two points or more");
        let mut within = 0;
        let new = points(200, 300);
        for x in &new {
            let [mean, sd] = surrogate.at(x);
            assert!((mean - figure(x)).abs() < ERROR, "{x:?}: {mean}, not {}", figure(x));
            assert!((mean - surrogate.mean_at(x)).abs() < 1e-9);
            within += usize::from((mean - figure(x)).abs() < 2.0 * sd);
        }
        assert!(within >= 90, "{within} of 100 within two deviations");
    }

    #[test]
    fn a_figure_that_never_changes_is_no_error() {
        let given = points(1, 10);
        let surrogate = Surrogate::new(&given, &[5.0; 9]).expect("two points or more");
        assert!((surrogate.mean_at(&[0.5, 0.5, 0.5]) - 5.0).abs() < 1e-9);
        assert!(Surrogate::new(&given[..1], &[5.0]).is_none() || given.len() > 1);
    }
}

//! Maximisation of a function that is smooth nearly everywhere: BFGS with finite-difference
//! gradients and backtracking (J. Nocedal, S. Wright, "Numerical optimization", 2006, chapter 6; on
//! kinks A. Lewis, M. Overton, "Nonsmooth optimization via quasi-Newton methods", Math. Prog. 141,
//! 2013).

use nalgebra::{DMatrix, DVector};

/// Step of the finite differences.
const DIFFERENCE: f64 = 1e-5;
/// Least gain of a step, as a share of the predicted gain.
const GAIN: f64 = 1e-4;
/// Largest number of halvings of a step.
const HALVINGS: usize = 25;
/// A gain below this counts as small.
const SETTLED: f64 = 1e-4;
/// Number of consecutive small gains that ends the search.
const PATIENCE: usize = 4;

/// The best point within `rounds` rounds from `start`, and its value; each round calls `progress`.
pub(super) fn maximise(
    start: DVector<f64>,
    rounds: usize,
    value: &mut dyn FnMut(&DVector<f64>) -> f64,
    progress: &dyn Fn(),
) -> (DVector<f64>, f64) {
    let n = start.len();
    let mut point = start;
    let mut best = value(&point);
    let mut slope = gradient(&point, best, value);
    let mut inverse = DMatrix::identity(n, n);
    let mut small = 0;
    for _ in 0..rounds {
        let mut direction = &inverse * &slope;
        if direction.dot(&slope) <= 0.0 {
            inverse = DMatrix::identity(n, n);
            direction.clone_from(&slope);
        }
        // The first direction has no scale yet.
        let longest = 0.5 / direction.amax().max(f64::MIN_POSITIVE);
        let mut length = longest.min(1.0);
        let mut next = None;
        for _ in 0..HALVINGS {
            let trial = &point + &direction * length;
            let found = value(&trial);
            if found > best + GAIN * length * slope.dot(&direction) {
                next = Some((trial, found));
                break;
            }
            length *= 0.5;
        }
        progress();
        let Some((trial, found)) = next else {
            if inverse == DMatrix::identity(n, n) {
                break;
            }
            inverse = DMatrix::identity(n, n);
            continue;
        };
        small = if found - best < SETTLED { small + 1 } else { 0 };
        let new_slope = gradient(&trial, found, value);
        let (s, y) = (&trial - &point, &slope - &new_slope);
        let curvature = s.dot(&y);
        if curvature > 1e-12 * s.norm() * y.norm() {
            let rho = 1.0 / curvature;
            let turned = &inverse * &y;
            let scale = rho * (1.0 + rho * y.dot(&turned));
            inverse += &s * s.transpose() * scale
                - (&turned * s.transpose() + &s * turned.transpose()) * rho;
        }
        (point, best, slope) = (trial, found, new_slope);
        if small >= PATIENCE {
            break;
        }
    }
    (point, best)
}

fn gradient(
    point: &DVector<f64>,
    here: f64,
    value: &mut dyn FnMut(&DVector<f64>) -> f64,
) -> DVector<f64> {
    let mut moved = point.clone();
    DVector::from_fn(point.len(), |k, _| {
        moved[k] = point[k] + DIFFERENCE;
        let slope = (value(&moved) - here) / DIFFERENCE;
        moved[k] = point[k];
        slope
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_maximum_of_a_curved_ridge_is_found() {
        let mut rosenbrock =
            |x: &DVector<f64>| -(1.0 - x[0]).powi(2) - 20.0 * (x[1] - x[0] * x[0]).powi(2);
        let start = DVector::from_vec(vec![-1.2, 1.0]);
        let (found, _) = maximise(start, 400, &mut rosenbrock, &|| ());
        assert!((found[0] - 1.0).abs() < 0.05 && (found[1] - 1.0).abs() < 0.1, "{found}");
    }
}

//! The gain of columns whose amplitude is not known.

use nalgebra::{Cholesky, DMatrix, DVector};

/// The gain of columns, from their products `A`, `b`, over the amplitudes that are tried.
pub(super) fn best(
    (a, b): &(DMatrix<f64>, DVector<f64>),
    prior: &[(f64, f64)],
    spread: f64,
) -> f64 {
    let is_fixed = prior.iter().any(|(mean, _)| *mean != 0.0);
    let tried: &[f64] = if is_fixed { &[1.0] } else { &TRIED };
    let gain =
        |amplitude: &f64| gain(a, b, prior, *amplitude) - 0.5 * (amplitude.ln() / spread).powi(2);
    tried.iter().map(gain).fold(f64::NEG_INFINITY, f64::max)
}

/// Amplitudes that are tried, over the usual one.
const TRIED: [f64; 5] = [0.3, 1.0, 3.0, 10.0, 30.0];

/// The gain of columns with some prior.
fn gain(a: &DMatrix<f64>, b: &DVector<f64>, prior: &[(f64, f64)], amplitude: f64) -> f64 {
    let n = prior.len();
    let mean = DVector::from_fn(n, |k, _| prior[k].0);
    let moved = a * &mean;
    let fixed = mean.dot(b) - 0.5 * mean.dot(&moved);
    let left = b - moved;
    let free: Vec<usize> = (0..n).filter(|k| prior[*k].1 > 0.0).collect();
    let sd = |k: usize| amplitude * prior[free[k]].1;
    let scaled = DMatrix::from_fn(free.len(), free.len(), |i, k| {
        sd(i) * sd(k) * a[(free[i], free[k])] + if i == k { 1.0 } else { 0.0 }
    });
    let right = DVector::from_fn(free.len(), |k, _| sd(k) * left[free[k]]);
    let Some(factor) = Cholesky::new(scaled) else { return f64::NEG_INFINITY };
    let log_det: f64 = factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum();
    fixed + 0.5 * right.dot(&factor.solve(&right)) - log_det
}

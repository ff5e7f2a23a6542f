//! Test of residuals for white noise: autocorrelation and the test of G. Ljung and G. Box, "On a
//! measure of lack of fit in time series models", Biometrika 65, 1978.

use super::noise::{Residual, autocovariances};

/// Number of lags, even.
const LAGS: usize = 20;
/// Half width of the 95 % interval of the standard normal distribution.
const INTERVAL: f64 = 1.96;

/// Autocorrelation of the residuals of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Whiteness {
    /// Autocorrelation at lag 1, 2, …
    pub autocorrelation: Vec<f64>,
    /// 95 % bound of the autocorrelation of white noise.
    pub band: f64,
    /// Number of lags outside the bound.
    pub outside: usize,
    /// Q = n (n + 2) Σ ρ²/(n − lag).
    pub ljung_box: f64,
    /// Probability of at least this value for white noise.
    pub p_value: f64,
}

/// The whiteness of chronological residuals; `None` with too few.
#[must_use]
pub(super) fn whiteness(residuals: &[Residual]) -> Option<Whiteness> {
    if residuals.len() < 4 * LAGS {
        return None;
    }
    let covariance = autocovariances(residuals, LAGS, 1.0);
    if covariance[0] <= 0.0 {
        return None;
    }
    let n = residuals.len() as f64;
    let autocorrelation: Vec<f64> = covariance[1..].iter().map(|c| c / covariance[0]).collect();
    let band = INTERVAL / n.sqrt();
    let of = |(lag, rho): (usize, &f64)| rho * rho / (n - (lag + 1) as f64);
    let ljung_box = n * (n + 2.0) * autocorrelation.iter().enumerate().map(of).sum::<f64>();
    Some(Whiteness {
        outside: autocorrelation.iter().filter(|rho| rho.abs() > band).count(),
        p_value: chi_square_beyond(ljung_box),
        autocorrelation,
        band,
        ljung_box,
    })
}

/// P(χ² > x) for [`LAGS`] = 2 m degrees of freedom: e^(−x/2) Σ (x/2)^k / k!, k < m.
fn chi_square_beyond(x: f64) -> f64 {
    let half = 0.5 * x;
    let mut term = (-half).exp();
    let mut sum = 0.0;
    for k in 0..LAGS / 2 {
        sum += term;
        term *= half / (k + 1) as f64;
    }
    sum.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::*;

    /// Number of runs, and the share that the test may reject at 5 %.
    const RUNS: u64 = 400;
    const REFUSED: std::ops::RangeInclusive<f64> = 0.02..=0.08;

    fn noise(seed: u64, memory: f64) -> Vec<Residual> {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut value = 0.0;
        (0..500)
            .map(|i| {
                value = memory * value + (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
                (0, i, value)
            })
            .collect()
    }

    #[test]
    fn the_test_has_its_size_and_rejects_coloured_noise() {
        let refused = |memory: f64| {
            let sure = |seed: &u64| whiteness(&noise(*seed, memory)).unwrap().p_value < 0.05;
            (0..RUNS).filter(sure).count() as f64 / RUNS as f64
        };
        assert!(REFUSED.contains(&refused(0.0)), "{}", refused(0.0));
        assert!(refused(0.4) > 0.99);
    }

    /// 31.41 is the tabulated 95 % quantile for 20 degrees of freedom.
    #[test]
    fn chi_square_tail_matches_the_table() {
        assert!((chi_square_beyond(31.410_43) - 0.05).abs() < 1e-6);
        assert!((chi_square_beyond(0.0) - 1.0).abs() < 1e-12);
    }
}

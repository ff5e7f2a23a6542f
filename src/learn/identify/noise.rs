//! Autocovariances of coloured noise from an autoregressive model.

/// Largest order of the model.
const MAX_ORDER: usize = 24;
/// Longest lag.
const MAX_LAG: usize = 300;
/// An autocovariance below this share of the variance ends the sequence.
const NEGLIGIBLE: f64 = 0.005;
/// Least power spectral density over its mean: the resolution of an empty band is limited.
const EMPTY: f64 = 0.05;
/// Number of frequencies at which the density is evaluated.
const FREQUENCIES: usize = 1024;

/// A residual: block, index of the instant, value.
pub(super) type Residual = (usize, usize, f64);

/// Autocovariances of chronological residuals at lag 0, 1, …, from the autoregressive model of the
/// order that Schwarz's criterion selects. `lost` is the number of fitted parameters.
#[must_use]
pub(super) fn autocovariance(residuals: &[Residual], lost: f64) -> Vec<f64> {
    let n = residuals.len() as f64;
    if residuals.len() < 2 {
        return vec![0.0];
    }
    let correction = n / (n - lost).max(1.0);
    let orders = MAX_ORDER.min(residuals.len() / 20);
    let sample = autocovariances(residuals, orders, correction);
    let model = levinson(&sample, n);
    let mut sequence = extended(&sample, &model);
    // A truncated sequence may have a negative spectral density, and the variance of a parameter
    // would be negative.
    let least = least_density(&sequence);
    sequence[0] += (EMPTY * sequence[0] - least).max(0.0);
    sequence
}

/// The least power spectral density of noise with these autocovariances, relative to white noise of
/// variance 1.
fn least_density(sequence: &[f64]) -> f64 {
    let density = |frequency: usize| -> f64 {
        let step = std::f64::consts::PI * frequency as f64 / FREQUENCIES as f64;
        let tail = sequence.iter().enumerate().skip(1);
        sequence[0] + 2.0 * tail.map(|(lag, c)| c * (step * lag as f64).cos()).sum::<f64>()
    };
    (0..=FREQUENCIES).map(density).fold(f64::INFINITY, f64::min)
}

/// Σ e(t) e(t + lag) / n for lags up to `lags`, of chronological residuals.
#[must_use]
pub(super) fn autocovariances(residuals: &[Residual], lags: usize, correction: f64) -> Vec<f64> {
    let mut sums = vec![0.0; lags + 1];
    for (i, (block, index, value)) in residuals.iter().enumerate() {
        for (other, later, next) in &residuals[i..] {
            if other != block || later - index > lags {
                break;
            }
            sums[later - index] += value * next;
        }
    }
    let n = residuals.len() as f64;
    sums.iter().map(|sum| correction * sum / n).collect()
}

/// Coefficients a of e(t) = Σ aₖ e(t − k) + white noise, of the order with the least BIC.
fn levinson(covariance: &[f64], n: f64) -> Vec<f64> {
    let mut variance = covariance[0];
    let mut a: Vec<f64> = Vec::new();
    let mut best = (n * variance.max(f64::MIN_POSITIVE).ln(), a.clone());
    for order in 1..covariance.len() {
        if variance <= 0.0 {
            break;
        }
        let predicted: f64 = a.iter().enumerate().map(|(k, a)| a * covariance[order - 1 - k]).sum();
        let reflection = (covariance[order] - predicted) / variance;
        let mut next: Vec<f64> =
            a.iter().zip(a.iter().rev()).map(|(a, b)| a - reflection * b).collect();
        next.push(reflection);
        a = next;
        variance *= 1.0 - reflection * reflection;
        let criterion = n * variance.max(f64::MIN_POSITIVE).ln() + n.ln() * order as f64;
        if criterion < best.0 {
            best = (criterion, a.clone());
        }
    }
    best.1
}

/// The autocovariances of the model, up to the last one that is not negligible.
fn extended(sample: &[f64], a: &[f64]) -> Vec<f64> {
    let mut sequence = sample[..=a.len()].to_vec();
    if a.is_empty() {
        return sequence;
    }
    let small = NEGLIGIBLE * sequence[0];
    while sequence.len() < MAX_LAG {
        let last = sequence.len() - 1;
        let next: f64 = a.iter().enumerate().map(|(k, a)| a * sequence[last - k]).sum();
        sequence.push(next);
        let recent = &sequence[sequence.len() - a.len()..];
        if recent.iter().all(|value| value.abs() < small) {
            break;
        }
    }
    sequence
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest error of a sample of 200,000 values, as a share of the variance.
    const SAMPLED: f64 = 0.02;

    fn noise(count: usize, memory: f64) -> Vec<Residual> {
        let mut random = fastrand::Rng::with_seed(7);
        let mut value = 0.0;
        (0..count)
            .map(|i| {
                let white: f64 = (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
                value = memory * value + white;
                (0, i, value)
            })
            .collect()
    }

    #[test]
    fn white_noise_has_no_memory() {
        let found = autocovariance(&noise(200_000, 0.0), 0.0);
        assert!((found[0] - 1.0).abs() < SAMPLED);
        assert!(found[1..].iter().all(|x| x.abs() < SAMPLED), "{found:?}");
    }

    /// Differences of white noise have no power at frequency 0; their mean needs a variance > 0.
    #[test]
    fn sums_of_noise_have_a_positive_variance() {
        let white = noise(20_000, 0.0);
        let rough: Vec<Residual> =
            white.windows(3).map(|w| (0, w[0].1, w[2].2 - 2.0 * w[1].2 + w[0].2)).collect();
        let found = autocovariance(&rough, 0.0);
        let count = 200;
        let of_sum: f64 = (0..count)
            .flat_map(|a| (0..count).map(move |b| usize::abs_diff(a, b)))
            .filter_map(|lag| found.get(lag))
            .sum();
        assert!(of_sum > 0.01 * found[0] * f64::from(count as u32), "{of_sum}");
    }

    #[test]
    fn coloured_noise_has_the_autocovariance_of_its_process() {
        let found = autocovariance(&noise(200_000, 0.8), 0.0);
        let variance = 1.0 / (1.0 - 0.8 * 0.8);
        for (lag, value) in found.iter().enumerate().take(10) {
            let expected = variance * 0.8_f64.powf(lag as f64);
            assert!((value - expected).abs() < SAMPLED * variance, "{lag}: {value} {expected}");
        }
    }
}

//! Noise that is not white: autocovariances, by an autoregressive model.

/// Largest order of the model.
const MAX_ORDER: usize = 24;
/// Longest lag that counts.
const MAX_LAG: usize = 300;
/// An autocovariance below this share of the variance ends the sequence.
const NEGLIGIBLE: f64 = 0.005;

/// A residual with its place: piece of the log, number of the instant, value.
pub(super) type Residual = (usize, usize, f64);

/// Autocovariances of the residuals, which are in the order of time, at lag 0, 1, … of the
/// instants: of the autoregressive model that Schwarz's criterion chooses. `lost` is the
/// number of parameters that were fitted to them.
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
    extended(&sample, &model)
}

/// Σ e(t) e(t + lag) / n for lags up to `lags`, of residuals in the order of time.
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

/// Coefficients a of e(t) = Σ aₖ e(t − k) + white noise, of the order with the least BIC: one
/// that is too high takes what the fit took for memory.
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

/// The autocovariances of the model, as far as they count.
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

    /// Share of the variance by which a sample of 200,000 may miss.
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

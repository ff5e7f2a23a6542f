//! Blocks of cycles in the order of time: how long they have to be for what one cycle has of the last one,
//! and what the mean then varies by.

/// Autocorrelations within this many standard errors count as none (D. N. Politis, J. P. Romano).
const NONE: f64 = 2.0;
/// Standard errors that are added to φ.
const HALF: f64 = 0.5;
/// Lags beyond this are not looked at: the series is long, and its memory short.
const LAGS: usize = 400;
/// Least number of blocks of a side.
const BLOCKS: usize = 6;

/// The block length for the circular block bootstrap of a mean by D. N. Politis and H. White, Econometric
/// Reviews 23 (2004) 53, corrected by A. Patton, Politis and White, 28 (2009) 372.
pub(super) fn block_length(x: &[f64]) -> usize {
    let n = x.len();
    let most = (n / BLOCKS).max(1);
    let r = autocovariances(x, n / 2);
    if most == 1 || r.first().is_none_or(|r| *r <= 0.0) {
        return 1;
    }
    let limit = NONE * ((n as f64).log10() / n as f64).sqrt();
    let run = 5.max((n as f64).log10().sqrt().ceil() as usize);
    let is_small = |lag: usize| r.get(lag).is_none_or(|c| (c / r[0]).abs() < limit);
    let last = (0..r.len()).find(|m| (1..=run).all(|k| is_small(m + k))).unwrap_or(r.len());
    if last == 0 {
        return 1;
    }
    let width = (2 * last).min(r.len() - 1) as f64;
    // The flat-top window.
    let window = |lag: usize| (2.0 * (1.0 - lag as f64 / width)).clamp(0.0, 1.0);
    let (mut level, mut slope) = (r[0], 0.0);
    for (lag, r) in r.iter().enumerate().skip(1) {
        level += 2.0 * window(lag) * r;
        slope += 2.0 * window(lag) * lag as f64 * r;
    }
    let denominator = 4.0 / 3.0 * level * level;
    if denominator <= 0.0 {
        return most;
    }
    let length = (2.0 * slope * slope / denominator).cbrt() * (n as f64).cbrt();
    (length.round() as usize).clamp(1, most)
}

/// n times the variance of the mean of a stationary series: by overlapping circular blocks, or by an
/// autoregression of first order if that says more.
pub(super) fn long_run_variance(x: &[f64], length: usize) -> f64 {
    with_memory(x, length, memory([x]))
}

/// The same for both sides, which have one memory: what one cycle has of the last one is of the robot, not of
/// the period.
pub(super) fn long_run_variances(sides: [&[f64]; 2], lengths: [usize; 2]) -> [f64; 2] {
    let phi = memory(sides);
    [0, 1].map(|side| with_memory(sides[side], lengths[side], phi))
}

fn with_memory(x: &[f64], length: usize, phi: f64) -> f64 {
    let n = x.len() as f64;
    if n < 2.0 {
        return 0.0;
    }
    let plain = autocovariances(x, 0)[0] * n / (n - 1.0);
    (plain * (1.0 + phi) / (1.0 - phi)).max(by_blocks(x, length))
}

/// The coefficient of an autoregression of first order of series, if it is seen.
fn memory<const N: usize>(series: [&[f64]; N]) -> f64 {
    let (mut zero, mut one, mut count, mut bias) = (0.0, 0.0, 0.0, 0.0);
    for x in series.iter().filter(|x| x.len() > 2) {
        let n = x.len() as f64;
        let r = autocovariances(x, 1);
        zero += n * r[0];
        one += n * r[1];
        bias += r[0];
        count += n;
    }
    if zero <= 0.0 {
        return 0.0;
    }
    let (phi, bias) = (one / zero, bias / zero);
    // The estimate is too small by (1 + 3 φ)/n, where a trend has been adjusted for by (2 + 4 φ)/n (M. G. Kendall).
    let corrected = |constant: f64, slope: f64| phi + bias * (constant + slope * phi.max(0.0));
    if corrected(1.0, 3.0) * f64::sqrt(count) <= 1.0 {
        return 0.0;
    }
    // The variance of the mean grows faster than φ: a φ that is too small harms more than one too large.
    let phi = corrected(2.0, 4.0);
    (phi + HALF * ((1.0 - phi * phi).max(0.0) / count).sqrt()).min(0.95)
}

/// The same by overlapping circular blocks alone.
fn by_blocks(x: &[f64], length: usize) -> f64 {
    let n = x.len();
    let mean = x.iter().sum::<f64>() / n as f64;
    let mut sum: f64 = (0..length).map(|i| x[i % n] - mean).sum();
    let mut squares = 0.0;
    for i in 0..n {
        squares += sum * sum;
        sum += x[(i + length) % n] - x[i];
    }
    let freedom = n as f64 / (n as f64 - length as f64).max(1.0);
    freedom * squares / (n as f64 * length as f64)
}

/// n times the variance of the mean of a series of blocks that were drawn.
pub(super) fn drawn_variance(x: &[f64], length: usize) -> f64 {
    let n = x.len();
    let mean = x.iter().sum::<f64>() / n.max(1) as f64;
    let blocks = x.chunks(length);
    let count = n.div_ceil(length) as f64;
    let squares: f64 =
        blocks.map(|block| block.iter().map(|x| x - mean).sum::<f64>().powi(2)).sum();
    squares / n.max(1) as f64 * count / (count - 1.0).max(1.0)
}

/// Autocovariances at the lags 0 to `most`.
fn autocovariances(x: &[f64], most: usize) -> Vec<f64> {
    let n = x.len();
    let mean = x.iter().sum::<f64>() / n.max(1) as f64;
    let most = most.min(n.saturating_sub(1)).min(LAGS);
    let of = |lag: usize| {
        (lag..n).map(|i| (x[i] - mean) * (x[i - lag] - mean)).sum::<f64>() / n.max(1) as f64
    };
    (0..=most).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(phi: f64, n: usize, seed: u64) -> Vec<f64> {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut last = 0.0;
        let mut next = || {
            // Nearly normal.
            last = phi * last + (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
            last
        };
        (0..200).for_each(|_| {
            next();
        });
        (0..n).map(|_| next()).collect()
    }

    #[test]
    fn blocks_are_as_long_as_the_memory() {
        let mean = |phi: f64| {
            let lengths = (0..20).map(|seed| block_length(&series(phi, 400, seed)));
            lengths.sum::<usize>() as f64 / 20.0
        };
        let [none, some, long] = [0.0, 0.4, 0.8].map(mean);
        assert!(none < 4.0 && some > none + 1.0 && long > some + 2.0, "{none} {some} {long}");
    }

    #[test]
    fn the_variance_of_the_mean_counts_the_memory() {
        // n var(mean) = σ²/(1 − φ)² for an autoregression.
        for phi in [0.0, 0.5, 0.7] {
            let found = (0..20).map(|seed| {
                let x = series(phi, 1000, seed);
                long_run_variance(&x, block_length(&x))
            });
            let found = found.sum::<f64>() / 20.0;
            let exact = 1.0 / (1.0 - phi).powi(2);
            assert!((found / exact - 1.0).abs() < 0.2, "{phi}: {found} {exact}");
        }
    }
}

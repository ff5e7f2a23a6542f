//! Populations of a wait's lengths: ready at once, and one or two log-normal ones.
//!
//! Two are told from one by the Bayesian information criterion (Schwarz 1978) on ln of the length.

use super::reference::AT_ONCE_S;
use super::spread::{quantile, sorted};

/// Fewest lengths that are divided, and fewest of one population.
const MIN_VALUES: usize = 20;
const MIN_SHARE: f64 = 0.05;
/// Least deviation of ln of the length.
const LEAST: f64 = 0.02;
const ROUNDS: usize = 200;

/// A population.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Population {
    /// Share of the visits.
    pub share: f64,
    /// Its median, s; 0 of those that are ready at once.
    pub median_s: f64,
    /// Deviation of ln of the length.
    pub deviation: f64,
}

/// The populations of lengths, by rising median.
#[must_use]
pub(super) fn populations(lengths: &[f64]) -> Vec<Population> {
    let logs = sorted(lengths.iter().filter(|x| **x > AT_ONCE_S).map(|x| x.ln()));
    let ready = 1.0 - logs.len() as f64 / lengths.len().max(1) as f64;
    let mut found = Vec::new();
    if ready > 0.0 && !lengths.is_empty() {
        found.push(Population { share: ready, median_s: 0.0, deviation: 0.0 });
    }
    if logs.is_empty() {
        return found;
    }
    let all = normal(&logs, &vec![1.0; logs.len()]);
    let mut parts = vec![all];
    if logs.len() >= MIN_VALUES
        && let Some(two) = divide(&logs)
    {
        let n = logs.len() as f64;
        let of_one = fit(&logs, &[all]) - n.ln();
        // Three more numbers than the two of one law.
        let of_two = fit(&logs, &two) - 2.5 * n.ln();
        let is_small = two.iter().any(|part| part.share < MIN_SHARE);
        if of_two > of_one && !is_small {
            parts = two.to_vec();
        }
    }
    parts.sort_by(|a, b| a.mean.total_cmp(&b.mean));
    found.extend(parts.into_iter().map(|part| Population {
        share: part.share * (1.0 - ready),
        median_s: part.mean.exp(),
        deviation: part.deviation,
    }));
    found
}

/// A normal law with a share.
#[derive(Clone, Copy)]
struct Part {
    share: f64,
    mean: f64,
    deviation: f64,
}

impl Part {
    fn density(&self, x: f64) -> f64 {
        let z = (x - self.mean) / self.deviation;
        self.share * (-0.5 * z * z).exp() / (self.deviation * std::f64::consts::TAU.sqrt())
    }
}

fn normal(values: &[f64], weights: &[f64]) -> Part {
    let sum: f64 = weights.iter().sum();
    let mean = |of: &dyn Fn(f64) -> f64| {
        let pairs = values.iter().zip(weights);
        pairs.map(|(x, w)| w * of(*x)).sum::<f64>() / sum.max(f64::MIN_POSITIVE)
    };
    let centre = mean(&|x| x);
    let deviation = mean(&|x| (x - centre).powi(2)).sqrt().max(LEAST);
    Part { share: sum / values.len() as f64, mean: centre, deviation }
}

/// ln of the likelihood.
fn fit(values: &[f64], parts: &[Part]) -> f64 {
    let density = |x: f64| parts.iter().map(|part| part.density(x)).sum::<f64>();
    values.iter().map(|x| density(*x).max(1e-30).ln()).sum()
}

/// Two laws by expectation and maximisation, from the halves of the sorted values and from the outer
/// quarters.
fn divide(values: &[f64]) -> Option<[Part; 2]> {
    let start = |cut: f64| {
        let limit = quantile(values, cut);
        let low: Vec<f64> = values.iter().map(|x| f64::from(u8::from(*x <= limit))).collect();
        let high: Vec<f64> = low.iter().map(|w| 1.0 - w).collect();
        [normal(values, &low), normal(values, &high)]
    };
    let improved = |mut parts: [Part; 2]| {
        for _ in 0..ROUNDS {
            let share = |x: f64| {
                let [a, b] = [parts[0].density(x), parts[1].density(x)];
                if a + b > 0.0 { a / (a + b) } else { 0.5 }
            };
            let first: Vec<f64> = values.iter().map(|x| share(*x)).collect();
            let second: Vec<f64> = first.iter().map(|w| 1.0 - w).collect();
            parts = [normal(values, &first), normal(values, &second)];
        }
        parts
    };
    let all = [0.1, 0.3, 0.5, 0.7, 0.9].map(|cut| improved(start(cut)));
    all.into_iter().max_by(|a, b| fit(values, a).total_cmp(&fit(values, b)))
}

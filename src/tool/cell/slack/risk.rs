//! How many of the recorded cycles may become longer, and how much later the robot may then come.

/// Confidence that the share of longer cycles stays under the stated risk: one-sided.
const CONFIDENCE: f64 = 0.9;
/// A cycle that gets longer by less than this counts as not longer, s: the scatter of a cycle.
pub(super) const SAME_S: f64 = 0.01;
/// Steps of the bisection of a probability.
const STEPS: usize = 60;

/// The number of cycles among `n` that may become longer, so that with 90 % confidence the share of
/// longer cycles is at most `risk`. `None` if `n` is too small to say so even of none.
#[must_use]
pub fn allowed(n: usize, risk: f64) -> Option<usize> {
    (0..n).take_while(|longer| upper_bound(n, *longer) <= risk).last()
}

/// The number of cycles that a risk needs at least.
#[must_use]
pub fn needed(risk: f64) -> usize {
    ((1.0 - CONFIDENCE).ln() / (-risk).ln_1p()).ceil() as usize
}

/// Upper confidence bound of a share of which `k` of `n` were seen (Clopper and Pearson, 1934).
fn upper_bound(n: usize, k: usize) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..STEPS {
        let p = 0.5 * (low + high);
        if at_most(n, k, p) > 1.0 - CONFIDENCE { low = p } else { high = p }
    }
    high
}

/// Probability of at most `k` successes among `n` of probability `p`.
fn at_most(n: usize, k: usize, p: f64) -> f64 {
    let mut term = (n as f64 * (-p).ln_1p()).exp();
    let mut sum = term;
    for i in 0..k {
        term *= (n - i) as f64 / (i + 1) as f64 * p / (1.0 - p);
        sum += term;
    }
    sum
}

/// How much later the robot may come to each wait, s, so that at most `longer` cycles get longer.
/// `slack`: for each wait and cycle, the time from the robot's coming to the signal, s.
pub(super) fn delays(slack: &[Vec<f64>], longer: usize) -> Vec<f64> {
    let sorted: Vec<Vec<f64>> = slack
        .iter()
        .map(|of_wait| {
            let mut sorted: Vec<f64> = of_wait.iter().map(|s| s.max(0.0)).collect();
            sorted.sort_by(f64::total_cmp);
            sorted
        })
        .collect();
    let at = |rank: usize| -> Vec<f64> {
        sorted.iter().map(|s| s.get(rank).copied().unwrap_or(0.0)).collect()
    };
    // The same rank for all waits: a cycle that is early at one is often early at the others.
    let ranks = 0..=longer;
    let own: Vec<&[f64]> = slack.iter().map(Vec::as_slice).collect();
    let chosen = ranks.rev().map(at).find(|delays| longer_cycles(&own, delays) <= longer);
    chosen.unwrap_or_else(|| vec![0.0; slack.len()])
}

/// The number of cycles that get longer if the robot comes later by `delays` (s).
pub(super) fn longer_cycles(slack: &[&[f64]], delays: &[f64]) -> usize {
    let cycles = slack.first().map_or(0, |of_wait| of_wait.len());
    (0..cycles).filter(|cycle| longer_by(slack, delays, *cycle) > SAME_S).count()
}

/// By how much a cycle gets longer, s.
pub(super) fn longer_by(slack: &[&[f64]], delays: &[f64], cycle: usize) -> f64 {
    let waits = slack.iter().zip(delays);
    waits.map(|(slack, delay)| (delay - slack[cycle].max(0.0)).max(0.0)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_is_that_of_the_tables() {
        // One-sided 90 % bounds: none of 45 is below 5 %, none of 44 is not.
        assert_eq!((needed(0.05), allowed(44, 0.05), allowed(45, 0.05)), (45, None, Some(0)));
        assert!((upper_bound(100, 1) - 0.0383).abs() < 1e-4, "{}", upper_bound(100, 1));
        assert!((upper_bound(20, 3) - 0.3042).abs() < 1e-3, "{}", upper_bound(20, 3));
        assert_eq!(allowed(200, 0.05), Some(5));
    }

    #[test]
    fn early_signals_count_as_the_robot_being_too_late() {
        let one: Vec<f64> = (0..100).map(|i| 2.0 + 0.01 * f64::from(i)).collect();
        let mut other = vec![5.0; 100];
        other[0] = -1.0;
        let slack = [one, other];
        let strict = delays(&slack, 0);
        assert_eq!(strict, [2.0, 0.0]);
        // The same cycle is early at both: one longer cycle allows more at both.
        let one_longer = delays(&slack, 1);
        assert_eq!(one_longer, [2.01, 5.0]);
        let own: Vec<&[f64]> = slack.iter().map(Vec::as_slice).collect();
        assert_eq!(longer_cycles(&own, &one_longer), 1);
        assert!((longer_by(&own, &one_longer, 0) - 5.01).abs() < 1e-12);
    }
}

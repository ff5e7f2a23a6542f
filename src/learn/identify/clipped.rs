//! Detection of clipped torques: constant at a limit of the drive or the recorder while the joint
//! speed changes.

/// Least number of rows at the limit in a run …
const ROWS: usize = 4;
/// … and largest distance of these rows, because noise moves some below the limit.
const CLOSE: usize = 4;
/// Least ratio of rows at the limit to rows at the next value: clipping collects all larger values,
/// a coarse resolution does not.
const PILED: usize = 5;
/// Least change of the joint rate in a run, over the largest rate: at constant speed a torque may
/// be constant without clipping.
const CHANGES: f64 = 0.02;

/// For each joint, the spans of time with clipped torque: first and last time \[s\].
pub(super) type Spans = Vec<Vec<[f64; 2]>>;

/// For each joint, the spans with its torque at the largest or smallest value.
#[must_use]
pub(super) fn clipped(t: &[f64], q: &[Vec<f64>], tau: &[Vec<f64>]) -> Spans {
    q.iter()
        .zip(tau)
        .map(|(q, tau)| {
            let mut spans = at_highest(t, q, tau);
            let mirrored: Vec<f64> = tau.iter().map(|x| -x).collect();
            spans.extend(at_highest(t, q, &mirrored));
            spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
            spans
        })
        .collect()
}

/// The spans folded into one period from `start` on.
#[must_use]
pub(super) fn folded(spans: &Spans, start: f64, period: f64) -> Spans {
    let fold = |[a, b]: &[f64; 2]| {
        let first = start + (a - start).rem_euclid(period);
        let last = first + (b - a).min(period);
        // A span beyond the end of the period continues at its beginning.
        [[first, last], [first - period, last - period]]
    };
    spans.iter().map(|of| of.iter().flat_map(fold).collect()).collect()
}

/// Whether a time is within `reach` \[s\] of a span.
#[must_use]
pub(super) fn is_clipped(spans: &[[f64; 2]], t: f64, reach: f64) -> bool {
    spans.iter().any(|[first, last]| first - reach <= t && t <= last + reach)
}

fn at_highest(t: &[f64], q: &[f64], tau: &[f64]) -> Vec<[f64; 2]> {
    let highest = tau.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let next = tau.iter().copied().filter(|x| *x < highest).fold(f64::NEG_INFINITY, f64::max);
    let count = |value: f64| tau.iter().filter(|x| **x == value).count();
    if highest <= 0.0 || count(highest) < PILED * count(next) {
        return Vec::new();
    }
    let rate = |i: usize| {
        let (a, b) = (i.saturating_sub(1), (i + 1).min(t.len() - 1));
        (q[b] - q[a]) / (t[b] - t[a])
    };
    let fastest = (0..t.len()).map(|i| rate(i).abs()).fold(0.0, f64::max);
    let rows: Vec<usize> = (0..tau.len()).filter(|i| tau[*i] == highest).collect();
    rows.chunk_by(|a, b| b - a <= CLOSE)
        .filter_map(|run| {
            let (begin, end) = (*run.first()?, *run.last()?);
            let changes = (rate(end) - rate(begin)).abs() > CHANGES * fastest;
            (run.len() >= ROWS && changes).then(|| [t[begin], t[end]])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waves() -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let t: Vec<f64> = (0..2000).map(|i| 0.01 * f64::from(i)).collect();
        let q: Vec<f64> = t.iter().map(|t| t.sin()).collect();
        let tau = t.iter().map(|t| -10.0 * t.sin() + 2.0 * (3.0 * t).cos()).collect();
        (t, q, tau)
    }

    #[test]
    fn a_limit_is_seen_and_a_coarse_recorder_is_not() {
        let (t, q, tau) = waves();
        let q = vec![q];
        assert!(clipped(&t, &q, std::slice::from_ref(&tau))[0].is_empty());
        let coarse: Vec<f64> = tau.iter().map(|x| (2.0 * x).round() / 2.0).collect();
        assert!(clipped(&t, &q, &[coarse])[0].is_empty());
        let limited: Vec<f64> = tau.iter().map(|x| x.clamp(-8.0, 8.0)).collect();
        let found = clipped(&t, &q, &[limited]);
        for (t, x) in t.iter().zip(&tau) {
            // A crest with less than four rows beyond the limit may be missed.
            if x.abs() > 8.05 {
                assert!(is_clipped(&found[0], *t, 0.0), "{t} {x}");
            } else if x.abs() < 7.95 {
                assert!(!is_clipped(&found[0], *t, 0.0), "{t} {x}");
            }
        }
    }

    #[test]
    fn constant_speed_has_a_constant_torque() {
        let (t, ..) = waves();
        let q = vec![t.iter().map(|t| (t % 4.0 - 2.0).abs()).collect::<Vec<f64>>()];
        let tau: Vec<f64> = t.iter().map(|t| if t % 4.0 < 2.0 { -3.0 } else { 3.0 }).collect();
        assert!(clipped(&t, &q, &[tau])[0].is_empty());
    }

    #[test]
    fn spans_of_repetitions_fall_on_one() {
        let spans = vec![vec![[11.0, 11.5], [19.8, 20.2]]];
        let found = folded(&spans, 0.0, 10.0);
        for (t, expected) in [(1.2, true), (1.8, false), (9.9, true), (0.1, true), (0.3, false)] {
            assert_eq!(is_clipped(&found[0], t, 0.0), expected, "{t}");
        }
    }
}

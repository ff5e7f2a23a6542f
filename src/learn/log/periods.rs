//! Detection of the repetitions of a motion.

use super::time_shift::vertex;
use super::uniform::range;

/// Largest number of samples in the coarse search.
const COMPARED: usize = 3000;
/// Largest relative difference of repetitions, in the final and in the coarse search.
const SAME: f64 = 0.01;
const NEARLY: f64 = 0.03;
/// Least difference of different motions as a share of a joint's range.
const DIFFERENT: f64 = 0.06;
/// Least share of the moving time that repeats: a log also contains motions before and after.
const PART: f64 = 0.35;
/// Share of the fastest step below which a sample counts as at rest.
const RESTING: f64 = 0.01;
/// Largest difference of positions and of their changes from one repetition to the next, of their
/// ranges; part of the period to both sides over which changes are taken.
const ALIKE: f64 = 0.03;
const BESIDE: usize = 50;
/// Shortest period, in samples.
const SHORTEST: usize = 20;

/// Repetitions in series at equal intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periods {
    /// Duration of a repetition \[s\].
    pub period: f64,
    /// First sample of the first repetition.
    pub first: usize,
    /// Number of whole repetitions.
    pub count: usize,
}

/// The repetitions of `q`, sampled at equal intervals; `None` for fewer than two. `known` is the
/// period \[s\], if it is known.
#[must_use]
pub fn find_periods(q: &[&[f64]], step: f64, known: Option<f64>) -> Option<Periods> {
    let n = q.first()?.len();
    let period = known.or_else(|| search(q, step))?;
    let lag = period / step;
    if !(lag >= SHORTEST as f64 && 2.0 * lag <= n as f64 + 0.5) {
        return None;
    }
    let (first, length) = longest_run(q, lag)?;
    // The last sample of a period is the one before its end.
    let count = ((length as f64 + lag) / lag + 1e-6).floor() as usize;
    (count >= 2).then_some(Periods { period, first, count })
}

/// The lag \[s\] at which the motion repeats.
fn search(q: &[&[f64]], step: f64) -> Option<f64> {
    let n = q[0].len();
    let every = n.div_ceil(COMPARED).max(1);
    let thin: Vec<Vec<f64>> =
        q.iter().map(|x| x.iter().step_by(every).copied().collect()).collect();
    let miss = Misses::new(&thin)?;
    let mut apart = false;
    let mut best: Option<(usize, f64)> = None;
    for lag in 1..=thin[0].len() / 2 {
        let value = miss.at(lag);
        apart |= value > DIFFERENT;
        if !apart || value > NEARLY {
            if best.is_some() {
                break;
            }
            continue;
        }
        if best.is_none_or(|(_, least)| value < least) {
            best = Some((lag, value));
        }
    }
    let (lag, _) = best?;
    // Refinement at the full rate, then by a parabola between samples.
    let whole: Vec<Vec<f64>> = q.iter().map(|x| x.to_vec()).collect();
    let miss = Misses::new(&whole)?;
    let around = (lag * every).saturating_sub(2 * every).max(2)..=(lag + 2) * every;
    let (lag, least) = around
        .filter(|lag| 2 * lag <= n)
        .map(|lag| (lag, miss.at(lag)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    if least > SAME {
        return None;
    }
    let around = [miss.at(lag - 1).powi(2), least * least, miss.at(lag + 1).powi(2)];
    let shift = vertex(around).unwrap_or(0.0);
    // Usually a period has a whole number of samples.
    let shift = if shift.abs() < 0.05 { 0.0 } else { shift };
    Some((lag as f64 + shift.clamp(-0.5, 0.5)) * step)
}

/// Difference of a moving series from itself at a later time.
struct Misses<'a> {
    /// The moving joints, each with its range.
    joints: Vec<(&'a [f64], f64)>,
    /// Samples at which a joint moves.
    moving: Vec<usize>,
}

impl Misses<'_> {
    fn new(q: &[Vec<f64>]) -> Option<Misses<'_>> {
        let ranges: Vec<f64> = q.iter().map(|x| range(x)).collect();
        let largest = ranges.iter().fold(0.0, |m: f64, x| m.max(*x));
        let joints: Vec<(&[f64], f64)> = q
            .iter()
            .zip(&ranges)
            .filter(|(_, range)| **range > 1e-3 * largest && **range > 0.0)
            .map(|(x, range)| (x.as_slice(), *range))
            .collect();
        let count = joints.first()?.0.len();
        let step = |i: usize| {
            joints.iter().map(|(x, range)| (x[i + 1] - x[i]).abs() / range).fold(0.0, f64::max)
        };
        let steps: Vec<f64> = (0..count - 1).map(step).collect();
        let fast = steps.iter().fold(0.0, |m: f64, x| m.max(*x));
        let moving = (0..count - 1).filter(|i| steps[*i] > RESTING * fast).collect();
        Some(Misses { joints, moving })
    }

    /// The [`PART`] quantile of the differences, as shares of the joints' ranges.
    fn at(&self, lag: usize) -> f64 {
        let count = self.joints[0].0.len();
        let mut all: Vec<f64> = self
            .moving
            .iter()
            .filter(|i| **i + lag < count)
            .map(|i| {
                let miss = |(x, range): &(&[f64], f64)| (x[*i] - x[i + lag]).abs() / range;
                self.joints.iter().map(miss).fold(0.0, f64::max)
            })
            .collect();
        if all.is_empty() {
            return f64::INFINITY;
        }
        let place = (PART * all.len() as f64) as usize;
        *all.select_nth_unstable_by(place, f64::total_cmp).1
    }
}

/// Changes of a series over twice `near` samples.
fn changes(x: &[f64], near: usize) -> Vec<f64> {
    x.iter().zip(x.iter().skip(2 * near)).map(|(a, b)| b - a).collect()
}

/// First sample and length of the longest run of samples that repeat after a period.
fn longest_run(q: &[&[f64]], lag: f64) -> Option<(usize, usize)> {
    let n = q[0].len();
    let whole = lag.round() as usize;
    let ranges: Vec<f64> = q.iter().map(|x| range(x)).collect();
    let last = n.checked_sub(whole)?.checked_sub(1)?;
    let near = (whole / BESIDE).max(1);
    let changes: Vec<f64> = q.iter().map(|x| range(&changes(x, near))).collect();
    let back = |i: usize| {
        let [from, to] = [i.saturating_sub(near), (i + near).min(last)];
        q.iter().zip(&ranges).zip(&changes).all(|((x, range), fastest)| {
            // A lag between two samples has an error of up to one step.
            let step = (x[(i + 1).min(n - 1)] - x[i]).abs();
            let miss = |k: usize| x[k] - x[k + whole];
            // Where it starts and stops, a motion may be at the same place with another speed.
            miss(i).abs() <= ALIKE * range.max(1e-6) + step
                && (miss(to) - miss(from)).abs() <= ALIKE * fastest.max(1e-6) + 2.0 * step
        })
    };
    let mut best = (0, 0);
    let mut begin = 0;
    for i in 0..=n - whole {
        if i == n - whole || !back(i) {
            if i - begin > best.1 {
                best = (begin, i - begin);
            }
            begin = i + 1;
        }
    }
    (best.1 > 0).then_some(best)
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::super::periodic_motion::{STEP, log};
    use super::*;

    #[test]
    fn repetitions_are_found_between_rest_and_rest() {
        let log = log();
        let found = find_periods(&[&log.series[0]], STEP, None).unwrap();
        assert!((found.period - 5.0).abs() < 1e-9, "{found:?}");
        assert_eq!(found.count, 5);
        assert!((250..360).contains(&found.first), "{found:?}");
        assert_eq!(find_periods(&[&log.series[0][..700]], STEP, None), None);
    }

    #[test]
    fn rest_has_no_period() {
        assert_eq!(find_periods(&[&[0.5; 1000]], STEP, None), None);
    }
}

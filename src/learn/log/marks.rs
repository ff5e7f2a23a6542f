//! Synchronisation of two recorders of the same run by common marks.
//!
//! A digital output changes while the robot moves. One recorder logs it with the positions, the other with
//! the currents, as a voltage. The times of the changes give offset and rate of the clocks.

use super::channel::Channel;
use super::data::Log;
use super::error::LogError;
use super::uniform::{extremes, interpolated_at, median_step};

/// Least number of changes: fewer are ambiguous.
const MARKS: usize = 3;
/// Largest relative difference of the clock rates.
const PACE: f64 = 0.02;
/// Largest residual of a mark, in sample intervals of the slower recorder.
const OFF: f64 = 2.5;

/// Whether `positions` has positions only, and `other` torques or currents without positions.
#[must_use]
pub fn are_halves(positions: &Log, other: &Log) -> bool {
    let has = |log: &Log, quantity: Channel| {
        log.channels.iter().any(|channel| channel.is_same_quantity(quantity))
    };
    let driven = [Channel::Torque(0), Channel::Current(0), Channel::PhaseCurrent(0, 0)];
    has(positions, Channel::Position(0))
        && !has(other, Channel::Position(0))
        && driven.iter().any(|quantity| has(other, *quantity))
        && !driven.iter().any(|quantity| has(positions, *quantity))
}

/// Two synchronised logs as one.
#[derive(Clone, Debug)]
pub struct Aligned {
    /// The joint log.
    pub log: Log,
    /// Number of common marks.
    pub marks: usize,
    /// Largest residual of a mark \[s\].
    pub worst: f64,
    /// Interval of the slower recorder \[s\]: all of its marks may be late by up to this.
    pub step: f64,
}

/// `other` with the positions of `positions` at its times, synchronised by the marks.
///
/// # Errors
/// Marks are missing or inconsistent.
pub fn aligned(positions: &Log, other: &Log) -> Result<Aligned, LogError> {
    let here = changes(positions);
    let there = changes(other);
    let step = median_step(positions.time()).max(median_step(other.time()));
    // Recorders start and stop independently, so that one may miss marks at its ends.
    let shifts = -there.len().cast_signed()..=here.len().cast_signed();
    let fits: Vec<Clock> = shifts.filter_map(|shift| Clock::fitted(&here, &there, shift)).collect();
    let most = fits
        .iter()
        .filter(|clock| clock.worst <= OFF * step)
        .max_by(|a, b| a.pairs.cmp(&b.pairs).then(b.worst.total_cmp(&a.worst)));
    let Some(&Clock { pace, to, from, pairs, worst }) = most else {
        let nearest = fits.iter().map(|clock| clock.worst).fold(f64::INFINITY, f64::min);
        return Err(if nearest.is_finite() {
            LogError::Unaligned { worst: nearest, step }
        } else {
            LogError::Marks { here: here.len(), there: there.len() }
        });
    };
    let clock: Vec<f64> = other.time().iter().map(|t| to + pace * (t - from)).collect();
    let t = positions.time();
    let (first, last) = (t[0], t[t.len() - 1]);
    let kept: Vec<usize> =
        (0..clock.len()).filter(|i| (first..=last).contains(&clock[*i])).collect();
    let mut log = Log {
        rejected: positions.rejected.iter().chain(&other.rejected).cloned().collect(),
        degrees: positions.degrees.clone(),
        ..other.of_rows(&kept)
    };
    for (channel, values) in log.channels.iter().zip(&mut log.values) {
        if *channel == Channel::Time {
            *values = kept.iter().map(|i| clock[*i]).collect();
        }
    }
    for (channel, values) in positions.channels.iter().zip(&positions.values) {
        if channel.is_motion() {
            log.channels.push(*channel);
            let at = |i: &usize| interpolated_at(t, values, clock[*i]);
            log.values.push(kept.iter().map(at).collect());
        }
    }
    Ok(Aligned { log, marks: pairs, worst, step })
}

/// One clock as a linear function of the other: `here = to + pace (there − from)`.
struct Clock {
    pace: f64,
    to: f64,
    from: f64,
    pairs: usize,
    /// Largest residual of a mark \[s\].
    worst: f64,
}

impl Clock {
    /// The fit that assigns mark `shift` here to mark 0 there; `None` if the marks change in
    /// opposite directions, are too few, or give too different clock rates.
    fn fitted(here: &[Change], there: &[Change], shift: isize) -> Option<Clock> {
        let (first, skipped) = (shift.max(0).cast_unsigned(), (-shift).max(0).cast_unsigned());
        let pairs: Vec<(Change, Change)> =
            here.iter().skip(first).copied().zip(there.iter().skip(skipped).copied()).collect();
        if pairs.len() < MARKS || pairs.iter().any(|(a, b)| a.1 != b.1) {
            return None;
        }
        let n = pairs.len() as f64;
        let to = pairs.iter().map(|(here, _)| here.0).sum::<f64>() / n;
        let from = pairs.iter().map(|(_, there)| there.0).sum::<f64>() / n;
        let apart = || pairs.iter().map(|(here, there)| (here.0 - to, there.0 - from));
        let squares: f64 = apart().map(|(_, t)| t * t).sum();
        let pace = apart().map(|(h, t)| h * t).sum::<f64>() / squares;
        let worst = apart().map(|(h, t)| (h - pace * t).abs()).fold(0.0, f64::max);
        let same = (pace - 1.0).abs() < PACE;
        same.then_some(Clock { pace, to, from, pairs: pairs.len(), worst })
    }
}

/// Time of a mark's change \[s\], and whether it rises.
type Change = (f64, bool);

/// The changes of the mark, interpolated between samples of a voltage.
fn changes(log: &Log) -> Vec<Change> {
    let Some(mark) = log.column(Channel::Sync) else { return Vec::new() };
    let [low, high] = extremes(mark);
    let middle = 0.5 * (low + high);
    let t = log.time();
    let mut times = Vec::new();
    for i in 1..mark.len() {
        let (a, b) = (mark[i - 1] - middle, mark[i] - middle);
        if (a < 0.0) != (b < 0.0) {
            times.push((t[i - 1] + (t[i] - t[i - 1]) * a / (a - b), b > a));
        }
    }
    times
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::super::columns::ColumnMap;
    use super::super::csv::read_csv;
    use super::*;

    fn log(header: &str, step: f64, count: usize, row: impl Fn(f64) -> String) -> Log {
        let mut text = format!("{header}\n");
        for i in 0..count {
            text += &row(step * i as f64);
        }
        read_csv(text.as_bytes(), &ColumnMap::default()).unwrap()
    }

    #[test]
    fn clocks_of_different_pace_are_brought_together() {
        let on = |t: f64| f64::from(u8::from((0.7 * t + 0.02 * t * t) as i64 % 2 == 1));
        let q = |t: f64| (0.9 * t).sin();
        let here = log("t,q1,sync", 0.01, 2000, |t| format!("{t},{},{}\n", q(t), on(t)));
        // The other clock is late by three seconds and a tenth of a percent slow.
        let there = log("t,ia1,ib1,ic1,sync", 0.001, 15000, |t| {
            format!("{t},1,2,3,{}\n", 5.0 * on(3.0 + 1.001 * t))
        });
        assert!(are_halves(&here, &there) && !are_halves(&there, &here));
        let both = aligned(&here, &there).unwrap().log;
        let found = both.column(Channel::Position(0)).unwrap();
        assert!(found.len() > 14_000);
        for (t, found) in there.time().iter().zip(found).step_by(100) {
            assert!((found - q(3.0 + 1.001 * t)).abs() < 0.01, "{t}");
        }
    }

    #[test]
    fn marks_that_do_not_fit_are_refused() {
        let here = log("t,q1,sync", 0.01, 300, |t| format!("{t},0,{}\n", u8::from(t > 1.0)));
        let there = log("t,i1,sync", 0.01, 300, |t| format!("{t},0,{}\n", u8::from(t > 2.0)));
        assert!(matches!(aligned(&here, &there), Err(LogError::Marks { .. })));
    }
}

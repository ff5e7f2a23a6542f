//! Two recorders of one run, brought together by the marks that both have.
//!
//! A digital output changes while the robot moves; one recorder has it beside the positions,
//! the other as a voltage beside the currents. Its changes tell how one clock goes by the
//! other.

use super::channel::Family;
use super::error::LogError;
use super::uniform::{interpolated, median_step};
use super::{Channel, Log};

/// Fewer changes than this say nothing of the speed of a clock.
const MARKS: usize = 2;
/// How far a mark may lie off the line through all, in intervals of the slower recorder.
const OFF: f64 = 2.5;

/// Whether two logs are halves of one: positions here, what drives the motors there.
#[must_use]
pub fn are_halves(positions: &Log, other: &Log) -> bool {
    let has = |log: &Log, family: Family| log.channels.iter().any(|c| c.family() == family);
    let driven = [Family::Torque, Family::Current, Family::PhaseCurrent(0)];
    has(positions, Family::Position)
        && !has(other, Family::Position)
        && driven.iter().any(|family| has(other, *family))
        && !driven.iter().any(|family| has(positions, *family))
}

/// `other` with the positions of `positions` at its own times, as their marks tell.
///
/// # Errors
/// Marks that are missing or do not fit together.
pub fn aligned(positions: &Log, other: &Log) -> Result<Log, LogError> {
    let here = changes(positions);
    let there = changes(other);
    if here.len() < MARKS || here.len() != there.len() {
        return Err(LogError::Marks { here: here.len(), there: there.len() });
    }
    // Time of the first recorder = offset + pace × time of the other.
    let n = here.len() as f64;
    let mean = |x: &[f64]| x.iter().sum::<f64>() / n;
    let (to, from) = (mean(&here), mean(&there));
    let pairs = || here.iter().zip(&there).map(|(h, t)| (h - to, t - from));
    let pace = pairs().map(|(h, t)| h * t).sum::<f64>() / pairs().map(|(_, t)| t * t).sum::<f64>();
    let step = median_step(positions.time()).max(median_step(other.time()));
    let worst = pairs().map(|(h, t)| (h - pace * t).abs()).fold(0.0, f64::max);
    if worst.is_nan() || worst > OFF * step {
        return Err(LogError::Unaligned { worst, step });
    }
    let clock: Vec<f64> = other.time().iter().map(|t| to + pace * (t - from)).collect();
    let t = positions.time();
    let (first, last) = (t[0], t[t.len() - 1]);
    let kept: Vec<usize> =
        (0..clock.len()).filter(|i| (first..=last).contains(&clock[*i])).collect();
    let mut log = Log {
        channels: other.channels.clone(),
        values: other.values.iter().map(|x| kept.iter().map(|i| x[*i]).collect()).collect(),
        rows: kept.iter().map(|i| other.rows[*i]).collect(),
        rejected: positions.rejected.iter().chain(&other.rejected).cloned().collect(),
    };
    for (channel, values) in log.channels.iter().zip(&mut log.values) {
        if *channel == Channel::Time {
            *values = kept.iter().map(|i| clock[*i]).collect();
        }
    }
    for (channel, values) in positions.channels.iter().zip(&positions.values) {
        if matches!(channel.family(), Family::Position | Family::Velocity | Family::Acceleration) {
            log.channels.push(*channel);
            let at = |i: &usize| interpolated_at(t, values, clock[*i]);
            log.values.push(kept.iter().map(at).collect());
        }
    }
    Ok(log)
}

fn interpolated_at(t: &[f64], x: &[f64], at: f64) -> f64 {
    let after = t.partition_point(|t| *t < at);
    let width = t.len().min(4);
    let first = after.saturating_sub(2).min(t.len() - width);
    let part = first..first + width;
    interpolated(&t[part.clone()], &x[part], at, 1.0, 1)[0]
}

/// Times at which the mark changes \[s\], between samples where it is a voltage.
fn changes(log: &Log) -> Vec<f64> {
    let Some(mark) = log.column(Channel::Sync) else { return Vec::new() };
    let (low, high) = mark
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    let middle = 0.5 * (low + high);
    let t = log.time();
    let mut times = Vec::new();
    for i in 1..mark.len() {
        let (a, b) = (mark[i - 1] - middle, mark[i] - middle);
        if (a < 0.0) != (b < 0.0) {
            times.push(t[i - 1] + (t[i] - t[i - 1]) * a / (a - b));
        }
    }
    times
}

#[cfg(test)]
mod tests {
    #![expect(clippy::unwrap_used, reason = "a failed set-up is a failed test")]

    use super::*;
    use crate::log::{ColumnMap, read_csv};

    fn log(header: &str, step: f64, count: usize, row: impl Fn(f64) -> String) -> Log {
        let mut text = format!("{header}\n");
        for i in 0..count {
            text += &row(step * i as f64);
        }
        read_csv(text.as_bytes(), &ColumnMap::default()).unwrap()
    }

    #[test]
    fn clocks_of_different_pace_are_brought_together() {
        let on = |t: f64| f64::from(u8::from((t * 0.7) as i64 % 2 == 1));
        let q = |t: f64| (0.9 * t).sin();
        let here = log("t,q1,sync", 0.01, 2000, |t| format!("{t},{},{}\n", q(t), on(t)));
        // The other clock is late by three seconds and a tenth of a percent slow.
        let there = log("t,ia1,ib1,ic1,sync", 0.001, 15000, |t| {
            format!("{t},1,2,3,{}\n", 5.0 * on(3.0 + 1.001 * t))
        });
        assert!(are_halves(&here, &there) && !are_halves(&there, &here));
        let both = aligned(&here, &there).unwrap();
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

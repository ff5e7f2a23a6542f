//! Removal of implausible rows.

use crate::learn::log::{Channel, Jumps, Log, Rejected, quantile, spikes, stays};

/// Bounds on angle, rate, acceleration, torque and current of any robot, in SI units.
const LARGEST: [f64; 5] = [1e3, 1e3, 1e5, 1e6, 1e4];
/// Jumps of an angle \[rad\]: at most 100 rad/s² for one row, and 0.1 rad in slow logs.
const ANGLES: Jumps = Jumps { least: 1e-3, per_time: 100.0, order: 2, most: 0.1 };
/// Jumps of a rate \[rad/s\].
const RATES: Jumps = Jumps { least: 0.05, per_time: 100.0, order: 1, most: 1.0 };
/// Largest ratio of the median change of an angle that its rate does not explain.
const EXPLAINED: f64 = 0.2;
/// Least ratio of a torque spike to the largest usual torque.
const TORQUE: f64 = 5.0;
/// Quantile of the torques that counts as the largest usual one.
const USUAL: f64 = 0.99;

/// The log without rows that no robot has: impossible values, and positions and rates that
/// contradict the motion around them; and the rejected rows.
#[must_use]
pub fn plausible(log: &Log) -> (Log, Vec<Rejected>) {
    let mut why = impossible(log);
    let t = log.time();
    let good: Vec<usize> = (0..t.len()).filter(|row| why[*row].is_none()).collect();
    let of = |x: &[f64]| -> Vec<f64> { good.iter().map(|row| x[*row]).collect() };
    let t = of(t);
    let again = repeated(log, &good);
    for (channel, x) in log.channels.iter().zip(&log.values) {
        let (joint, name, jumps) = match channel {
            Channel::Position(joint) => (*joint, "q", ANGLES),
            Channel::Velocity(joint) => (*joint, "qd", RATES),
            _ => continue,
        };
        if are_independent(log, joint) {
            continue;
        }
        let x = of(x);
        let mut found = spikes(&t, &x, jumps);
        if let Channel::Position(_) = channel {
            found.extend(stays(&t, &x, &again));
        }
        for (row, reason) in found {
            why[good[row]].get_or_insert_with(|| format!("{name}{} {reason}", joint + 1));
        }
    }
    without(log, why)
}

/// The plausible part of the log without rows of outlying torques, and the rejected rows.
#[must_use]
pub fn cleaned(log: &Log) -> (Log, Vec<Rejected>) {
    let (log, mut rejected) = plausible(log);
    let mut why = vec![None; log.rows.len()];
    for (channel, values) in log.channels.iter().zip(&log.values) {
        if let Channel::Torque(joint) = channel {
            torques(values, *joint, &mut why);
        }
    }
    let (log, outlying) = without(&log, why);
    rejected.extend(outlying);
    rejected.sort_by_key(|rejected| rejected.row);
    (log, rejected)
}

/// The log without the rows that have a reason.
fn without(log: &Log, why: Vec<Option<String>>) -> (Log, Vec<Rejected>) {
    let kept: Vec<usize> = (0..why.len()).filter(|row| why[*row].is_none()).collect();
    let rejected = why
        .into_iter()
        .enumerate()
        .filter_map(|(row, why)| Some(Rejected { row: log.rows[row], reason: why? }))
        .collect();
    (log.of_rows(&kept), rejected)
}

/// The reasons of rows with values that no robot has.
fn impossible(log: &Log) -> Vec<Option<String>> {
    let mut why: Vec<Option<String>> = vec![None; log.rows.len()];
    for (channel, values) in log.channels.iter().zip(&log.values) {
        let (limit, name) = match channel {
            Channel::Position(joint) => (LARGEST[0], format!("q{}", joint + 1)),
            Channel::Velocity(joint) => (LARGEST[1], format!("qd{}", joint + 1)),
            Channel::Acceleration(joint) => (LARGEST[2], format!("qdd{}", joint + 1)),
            Channel::Torque(joint) => (LARGEST[3], format!("tau{}", joint + 1)),
            Channel::Current(joint) => (LARGEST[4], format!("i{}", joint + 1)),
            Channel::PhaseCurrent(joint, phase) => {
                (LARGEST[4], format!("i{}{}", ["a", "b", "c"][(*phase).min(2)], joint + 1))
            }
            _ => continue,
        };
        for (why, value) in why.iter_mut().zip(values) {
            if why.is_none() && value.abs() > limit {
                *why = Some(format!("{name} is {value:e}, which no robot has"));
            }
        }
    }
    why
}

/// Which of these rows have the positions of the row before.
fn repeated(log: &Log, rows: &[usize]) -> Vec<bool> {
    let q = log.of_joints(Channel::Position).unwrap_or_default();
    let is_same = |pair: &[usize]| q.iter().all(|q| q[pair[0]] == q[pair[1]]);
    [false].into_iter().chain(rows.windows(2).map(is_same)).collect()
}

/// Whether the rows of a joint are states of their own: its rates and accelerations are logged, and
/// its positions do not follow from the rates.
fn are_independent(log: &Log, joint: usize) -> bool {
    let column = |channel: fn(usize) -> Channel| log.column(channel(joint));
    let (Some(q), Some(qd), Some(_)) =
        (column(Channel::Position), column(Channel::Velocity), column(Channel::Acceleration))
    else {
        return false;
    };
    let t = log.time();
    let change = |k: usize| q[k + 1] - q[k];
    let explained = |k: usize| 0.5 * (qd[k] + qd[k + 1]) * (t[k + 1] - t[k]);
    let intervals = || 0..q.len().saturating_sub(1);
    let usual = quantile(intervals().map(|k| change(k).abs()), 0.5);
    let missed = quantile(intervals().map(|k| (change(k) - explained(k)).abs()), 0.5);
    missed >= EXPLAINED * usual
}

fn torques(tau: &[f64], joint: usize, why: &mut [Option<String>]) {
    let usual = quantile(tau.iter().map(|tau| tau.abs()), USUAL);
    for (why, value) in why.iter_mut().zip(tau) {
        if usual > 0.0 && value.abs() > TORQUE * usual {
            why.get_or_insert_with(|| {
                format!("tau{} is {value}, far beyond all others", joint + 1)
            });
        }
    }
}

//! Removal of implausible rows.

use crate::learn::log::{Channel, Log, Rejected, quantile};

/// Bounds on angle, rate, acceleration, torque and current of any robot, in SI units.
const LARGEST: [f64; 5] = [1e3, 1e3, 1e5, 1e6, 1e4];
/// Least distance of a spike from the line between its neighbours \[rad\] …
const SPIKE: f64 = 0.1;
/// … and its least ratio to the median distance.
const UNUSUAL: f64 = 30.0;
/// Least ratio of a torque spike to the largest usual torque.
const TORQUE: f64 = 5.0;
/// Quantile of the torques that counts as the largest usual one.
const USUAL: f64 = 0.99;

/// The log without implausible rows, and the rejected rows.
#[must_use]
pub fn cleaned(log: &Log) -> (Log, Vec<Rejected>) {
    let n = log.rows.len();
    let mut why: Vec<Option<String>> = vec![None; n];
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
    let good: Vec<usize> = (0..n).filter(|i| why[*i].is_none()).collect();
    for (channel, values) in log.channels.iter().zip(&log.values) {
        match channel {
            Channel::Position(joint) => spikes(values, &good, *joint, &mut why),
            Channel::Torque(joint) => torques(values, &good, *joint, &mut why),
            _ => {}
        }
    }
    let kept: Vec<usize> = (0..n).filter(|i| why[*i].is_none()).collect();
    if kept.len() == n {
        return (log.clone(), Vec::new());
    }
    let rejected = why
        .into_iter()
        .enumerate()
        .filter_map(|(i, why)| Some(Rejected { row: log.rows[i], reason: why? }))
        .collect();
    (log.of_rows(&kept), rejected)
}

/// Marks single angles far from their neighbours.
fn spikes(q: &[f64], good: &[usize], joint: usize, why: &mut [Option<String>]) {
    let off = |w: &[usize]| (q[w[1]] - 0.5 * (q[w[0]] + q[w[2]])).abs();
    let usual = quantile(good.windows(3).map(off), 0.5);
    for w in good.windows(3) {
        let here = off(w);
        // The neighbours of a spike deviate by half of it.
        let between = (q[w[2]] - q[w[0]]).abs();
        if here > SPIKE && here > UNUSUAL * usual && between < 0.5 * here {
            let value = q[w[1]];
            why[w[1]] = Some(format!("q{} jumps to {value} for one row", joint + 1));
        }
    }
}

fn torques(tau: &[f64], good: &[usize], joint: usize, why: &mut [Option<String>]) {
    let usual = quantile(good.iter().map(|i| tau[*i].abs()), USUAL);
    for i in good {
        let value = tau[*i];
        if usual > 0.0 && value.abs() > TORQUE * usual && why[*i].is_none() {
            let text = format!("tau{} is {value}, far beyond all others", joint + 1);
            why[*i] = Some(text);
        }
    }
}

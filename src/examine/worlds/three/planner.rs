//! How the controller runs a program: jerk-limited moves, corners by overlap, waits, servo lag.

use super::arm::Arm;
use super::motion::{STEP, shared};
use super::profile::{Limits, Profile};
use super::program::path;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::program::Move;
use crate::examine::worlds::random::Rng;

/// How a controller runs programs, and what faults change of it.
#[derive(Clone, Debug)]
pub(super) struct Tuning {
    pub(super) zone: f64,
    pub(super) acceleration: Row,
    pub(super) speed: f64,
    /// Speed that the tool never passes \[m/s\].
    pub(super) cap: f64,
    /// Lag of the servos by joint \[s\].
    pub(super) lag: Row,
    /// Pure delay of all positions \[s\].
    pub(super) delay: f64,
    /// A wait that is not in the program.
    pub(super) wait: Option<Wait>,
    /// Time in which the acceleration builds up \[s\].
    pub(super) ramp: f64,
    /// Scatter of the times at which instructions start \[s\].
    pub(super) scatter: f64,
}

/// A wait that is not in the program.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wait {
    pub(super) after: usize,
    /// Duration \[s\].
    pub(super) time: f64,
    /// Its scatter from cycle to cycle, share.
    pub(super) scatter: f64,
    /// Whether the instruction counts as running meanwhile.
    pub(super) running: bool,
}

/// One row on the grid: angles \[rad\], instruction (0 for a wait), cycle from 1.
pub(super) type Step = (Row, usize, usize);

/// A move with its times in a cycle.
struct Leg {
    from: Row,
    to: Row,
    profile: Profile,
    begin: f64,
    end: f64,
    /// When the log shows the next instruction.
    handover: f64,
}

/// Times of the moves of a cycle, and its duration \[s\].
fn legs(arm: &Arm, moves: &[Move], tuning: &Tuning, rng: &mut Rng) -> (Vec<Leg>, f64) {
    let mut from = moves.last().map_or([0.0; MAX], |last| last.to);
    let mut out: Vec<Leg> = Vec::new();
    let mut begin = 0.0;
    for (k, step) in moves.iter().enumerate() {
        let length = path(arm, &from, &step.to).max(1e-4);
        let mut change = [0.0; MAX];
        for i in 0..arm.axes() {
            change[i] = step.to[i] - from[i];
        }
        let mut limited = arm.clone();
        for (limit, factor) in limited.acceleration.iter_mut().zip(tuning.acceleration) {
            *limit *= factor;
        }
        let Limits { rate, acceleration, jerk } = shared(&limited, &change, 0.95, tuning.ramp);
        let wanted = (tuning.speed * step.speed).min(tuning.cap);
        let rate = rate.min(wanted / length);
        let profile = Profile::new(1.0, &Limits { rate, acceleration, jerk });
        let end = begin + profile.duration();
        let extra = tuning.wait.filter(|wait| wait.after == k);
        let next = moves.get(k + 1).map(|next| path(arm, &step.to, &next.to));
        let radius = match (next, extra) {
            (Some(next), None) => (tuning.zone * step.zone).min(0.5 * length).min(0.5 * next),
            _ => 0.0,
        };
        let corner = begin + reach(&profile, 1.0 - radius / length);
        let jitter = tuning.scatter * rng.unit();
        let stay = step.wait
            + extra.map_or(0.0, |wait| wait.time * (1.0 + wait.scatter * rng.between(-1.0, 1.0)));
        let running = extra.is_some_and(|wait| wait.running);
        let handover = if radius > 0.0 {
            0.5 * (corner + end)
        } else if running {
            end + stay - step.wait
        } else {
            end
        };
        out.push(Leg { from, to: step.to, profile, begin, end, handover });
        begin = if radius > 0.0 { corner + jitter } else { end + stay + jitter };
        from = step.to;
    }
    (out, begin)
}

/// The time \[s\] at which a profile is at a share of its distance of 1: bisection.
fn reach(profile: &Profile, share: f64) -> f64 {
    let (mut low, mut high) = (0.0, profile.duration());
    if share >= 1.0 {
        return high;
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if profile.at(middle)[0] < share {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// Runs a program some times.
pub(super) fn execute(
    arm: &Arm,
    moves: &[Move],
    tuning: &Tuning,
    cycles: usize,
    rng: &mut Rng,
) -> Vec<Step> {
    let mut rows: Vec<Step> = Vec::new();
    let mut start = 0.0;
    for cycle in 1..=cycles {
        let (legs, duration) = legs(arm, moves, tuning, rng);
        let home = moves.last().map_or([0.0; MAX], |last| last.to);
        while (rows.len() as f64) * STEP < start + duration {
            let time = rows.len() as f64 * STEP - start;
            let mut q = home;
            let mut running = 0;
            let mut given = false;
            for (k, leg) in legs.iter().enumerate() {
                if leg.begin > time {
                    break;
                }
                let share = if time >= leg.end { 1.0 } else { leg.profile.at(time - leg.begin)[0] };
                for i in 0..arm.axes() {
                    q[i] += share * (leg.to[i] - leg.from[i]);
                }
                if time < leg.handover && !given {
                    running = k + 1;
                    given = true;
                }
            }
            rows.push((q, running, cycle));
        }
        start += duration;
    }
    servo(&mut rows, arm.axes(), tuning);
    rows
}

/// Delay and lag of the servos over the rows.
fn servo(rows: &mut [Step], axes: usize, tuning: &Tuning) {
    let late = (tuning.delay / STEP).round() as usize;
    for i in 0..axes {
        let reference: Vec<f64> = rows.iter().map(|row| row.0[i]).collect();
        let ratio = tuning.lag[i].max(1e-6) / STEP;
        let keep = (-1.0 / ratio).exp();
        let now = 1.0 - ratio * (1.0 - keep);
        let old = ratio * (1.0 - keep) - keep;
        let first = reference.first().copied().unwrap_or(0.0);
        let (mut state, mut before) = (first, first);
        for (k, row) in rows.iter_mut().enumerate() {
            let input = reference.get(k.saturating_sub(late)).copied().unwrap_or(first);
            state = keep * state + old * before + now * input;
            before = input;
            row.0[i] = state;
        }
    }
}

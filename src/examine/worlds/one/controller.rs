//! A controller that runs a program of joint moves: speeds of the tool, limits of the axes, corners
//! that are blended, waits, and servos that lag.

use super::arm::Arm;
use super::dynamics::pose;
use super::profile::Profile;
use crate::examine::worlds::model::{M3, MAX, Row, V3};
use crate::examine::worlds::program::Move;

/// Step of the motion \[s\].
pub(super) const TICK: f64 = 0.002;
/// Points at which the path of the tool between two targets is measured.
const POINTS: usize = 12;
/// Speed of reorientation \[rad/s\]: 500 °/s, as in predefined speeds of RAPID.
const REORIENTATION: f64 = 8.727;
/// Share of the time to full acceleration that the jerk takes.
const JERK_SHARE: f64 = 0.4;

/// What the controller makes of a program, over what it should.
#[derive(Clone, Debug)]
pub(super) struct Tuning {
    pub(super) speed: f64,
    /// Most speed of the tool \[m/s\].
    pub(super) ceiling: f64,
    pub(super) acceleration: Row,
    /// Factor of the radius of corners.
    pub(super) zone: f64,
    /// Factor of the time for which two moves overlap in a corner.
    pub(super) overlap: f64,
    /// Lag of the servos \[s\], by axis.
    pub(super) lag: Row,
    /// Whether servos lag as a system of second order.
    pub(super) second: bool,
    /// Extra waits \[s\] after a move, by cycle: (move, one for each cycle).
    pub(super) waits: Option<(usize, Vec<f64>)>,
}

/// Motion of a program.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    /// Angles \[rad\], number of the move, from 1 (0 in waits), and of the cycle, from 1, every [`TICK`].
    pub(super) rows: Vec<(Row, usize, usize)>,
    pub(super) starts: Vec<usize>,
    /// Duration of each move of the first cycle \[s\].
    pub(super) durations: Vec<f64>,
}

/// A planned move.
struct Planned {
    delta: Row,
    profile: Profile,
    length: f64,
}

/// Length of the tool's path \[m\] and angle of its turn \[rad\] between two targets.
fn way(arm: &Arm, from: &Row, to: &Row) -> (f64, f64) {
    let (mut length, mut last) = (0.0, None);
    let mut turned = 0.0;
    for k in 0..=POINTS {
        let x = k as f64 / POINTS as f64;
        let mut q = [0.0; MAX];
        for j in 0..arm.count() {
            q[j] = from[j] + x * (to[j] - from[j]);
        }
        let here = pose(arm, &q);
        let frame = here.turn[arm.count() - 1];
        if let Some((place, before)) = last {
            let step: V3 = here.flange - place;
            length += step.norm();
            let between: M3 = frame * M3::transpose(&before);
            turned += (0.5 * (between.trace() - 1.0)).clamp(-1.0, 1.0).acos();
        }
        last = Some((here.flange, frame));
    }
    (length, turned)
}

fn plan(arm: &Arm, from: &Row, order: &Move, tuning: &Tuning) -> Planned {
    let (length, turned) = way(arm, from, &order.to);
    let tool = (order.speed * tuning.speed).min(tuning.ceiling);
    let mut v = (tool / length.max(1e-6)).min(REORIENTATION * tuning.speed / turned.max(1e-6));
    let mut a = f64::MAX;
    let mut delta = [0.0; MAX];
    for j in 0..arm.count() {
        delta[j] = order.to[j] - from[j];
        let size = delta[j].abs().max(1e-6);
        v = v.min(tuning.speed * arm.velocity[j] / size);
        a = a.min(tuning.acceleration[j] * arm.acceleration[j] / size);
    }
    Planned { delta, profile: Profile::new(v, a, a * a / (JERK_SHARE * v)), length }
}

/// Start of each move, of the next move's blend, and of its end \[s\].
struct Timed {
    start: f64,
    end: f64,
    switch: f64,
    number: usize,
    cycle: usize,
    delta: Row,
    profile: Profile,
}

/// Lays all moves of all cycles in time. The last move of a cycle stops.
fn schedule(
    arm: &Arm,
    home: &Row,
    program: &[Move],
    tuning: &Tuning,
    cycles: usize,
) -> (Vec<Timed>, f64) {
    let mut from = *home;
    let planned: Vec<Planned> = program
        .iter()
        .map(|order| {
            let out = plan(arm, &from, order, tuning);
            from = order.to;
            out
        })
        .collect();
    let (mut out, mut t) = (Vec::new(), 0.0);
    for cycle in 0..cycles {
        for (k, (order, part)) in program.iter().zip(&planned).enumerate() {
            let end = t + part.profile.duration;
            let mut next = end;
            if order.zone > 0.0
                && let Some(after) = planned.get(k + 1)
            {
                let radius =
                    (order.zone * tuning.zone).min(0.5 * part.length).min(0.5 * after.length);
                next = t + part.profile.when(1.0 - radius / part.length.max(1e-9));
                let most = 0.5 * part.profile.duration.min(after.profile.duration);
                next = end - ((end - next) * tuning.overlap).min(most.max(end - next));
            }
            out.push(Timed {
                start: t,
                end,
                switch: 0.5 * (next + end),
                number: k + 1,
                cycle: cycle + 1,
                delta: part.delta,
                profile: part.profile.clone(),
            });
            let extra = tuning.waits.as_ref().map_or(0.0, |(number, waits)| {
                if *number == k { waits.get(cycle).copied().unwrap_or(0.0) } else { 0.0 }
            });
            t = next + if order.zone > 0.0 { 0.0 } else { order.wait + extra };
        }
    }
    (out, t)
}

/// Runs a program some times from its home.
pub(super) fn run(
    arm: &Arm,
    home: &Row,
    program: &[Move],
    tuning: &Tuning,
    cycles: usize,
) -> Motion {
    let (timed, end) = schedule(arm, home, program, tuning, cycles);
    let count = (end / TICK).ceil() as usize;
    let mut out = Motion {
        durations: timed.iter().take(program.len()).map(|part| part.end - part.start).collect(),
        ..Motion::default()
    };
    let (mut done, mut base) = (0, *home);
    let mut lagged = *home;
    let mut rate = [0.0; MAX];
    for tick in 0..count {
        let t = tick as f64 * TICK;
        while timed.get(done).is_some_and(|part| part.end <= t) {
            for j in 0..MAX {
                base[j] += timed[done].delta[j];
            }
            done += 1;
        }
        let mut q = base;
        for part in timed.iter().skip(done).take_while(|part| part.start <= t) {
            let s = part.profile.at(t - part.start).0;
            for j in 0..MAX {
                q[j] += part.delta[j] * s;
            }
        }
        for j in 0..arm.count() {
            follow(&mut lagged[j], &mut rate[j], q[j], (tuning.lag[j], tuning.second));
        }
        // The move that runs: the first whose switch is still to come, once it has started.
        let running = timed.iter().skip(done.saturating_sub(1)).find(|part| t < part.switch);
        let command = running.map_or(0, |part| if t >= part.start { part.number } else { 0 });
        let cycle = running.map_or(cycles, |part| {
            if t >= part.start || part.number > 1 { part.cycle } else { (part.cycle - 1).max(1) }
        });
        if out.rows.last().is_none_or(|row| row.2 != cycle) {
            out.starts.push(tick);
        }
        out.rows.push((lagged, command, cycle));
    }
    out
}

/// One tick of a servo: of first order, exactly, or of second order with the damping 1.
fn follow(x: &mut f64, rate: &mut f64, goal: f64, servo: (f64, bool)) {
    let (lag, second) = servo;
    if lag <= 0.0 {
        *x = goal;
    } else if second {
        // Two equal lags in line have the same delay as one of twice the time.
        let keep = (-2.0 * TICK / lag).exp();
        let middle = *x + *rate;
        let moved = goal + (middle - goal) * keep;
        *x = moved + (*x - moved) * keep;
        *rate = moved - *x;
    } else {
        *x = goal + (*x - goal) * (-TICK / lag).exp();
    }
}

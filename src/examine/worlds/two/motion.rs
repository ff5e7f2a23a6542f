//! Reference motions: tables of angles, rates and accelerations on the grid of the controller.

use crate::examine::worlds::model::{MAX, Row};
use std::f64::consts::TAU;

use super::robot::Robot;
use crate::examine::worlds::random::Rng;

/// Grid of the interpolator \[s\].
pub(super) const GRID: f64 = 1e-3;

/// A motion that may be repeated: it ends where it begins.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    /// Angles \[rad\].
    pub(super) q: Vec<Row>,
    /// Rates \[rad/s\].
    pub(super) v: Vec<Row>,
    /// Accelerations \[rad/s²\].
    pub(super) a: Vec<Row>,
}

/// Shapes of motions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Fourier,
    /// Moves with trapezoidal speed, and dwells.
    Trapezoid,
    /// Moves with smooth (degree seven) profiles, and dwells.
    SCurve,
    Chirp,
    /// Slow moves through most of the range.
    Slow,
    /// Smooth moves with long dwells.
    Waits,
}

impl Motion {
    /// Duration \[s\].
    pub(super) fn period(&self) -> f64 {
        self.q.len() as f64 * GRID
    }

    /// Angles, rates and accelerations at a time \[s\] of the repeated motion, by linear interpolation.
    pub(super) fn at(&self, time: f64) -> (Row, Row, Row) {
        let count = self.q.len().max(1);
        let place = (time / GRID).rem_euclid(count as f64);
        let k = (place as usize).min(count - 1);
        let next = (k + 1) % count;
        let share = place - k as f64;
        let between = |x: &[Row]| {
            let mut out = [0.0; MAX];
            if let (Some(a), Some(b)) = (x.get(k), x.get(next)) {
                for i in 0..MAX {
                    out[i] = a[i] + share * (b[i] - a[i]);
                }
            }
            out
        };
        (between(&self.q), between(&self.v), between(&self.a))
    }

    pub(super) fn thinned(&self, count: usize) -> Vec<(Row, Row, Row)> {
        let step = (self.q.len() / count.max(1)).max(1);
        let rows = self.q.iter().zip(&self.v).zip(&self.a);
        rows.step_by(step).map(|((q, v), a)| (*q, *v, *a)).collect()
    }

    fn empty(count: usize) -> Self {
        let zero = vec![[0.0; MAX]; count];
        Self { q: zero.clone(), v: zero.clone(), a: zero }
    }
}

/// Longest dwell between two moves \[s\], and where a motion waits.
const LONGEST_DWELL: (f64, f64) = (0.6, 2.5);

/// Where the joints of a case move: middles and half ranges \[rad\].
pub(super) type Rooms = [(f64, f64); MAX];

/// Draws where the joints of a case move.
pub(super) fn rooms(robot: &Robot, rng: &mut Rng) -> Rooms {
    let mut out = [(0.0, 0.0); MAX];
    for (i, room) in out.iter_mut().enumerate().take(robot.arm.n()) {
        let half = 0.5 * (robot.high[i] - robot.low[i]);
        let width = half.min(2.2) * rng.between(0.6, 0.9);
        let aside = (half - width).min(0.6) * rng.between(-1.0, 1.0);
        *room = (0.5 * (robot.high[i] + robot.low[i]) + aside, width);
    }
    out
}

/// Draws a motion of about `period` seconds (rounded to the grid).
pub(super) fn draw(
    robot: &Robot,
    shape: Shape,
    period: f64,
    rooms: &Rooms,
    rng: &mut Rng,
) -> Motion {
    // Each motion uses most of its room.
    let rooms = &rooms.map(|(middle, width)| (middle, width * rng.between(0.8, 1.0)));
    let hurry = rng.between(0.5, 0.95);
    match shape {
        Shape::Fourier => fourier(robot, period, hurry, rooms, rng),
        Shape::Chirp => chirp(robot, period, hurry, rooms, rng),
        Shape::Trapezoid | Shape::SCurve | Shape::Waits => {
            moves(robot, shape, (period, hurry), rooms, rng)
        }
        Shape::Slow => moves(robot, shape, (period, rng.between(0.08, 0.25)), rooms, rng),
    }
}

/// Share to which a signal must be reduced so that range, speed and acceleration are kept.
fn reduction(robot: &Robot, i: usize, width: f64, hurry: f64, motion: &Motion) -> f64 {
    let most = |x: &[Row]| x.iter().map(|row| row[i].abs()).fold(1e-9, f64::max);
    (width / most(&motion.q))
        .min(hurry * robot.speed[i] / most(&motion.v))
        .min(hurry * robot.acceleration[i] / most(&motion.a))
}

fn fit(robot: &Robot, i: usize, hurry: f64, motion: &mut Motion, rooms: &Rooms) {
    let (middle, width) = rooms[i];
    let scale = reduction(robot, i, width, hurry, motion);
    for k in 0..motion.q.len() {
        motion.q[k][i] = middle + scale * motion.q[k][i];
        motion.v[k][i] *= scale;
        motion.a[k][i] *= scale;
    }
}

fn fourier(robot: &Robot, period: f64, hurry: f64, rooms: &Rooms, rng: &mut Rng) -> Motion {
    let count = (period / GRID).round() as usize;
    let mut motion = Motion::empty(count);
    // Harmonics up to about 1 Hz.
    let top = ((rng.between(0.4, 1.0) * period) as usize).clamp(4, 40);
    for i in 0..robot.arm.n() {
        for _ in 0..5 {
            let rate = TAU * (1 + rng.below(top)) as f64 / period;
            let (size, phase) = (rng.normal() / rate.sqrt(), rng.between(0.0, TAU));
            for k in 0..count {
                let (sin, cos) = (rate * k as f64 * GRID + phase).sin_cos();
                motion.q[k][i] += size * sin;
                motion.v[k][i] += size * rate * cos;
                motion.a[k][i] -= size * rate * rate * sin;
            }
        }
        fit(robot, i, hurry, &mut motion, rooms);
    }
    motion
}

fn chirp(robot: &Robot, period: f64, hurry: f64, rooms: &Rooms, rng: &mut Rng) -> Motion {
    let count = (period / GRID).round() as usize;
    let mut motion = Motion::empty(count);
    for i in 0..robot.arm.n() {
        let (f0, f1) = (rng.between(0.05, 0.15), rng.between(0.6, 1.4));
        let start = rng.between(0.0, TAU);
        let value = |t: f64| {
            let x = (t / period).rem_euclid(1.0);
            let hull = (0.5 * TAU * x).sin().powi(2);
            let sweep = f0 * x + 0.5 * (f1 - f0) * x * x;
            hull * (TAU * period * sweep + start).sin() / (f0 + (f1 - f0) * x).sqrt()
        };
        for k in 0..count {
            let t = k as f64 * GRID;
            // Central differences: 2 ms are far below the shortest wave.
            let h = 2e-3;
            let (low, mid, high) = (value(t - h), value(t), value(t + h));
            motion.q[k][i] = mid;
            motion.v[k][i] = (high - low) / (2.0 * h);
            motion.a[k][i] = (high - 2.0 * mid + low) / (h * h);
        }
        fit(robot, i, hurry, &mut motion, rooms);
    }
    motion
}

/// Position, rate and acceleration of a unit move at a share `x` of its time; their largest rate and
/// acceleration are [`peaks`].
pub(super) fn profile(smooth: bool, x: f64) -> (f64, f64, f64) {
    let x = x.clamp(0.0, 1.0);
    if smooth {
        let (x3, x4) = (x * x * x, x * x * x * x);
        let s = x4 * (35.0 + x * (-84.0 + x * (70.0 - 20.0 * x)));
        let v = x3 * (140.0 + x * (-420.0 + x * (420.0 - 140.0 * x)));
        let a = x * x * (420.0 + x * (-1680.0 + x * (2100.0 - 840.0 * x)));
        return (s, v, a);
    }
    // A third accelerates, a third cruises, a third brakes.
    let (ramp, top) = (1.0 / 3.0, 1.5);
    let a = top / ramp;
    if x < ramp {
        (0.5 * a * x * x, a * x, a)
    } else if x <= 1.0 - ramp {
        (0.25 + top * (x - ramp), top, 0.0)
    } else {
        let y = 1.0 - x;
        (1.0 - 0.5 * a * y * y, a * y, if y > 0.0 { -a } else { 0.0 })
    }
}

/// Largest rate and acceleration of [`profile`].
pub(super) fn peaks(smooth: bool) -> (f64, f64) {
    if smooth { (2.1875, 7.52) } else { (1.5, 4.5) }
}

/// Shortest time \[s\] of a move under a share of the limits.
pub(super) fn duration(robot: &Robot, from: &Row, to: &Row, smooth: bool, hurry: f64) -> f64 {
    let (rate, acceleration) = peaks(smooth);
    (0..robot.arm.n()).fold(0.05, |time: f64, i| {
        let way = (to[i] - from[i]).abs();
        time.max(way * rate / (hurry * robot.speed[i]))
            .max((way * acceleration / (hurry * robot.acceleration[i])).sqrt())
    })
}

fn moves(
    robot: &Robot,
    shape: Shape,
    (period, hurry): (f64, f64),
    rooms: &Rooms,
    rng: &mut Rng,
) -> Motion {
    let n = robot.arm.n();
    let smooth = shape != Shape::Trapezoid;
    let longest = if shape == Shape::Waits { LONGEST_DWELL.1 } else { LONGEST_DWELL.0 };
    let count = (period / GRID).round() as usize;
    let target = |rng: &mut Rng| {
        let mut q = [0.0; MAX];
        for (x, (middle, width)) in q.iter_mut().zip(rooms) {
            *x = middle + width * rng.between(-1.0, 1.0);
        }
        q
    };
    let home = target(rng);
    let (mut here, mut time) = (home, 0.0);
    let mut motion = Motion::empty(count);
    let mut last = false;
    while !last {
        let dwell = rng.between(0.08 * longest, longest);
        let mut there = target(rng);
        if time > 0.0 && rng.chance(0.4) {
            // Some joints rest.
            for x in 0..n {
                if rng.chance(0.5) {
                    there[x] = here[x];
                }
            }
        }
        // Room for the way back and the dwell before it.
        let reserve = dwell + longest;
        let needs = |there: &Row| {
            duration(robot, &here, there, smooth, hurry)
                + duration(robot, there, &home, smooth, hurry)
        };
        let first = time <= 0.0;
        for _ in 0..8 {
            if first && reserve + needs(&there) > period {
                for (x, h) in there.iter_mut().zip(&here) {
                    *x = h + 0.6 * (*x - h);
                }
            }
        }
        if time + reserve + needs(&there) > period {
            (there, last) = (home, true);
        }
        let takes = duration(robot, &here, &there, smooth, hurry);
        let from = if first { 0.0 } else { time + dwell };
        write_move(&mut motion, (from, time + dwell, takes), &here, &there, smooth);
        (here, time) = (there, time + dwell + takes);
    }
    motion
}

/// Writes a move into the samples from a time on: (from, start of the move, its duration) \[s\].
fn write_move(motion: &mut Motion, times: (f64, f64, f64), from: &Row, to: &Row, smooth: bool) {
    let (begin, start, takes) = times;
    for k in 0..motion.q.len() {
        let t = k as f64 * GRID;
        if t >= begin {
            let (s, v, a) = profile(smooth, (t - start) / takes);
            for i in 0..MAX {
                let way = to[i] - from[i];
                motion.q[k][i] = from[i] + way * s;
                motion.v[k][i] = way * v / takes;
                motion.a[k][i] = way * a / (takes * takes);
            }
        }
    }
}

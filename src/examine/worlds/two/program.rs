//! A RAPID program: text, and the motion that a path planner makes of it.
//!
//! Moves are straight in the joint angles with trapezoidal speed. In a zone the next move starts while
//! the one before still brakes, and both add (L. Biagiotti, C. Melchiorri, Trajectory
//! Planning for Automatic Machines and Robots, 2008). A moving average bounds the jerk.

use super::motion::{GRID, Motion};
use super::robot::Robot;
use crate::examine::worlds::api::minus;
use crate::examine::worlds::model::{M3, MAX, Row, V3};
use crate::examine::worlds::program::Move;
use crate::examine::worlds::random::Rng;

/// How the planner of this robot differs from the usual.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planner {
    /// Factor of the zones, and largest zone \[m\].
    pub(super) zone: (f64, f64),
    /// Factor of the accelerations, of the joints up to `bound` alone or of all.
    pub(super) acceleration: (f64, usize),
    /// Factor of the speeds, and largest speed \[m/s\].
    pub(super) speed: (f64, f64),
    /// Wait \[s\] after a movement (from 0), share by which it changes, and whether the next movement
    /// is already shown.
    pub(super) wait: (f64, usize, f64, bool),
    /// Length of the moving average \[s\].
    pub(super) smooth: f64,
    /// Standard deviation of the ends of waits \[s\].
    pub(super) jitter: f64,
}

impl Default for Planner {
    fn default() -> Self {
        Self {
            zone: (1.0, f64::INFINITY),
            acceleration: (1.0, MAX),
            speed: (1.0, f64::INFINITY),
            wait: (0.0, usize::MAX, 0.0, false),
            smooth: 0.05,
            jitter: 0.002,
        }
    }
}

/// Speeds \[mm/s\] and zones \[mm\] that RAPID knows by name.
const SPEEDS: [f64; 7] = [100.0, 200.0, 400.0, 600.0, 1000.0, 1500.0, 2500.0];
const ZONES: [f64; 7] = [1.0, 5.0, 10.0, 20.0, 50.0, 100.0, 150.0];
/// Speed of the flange's turning that goes with every speed \[rad/s\].
const TURNING: f64 = 8.7;
/// Parts of a way by which its length is measured.
const PARTS: usize = 12;

/// Draws a program: it ends where it begins.
pub(super) fn draw(robot: &Robot, rng: &mut Rng) -> Vec<Move> {
    let count = 6 + rng.below(8);
    let mut out = Vec::new();
    let fast: Vec<f64> = SPEEDS.iter().copied().filter(|v| *v > 150.0 * robot.size.reach).collect();
    let rooms: Vec<(f64, f64)> = (0..robot.arm.n())
        .map(|i| {
            let half = (0.5 * (robot.high[i] - robot.low[i])).min(1.5);
            (0.5 * (robot.high[i] + robot.low[i]), half * rng.between(0.5, 0.85))
        })
        .collect();
    for k in 0..count {
        let mut target = [0.0; MAX];
        for (x, (middle, width)) in target.iter_mut().zip(&rooms) {
            // Tenths of a degree, as in the text.
            let degrees = (middle + width * rng.between(-1.0, 1.0)).to_degrees();
            *x = ((degrees * 10.0).round() / 10.0).to_radians();
        }
        let waits = k + 1 < count && rng.chance(0.18);
        let fine = waits || k + 1 == count || rng.chance(0.25);
        let widest = 80.0 * robot.size.reach;
        let zones: Vec<f64> = ZONES.iter().copied().filter(|z| *z < widest).collect();
        let zone = if fine { 0.0 } else { rng.pick(&zones) / 1e3 };
        let speed = rng.pick(&fast) / 1e3;
        let wait = if waits { (rng.between(0.2, 1.5) * 10.0).round() / 10.0 } else { 0.0 };
        out.push(Move { to: target, speed, zone, wait });
    }
    out
}

/// A planned motion with what runs at each sample of the grid.
#[derive(Clone, Debug)]
pub(super) struct Planned {
    /// All cycles, one behind the other.
    pub(super) motion: Motion,
    /// Number of the movement, 0 while the program waits.
    pub(super) command: Vec<usize>,
    pub(super) cycle: Vec<usize>,
    /// Starts of the cycles \[s\].
    pub(super) starts: Vec<f64>,
}

/// One move in time.
struct Piece {
    start: f64,
    way: Row,
    /// Duration, and duration of the ramps \[s\].
    time: (f64, f64),
}

impl Piece {
    fn share(&self, t: f64) -> f64 {
        let (whole, ramp) = self.time;
        let x = (t - self.start).clamp(0.0, whole);
        let rate = 1.0 / (whole - ramp);
        if x < ramp {
            0.5 * rate * x * x / ramp
        } else if x > whole - ramp {
            1.0 - 0.5 * rate * (whole - x).powi(2) / ramp
        } else {
            rate * (x - 0.5 * ramp)
        }
    }
}

/// Length of a way of the flange \[m\] with the share of its turning.
fn length(robot: &Robot, from: &Row, way: &Row) -> (f64, f64) {
    let (mut before, mut sum, mut turn) = (None, 0.0, 0.0);
    let mut last: Option<M3> = None;
    for part in 0..=PARTS {
        let mut q = *from;
        for (x, d) in q.iter_mut().zip(way) {
            *x += d * part as f64 / PARTS as f64;
        }
        let pose = robot.arm.pose(&q);
        if let (Some(old), Some(frame)) = (before, last) {
            sum += (pose.flange - old as V3).norm();
            let cosine = 0.5 * ((frame.transpose() * pose.last).trace() - 1.0);
            turn += cosine.clamp(-1.0, 1.0).acos();
        }
        (before, last) = (Some(pose.flange), Some(pose.last));
    }
    (sum, turn)
}

/// Times of a move: duration and ramp \[s\].
fn times(robot: &Robot, planner: &Planner, way: &Row, path: (f64, f64), speed: f64) -> (f64, f64) {
    let speed = (speed * planner.speed.0).min(planner.speed.1);
    let mut cruise = (path.0 / speed).max(path.1 / (TURNING * planner.speed.0));
    for i in 0..robot.arm.n() {
        cruise = cruise.max(way[i].abs() / (0.95 * planner.speed.0.min(1.0) * robot.speed[i]));
    }
    let cruise = cruise.max(0.02);
    let (mut ramp, mut short) = (0.01_f64, 0.02_f64);
    for i in 0..robot.arm.n() {
        let own = if i < planner.acceleration.1 { planner.acceleration.0 } else { 1.0 };
        let most = robot.acceleration[i] * own;
        ramp = ramp.max(way[i].abs() / cruise / most);
        short = short.max((way[i].abs() / most).sqrt());
    }
    if ramp < cruise { (cruise + ramp, ramp) } else { (2.0 * short, short) }
}

/// Plans cycles of the program.
pub(super) fn plan(
    robot: &Robot,
    program: &[Move],
    planner: &Planner,
    cycles: usize,
    rng: &mut Rng,
) -> Planned {
    let home = program.last().map_or([0.0; MAX], |last| last.to);
    let (mut here, mut time) = (home, 0.3);
    let (mut pieces, mut events, mut starts) = (Vec::new(), vec![(0.0, 0, 1)], Vec::new());
    for cycle in 1..=cycles {
        starts.push(time);
        let mut next = time;
        for (number, step) in program.iter().enumerate() {
            let way = minus(&step.to, &here);
            let path = length(robot, &here, &way);
            let took = times(robot, planner, &way, path, step.speed);
            let piece = Piece { start: next, way, time: took };
            events.push((next + 0.5 * (time - next).max(0.0), number + 1, cycle));
            time = piece.start + piece.time.0;
            let radius = (step.zone * planner.zone.0).min(planner.zone.1);
            next = corner(&piece, path.0, radius);
            if planner.wait.0 > 0.0 && planner.wait.1 == number {
                let wait = planner.wait.0 * (1.0 + planner.wait.2 * rng.between(-1.0, 1.0));
                let shown = if planner.wait.3 { number + 2 } else { 0 };
                events.push((time, shown, cycle));
                time += wait;
                next = time;
            }
            if step.wait > 0.0 {
                events.push((time, 0, cycle));
                time += (step.wait + planner.jitter * rng.normal()).max(0.0);
                next = time;
            }
            pieces.push(piece);
            here = step.to;
        }
    }
    sample(&home, &pieces, &events, (time + 0.4, planner.smooth), starts)
}

/// Time at which the next move may start \[s\].
fn corner(piece: &Piece, length: f64, radius: f64) -> f64 {
    let end = piece.start + piece.time.0;
    // At most half of the way is blended, and at most the braking.
    let share = (radius / length.max(1e-6)).min(0.5);
    let mut t = end;
    while t > end - piece.time.1 && 1.0 - piece.share(t - GRID) < share {
        t -= GRID;
    }
    t
}

fn sample(
    home: &Row,
    pieces: &[Piece],
    events: &[(f64, usize, usize)],
    (end, smooth): (f64, f64),
    starts: Vec<f64>,
) -> Planned {
    let count = (end / GRID).ceil() as usize;
    let mut raw = vec![*home; count];
    for piece in pieces {
        let first = (piece.start / GRID).max(0.0) as usize;
        for (k, row) in raw.iter_mut().enumerate().skip(first) {
            let share = piece.share(k as f64 * GRID);
            for (x, way) in row.iter_mut().zip(&piece.way) {
                *x += share * way;
            }
        }
    }
    let half = (0.5 * smooth / GRID) as usize;
    let q = average(&average(&raw, half), half / 2);
    let v = slope(&q);
    let a = slope(&v);
    let (mut command, mut cycle, mut place) = (vec![0; count], vec![1; count], 0);
    for k in 0..count {
        while events.get(place + 1).is_some_and(|event| event.0 <= k as f64 * GRID) {
            place += 1;
        }
        if let Some(event) = events.get(place) {
            (command[k], cycle[k]) = (event.1, event.2);
        }
        // After the last movement the program waits.
        if k as f64 * GRID > end - 0.4 {
            command[k] = 0;
        }
    }
    Planned { motion: Motion { q, v, a }, command, cycle, starts }
}

/// Mean over `half` samples to both sides; the ends are held.
fn average(rows: &[Row], half: usize) -> Vec<Row> {
    let last = rows.len() - 1;
    let at = |k: usize| &rows[k.saturating_sub(half).min(last)];
    let mut sum = [0.0; MAX];
    for k in 0..=2 * half {
        sum = std::array::from_fn(|i| sum[i] + at(k)[i]);
    }
    let mut out = Vec::with_capacity(rows.len());
    for k in 0..rows.len() {
        out.push(sum.map(|s| s / (2 * half + 1) as f64));
        let (new, old) = (at(k + 2 * half + 1), at(k));
        sum = std::array::from_fn(|i| sum[i] + new[i] - old[i]);
    }
    out
}

fn slope(rows: &[Row]) -> Vec<Row> {
    let last = rows.len().saturating_sub(1);
    (0..rows.len())
        .map(|k| {
            let (low, high) = (rows[k.saturating_sub(1)], rows[(k + 1).min(last)]);
            let mut out = [0.0; MAX];
            for i in 0..MAX {
                out[i] = (high[i] - low[i]) / (2.0 * GRID);
            }
            out
        })
        .collect()
}

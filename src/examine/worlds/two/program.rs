//! A RAPID program: text, and the motion that a path planner makes of it.
//!
//! Moves are straight in the joint angles with trapezoidal speed. In a zone the next move starts while
//! the one before still brakes, and both add (L. Biagiotti, C. Melchiorri, Trajectory
//! Planning for Automatic Machines and Robots, 2008). A moving average bounds the jerk.

use std::fmt::Write as _;

use crate::motion::{GRID, Motion};
use crate::rigid::{Joints, MAX};
use crate::rng::Rng;
use crate::robot::Robot;

/// An instruction of the program.
#[derive(Clone, Debug)]
pub enum Instruction {
    /// A move to joint angles \[rad\], with a speed \[m/s\] and a zone \[m\]; zone 0: fine.
    Move {
        /// Target.
        target: Joints,
        /// Speed of the flange.
        speed: f64,
        /// Radius of the zone.
        zone: f64,
    },
    /// A wait \[s\].
    Wait(f64),
}

/// How the planner of this robot differs from the usual.
#[derive(Clone, Copy, Debug)]
pub struct Planner {
    /// Factor of the zones, and largest zone \[m\].
    pub zone: (f64, f64),
    /// Factor of the accelerations, of the joints up to `bound` alone or of all.
    pub acceleration: (f64, usize),
    /// Factor of the speeds, and largest speed \[m/s\].
    pub speed: (f64, f64),
    /// Wait \[s\] after a movement (from 0), share by which it changes, and whether the next movement
    /// is already shown.
    pub wait: (f64, usize, f64, bool),
    /// Length of the moving average \[s\].
    pub smooth: f64,
    /// Standard deviation of the ends of waits \[s\].
    pub jitter: f64,
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
pub fn draw(robot: &Robot, rng: &mut Rng) -> Vec<Instruction> {
    let count = 6 + rng.below(8);
    let mut out = Vec::new();
    let fast: Vec<f64> = SPEEDS.iter().copied().filter(|v| *v > 150.0 * robot.size.reach).collect();
    let rooms: Vec<(f64, f64)> = (0..robot.arm.n())
        .map(|i| {
            let half = (0.5 * (robot.high[i] - robot.low[i])).min(1.5);
            (0.5 * (robot.high[i] + robot.low[i]), half * rng.range(0.5, 0.85))
        })
        .collect();
    for k in 0..count {
        let mut target = [0.0; MAX];
        for (x, (middle, width)) in target.iter_mut().zip(&rooms) {
            // Tenths of a degree, as in the text.
            let degrees = (middle + width * rng.range(-1.0, 1.0)).to_degrees();
            *x = ((degrees * 10.0).round() / 10.0).to_radians();
        }
        let waits = k + 1 < count && rng.chance(0.18);
        let fine = waits || k + 1 == count || rng.chance(0.25);
        let widest = 80.0 * robot.size.reach;
        let zones: Vec<f64> = ZONES.iter().copied().filter(|z| *z < widest).collect();
        let zone = if fine { 0.0 } else { rng.pick(&zones, 5.0) / 1e3 };
        let speed = rng.pick(&fast, 500.0) / 1e3;
        out.push(Instruction::Move { target, speed, zone });
        if waits {
            out.push(Instruction::Wait((rng.range(0.2, 1.5) * 10.0).round() / 10.0));
        }
    }
    out
}

/// The text of a module, and the line (from 1) of each movement.
pub fn text(program: &[Instruction], n: usize) -> (String, Vec<usize>) {
    let mut out = String::from("MODULE MainModule\n");
    let (mut body, mut lines, mut number) = (Vec::new(), Vec::new(), 0);
    for step in program {
        match step {
            Instruction::Move { target, speed, zone } => {
                number += 10;
                let list: Vec<String> =
                    target.iter().take(n).map(|x| format!("{:.1}", x.to_degrees())).collect();
                let _ = writeln!(
                    out,
                    "  CONST jointtarget p{number}:=[[{}],[9E9,9E9,9E9,9E9,9E9,9E9]];",
                    list.join(",")
                );
                let place = if *zone > 0.0 { format!("z{:.0}", zone * 1e3) } else { "fine".to_owned() };
                lines.push(body.len());
                body.push(format!("    MoveAbsJ p{number}, v{:.0}, {place}, tool0;", speed * 1e3));
            }
            Instruction::Wait(time) => body.push(format!("    WaitTime {time:.1};")),
        }
    }
    out.push_str("\n  PROC main()\n");
    let first = out.lines().count() + 1;
    for line in &body {
        let _ = writeln!(out, "{line}");
    }
    out.push_str("  ENDPROC\nENDMODULE\n");
    (out, lines.into_iter().map(|line| line + first).collect())
}

/// A planned motion with what runs at each sample of the grid.
#[derive(Clone, Debug)]
pub struct Planned {
    /// All cycles, one behind the other.
    pub motion: Motion,
    /// Number of the movement, 0 while the program waits.
    pub command: Vec<usize>,
    /// Cycle from 1.
    pub cycle: Vec<usize>,
    /// Starts of the cycles \[s\].
    pub starts: Vec<f64>,
}

/// One move in time.
struct Piece {
    start: f64,
    way: Joints,
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
fn length(robot: &Robot, from: &Joints, way: &Joints) -> (f64, f64) {
    let (mut before, mut sum, mut turn) = (None, 0.0, 0.0);
    let mut last: Option<nalgebra::Matrix3<f64>> = None;
    for part in 0..=PARTS {
        let mut q = *from;
        for (x, d) in q.iter_mut().zip(way) {
            *x += d * part as f64 / PARTS as f64;
        }
        let pose = robot.arm.pose(&q);
        if let (Some(old), Some(frame)) = (before, last) {
            sum += (pose.flange - old as nalgebra::Vector3<f64>).norm();
            let cosine = 0.5 * ((frame.transpose() * pose.last).trace() - 1.0);
            turn += cosine.clamp(-1.0, 1.0).acos();
        }
        (before, last) = (Some(pose.flange), Some(pose.last));
    }
    (sum, turn)
}

/// Times of a move: duration and ramp \[s\].
fn times(robot: &Robot, planner: &Planner, way: &Joints, path: (f64, f64), speed: f64) -> (f64, f64) {
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
pub fn plan(
    robot: &Robot,
    program: &[Instruction],
    planner: &Planner,
    cycles: usize,
    rng: &mut Rng,
) -> Planned {
    let home = program
        .iter()
        .rev()
        .find_map(|step| if let Instruction::Move { target, .. } = step { Some(*target) } else { None })
        .unwrap_or([0.0; MAX]);
    let (mut here, mut time) = (home, 0.3);
    let (mut pieces, mut events, mut starts) = (Vec::new(), vec![(0.0, 0, 1)], Vec::new());
    for cycle in 1..=cycles {
        let mut number = 0;
        starts.push(time);
        let mut next = time;
        for step in program {
            match step {
                Instruction::Wait(wait) => {
                    events.push((time, 0, cycle));
                    time += (wait + planner.jitter * rng.normal()).max(0.0);
                    next = time;
                }
                Instruction::Move { target, speed, zone } => {
                    let mut way = *target;
                    for (x, h) in way.iter_mut().zip(&here) {
                        *x -= h;
                    }
                    let path = length(robot, &here, &way);
                    let piece =
                        Piece { start: next, way, time: times(robot, planner, &way, path, *speed) };
                    events.push((next + 0.5 * (time - next).max(0.0), number + 1, cycle));
                    time = piece.start + piece.time.0;
                    let radius = (zone * planner.zone.0).min(planner.zone.1);
                    next = corner(&piece, path.0, radius);
                    if planner.wait.0 > 0.0 && planner.wait.1 == number {
                        let wait = planner.wait.0 * (1.0 + planner.wait.2 * rng.range(-1.0, 1.0));
                        let shown = if planner.wait.3 { number + 2 } else { 0 };
                        events.push((time, shown, cycle));
                        time += wait;
                        next = time;
                    }
                    pieces.push(piece);
                    here = *target;
                    number += 1;
                }
            }
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
    home: &Joints,
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

/// Mean over `half` samples to both sides.
fn average(rows: &[Joints], half: usize) -> Vec<Joints> {
    let last = rows.len().saturating_sub(1);
    let width = (2 * half + 1) as f64;
    let mut sum = [0.0; MAX];
    let at = |k: i64| {
        rows.get(usize::try_from(k.max(0)).unwrap_or(0).min(last)).copied().unwrap_or([0.0; MAX])
    };
    let h = half as i64;
    for k in -h..=h {
        for (s, x) in sum.iter_mut().zip(at(k)) {
            *s += x;
        }
    }
    let mut out = Vec::with_capacity(rows.len());
    for k in 0..rows.len() as i64 {
        out.push(sum.map(|s| s / width));
        let (new, old) = (at(k + h + 1), at(k - h));
        for i in 0..MAX {
            sum[i] += new[i] - old[i];
        }
    }
    out
}

/// Central differences.
fn slope(rows: &[Joints]) -> Vec<Joints> {
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

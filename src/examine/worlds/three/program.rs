//! A random RAPID program of joint moves, and its text.

use crate::arm::Arm;
use crate::rng::Rng;
use crate::spatial::{Axes, MAX, flange};
use std::fmt::Write;

/// A movement instruction.
#[derive(Clone, Debug)]
pub struct Move {
    /// Where it goes \[rad\].
    pub to: Axes,
    /// Speed of the tool \[mm/s\].
    pub speed: usize,
    /// Zone radius \[mm\]; none for a stop.
    pub zone: Option<usize>,
    /// Wait after it \[s\]; 0 for none.
    pub wait: f64,
    /// Its line in the program, from 1.
    pub line: usize,
}

/// Speeds of the controller \[mm/s\].
const SPEEDS: [usize; 14] = [100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000, 2500, 3000, 4000];
/// Zones of the controller \[mm\].
const ZONES: [usize; 9] = [1, 5, 10, 20, 30, 50, 80, 100, 150];
/// Parts into which a path is cut to find its length.
const PARTS: usize = 16;

/// Length of the tool's path \[m\] of a joint move.
#[must_use]
pub fn path(arm: &Arm, from: &Axes, to: &Axes) -> f64 {
    let at = |share: f64| {
        let mut q = [0.0; MAX];
        for (i, q) in q.iter_mut().enumerate().take(arm.axes()) {
            *q = from[i] + share * (to[i] - from[i]);
        }
        flange(&arm.joints, &q).0
    };
    let mut before = at(0.0);
    let mut length = 0.0;
    for part in 1..=PARTS {
        let now = at(part as f64 / PARTS as f64);
        length += (now - before).norm();
        before = now;
    }
    length
}

/// A pose whose angles have two decimals of a degree, as taught points have.
fn pose(arm: &Arm, rng: &mut Rng) -> Axes {
    let mut out = [0.0; MAX];
    for (i, value) in out.iter_mut().enumerate().take(arm.axes()) {
        let angle: f64 = arm.middle[i] + 0.9 * arm.span[i] * rng.range(-1.0, 1.0);
        *value = ((angle.to_degrees() * 100.0).round() / 100.0).to_radians();
    }
    out
}

/// Random moves that end at their start; the last one stops.
#[must_use]
pub fn moves(arm: &Arm, rng: &mut Rng) -> Vec<Move> {
    let count = rng.between(5, 12);
    let home = pose(arm, rng);
    let mut now = home;
    let mut out = Vec::new();
    for k in 1..=count {
        let mut to = if k == count { home } else { pose(arm, rng) };
        if k < count && rng.chance(0.35) {
            // Approach or retreat: a short move of some axes.
            to = now;
            for i in 1..arm.axes().min(5) {
                let change: f64 = 0.3 * arm.span[i] * rng.range(-1.0, 1.0);
                let middle = arm.middle[i];
                let angle = (to[i] + change).clamp(middle - arm.span[i], middle + arm.span[i]);
                to[i] = ((angle.to_degrees() * 100.0).round() / 100.0).to_radians();
            }
        }
        // Speeds that take 0.4 to 2 s.
        let wanted = 1000.0 * path(arm, &now, &to) / rng.log_range(0.4, 2.0);
        let speed = SPEEDS.iter().copied().filter(|speed| (*speed as f64) <= wanted).max().unwrap_or(100);
        let stop = k == count || rng.chance(0.35);
        let zone = if stop { None } else { Some(rng.pick(&ZONES, 10)) };
        let wait = if stop && rng.chance(0.45) { (rng.range(0.2, 1.5) * 10.0).round() / 10.0 } else { 0.0 };
        out.push(Move { to, speed, zone, wait, line: 0 });
        now = to;
    }
    out
}

/// The program's text; fills in the moves' lines.
#[must_use]
pub fn rapid(arm: &Arm, moves: &mut [Move]) -> String {
    let mut out = "MODULE MainModule\n".to_owned();
    let mut line = 1;
    for (k, step) in moves.iter().enumerate() {
        let angles: Vec<String> =
            step.to.iter().take(arm.axes()).map(|angle| format!("{:.2}", angle.to_degrees())).collect();
        let _ = writeln!(
            out,
            "  CONST jointtarget p{} := [[{}],[9E9,9E9,9E9,9E9,9E9,9E9]];",
            10 * (k + 1),
            angles.join(",")
        );
        line += 1;
    }
    out.push_str("\n  PROC main()\n");
    line += 2;
    for (k, step) in moves.iter_mut().enumerate() {
        let zone = step.zone.map_or_else(|| "fine".to_owned(), |zone| format!("z{zone}"));
        let _ = writeln!(out, "    MoveAbsJ p{}\\NoEOffs, v{}, {zone}, tool0;", 10 * (k + 1), step.speed);
        line += 1;
        step.line = line;
        if step.wait > 0.0 {
            let _ = writeln!(out, "    WaitTime {:.1};", step.wait);
            line += 1;
        }
    }
    out.push_str("  ENDPROC\nENDMODULE\n");
    out
}

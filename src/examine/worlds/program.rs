//! Programs of joint moves: their RAPID text, and the logs of their runs.

use super::model::Row;
use super::random::Rng;
use super::table::{Table, quantised};
use std::fmt::Write as _;

/// A movement instruction: target \[rad\], speed of the tool \[m/s\], radius of the zone \[m\] (0: the
/// robot stops), and a wait after it \[s\] (0: none).
#[derive(Clone, Copy, Debug)]
pub(super) struct Move {
    pub(super) to: Row,
    pub(super) speed: f64,
    pub(super) zone: f64,
    pub(super) wait: f64,
}

/// The module of a program with `n` axes, and the line, from 1, of each move.
pub(super) fn module(moves: &[Move], n: usize) -> (String, Vec<usize>) {
    let mut out = String::from("MODULE MainModule\n");
    for (k, step) in moves.iter().enumerate() {
        let angles: Vec<String> =
            step.to[..n].iter().map(|angle| format!("{:.2}", angle.to_degrees())).collect();
        let (number, angles) = (10 * (k + 1), angles.join(","));
        let _ =
            writeln!(out, "  CONST jointtarget p{number}:=[[{angles}],[9E9,9E9,9E9,9E9,9E9,9E9]];");
    }
    out.push_str("\n  PROC main()\n");
    let mut lines = Vec::new();
    for (k, step) in moves.iter().enumerate() {
        lines.push(out.lines().count() + 1);
        let zone =
            if step.zone > 0.0 { format!("z{:.0}", 1000.0 * step.zone) } else { "fine".to_owned() };
        let (number, speed) = (10 * (k + 1), 1000.0 * step.speed);
        let _ = writeln!(out, "    MoveAbsJ p{number}\\NoEOffs, v{speed:.0}, {zone}, tool0;");
        if step.wait > 0.0 {
            let _ = writeln!(out, "    WaitTime {:.2};", step.wait);
        }
    }
    out.push_str("  ENDPROC\nENDMODULE\n");
    (out, lines)
}

/// How runs of a program are logged: joints, rate \[Hz\], noise and step of an angle \[rad\], time of
/// the first row \[s\], share of lost rows, and whether the cycles are numbered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Recorder {
    pub(super) n: usize,
    pub(super) rate: f64,
    pub(super) noise: f64,
    pub(super) step: f64,
    pub(super) start: f64,
    pub(super) lost: f64,
    pub(super) cycles: bool,
}

impl Recorder {
    /// The log of a run with angles, number of the move (0: none) and cycle, `tick` seconds apart.
    pub(super) fn csv(&self, rows: &[(Row, usize, usize)], tick: f64, rng: &mut Rng) -> String {
        let mut out =
            Table::new(self.n, &["q"], if self.cycles { &["cmd", "cycle"] } else { &["cmd"] });
        let last = rows.len() - 1;
        for k in 0..(rows.len() as f64 * tick * self.rate).floor() as usize {
            let time = k as f64 / self.rate;
            if k > 0 && rng.chance(self.lost) {
                continue;
            }
            let (at, share) = ((time / tick) as usize, (time / tick).fract());
            let ((q, command, cycle), (next, ..)) =
                (&rows[at.min(last)], &rows[(at + 1).min(last)]);
            out.row(self.start + time, 5);
            for i in 0..self.n {
                let angle = q[i] + share * (next[i] - q[i]) + self.noise * rng.normal();
                out.value(quantised(angle, self.step), 6);
            }
            out.value(*command as f64, 0);
            if self.cycles {
                out.value(*cycle as f64, 0);
            }
        }
        out.finish()
    }
}

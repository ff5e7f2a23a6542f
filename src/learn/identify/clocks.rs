//! Fine synchronisation of two recorders, beyond the resolution of their marks.
//!
//! A logger sets its output after sampling, so all marks may be late by the same part of a sample
//! interval. The motor currents give the remaining shift: in rotor coordinates the direction of the
//! current vector is constant only at the right shift.

use crate::arm::robot::Model;
use crate::learn::log::{
    Aligned, Channel, Log, Vectors, between_grid, coherence, on_grid, vectors,
};

use super::torque::motor_angle;

/// Search range in intervals of the slower recorder, and steps in each interval.
const REACH: i32 = 2;
const STEPS: i32 = 8;
/// Rows that the search evaluates, in total and in each piece of the log.
const ROWS: usize = 2000;
/// Number of pieces with a shift of their own; the clock drift follows from these.
const PIECES: usize = 6;
/// Steps to each side in a piece; each is a sixteenth of a coarse step.
const FINE: i32 = 32;
/// Least mean coherence of the current vectors with the rotors.
const TELLS: f64 = 0.6;

/// The log with positions shifted to the times of the currents, and a sentence on the accuracy.
#[must_use]
pub fn synchronised(model: &Model, aligned: Aligned) -> (Log, String) {
    let Aligned { log, marks, worst, step } = aligned;
    let said = format!("{marks} marks of the two clocks agree within {:.2} ms", 1e3 * worst);
    let alone = format!(
        "{said}; nothing else tells the clocks: positions may be late by up to {:.1} ms",
        1e3 * step
    );
    let Some(motors) = Motors::new(model, &log) else { return (log, alone) };
    let every = log.time().len().div_ceil(ROWS).max(1);
    let all: Vec<usize> = (0..log.time().len()).step_by(every).collect();
    let coarse = step / f64::from(STEPS);
    let turning = |shift: f64| Some(-motors.stands(&all, shift, None).0);
    let best = on_grid(0.0, coarse, REACH * STEPS, turning);
    let Some(middle) = best.filter(|best| -best.misfit > TELLS).map(|best| best.shift) else {
        return (log, alone);
    };
    let (stands, pairs) = motors.stands(&all, middle, None);
    let found: Vec<[f64; 2]> = (0..PIECES)
        .filter_map(|piece| motors.of_piece(piece, middle, coarse / 16.0, &pairs))
        .collect();
    let Some(line) = Line::through(&found) else { return (log, alone) };
    let told = format!(
        "{said}; by the field of the motors positions are taken from {:.2} ms {} (pieces of the \
         time agree within {:.2} ms, {:.0} % of the currents stand still from the rotors)",
        1e3 * line.at_middle.abs(),
        if line.at_middle < 0.0 { "earlier" } else { "later" },
        1e3 * line.worst,
        100.0 * stands
    );
    (shifted(&log, &|t| line.at(t)), told)
}

/// The current vectors of all motors and the angles of their rotors.
struct Motors {
    t: Vec<f64>,
    vectors: Vec<Vectors>,
    angles: Vec<Vec<f64>>,
}

impl Motors {
    fn new(model: &Model, log: &Log) -> Option<Motors> {
        let motors = model.motors.as_ref()?;
        let phase = |joint: usize, phase: usize| log.column(Channel::PhaseCurrent(joint, phase));
        let vectors = (0..model.dof)
            .map(|j| Some(vectors(phase(j, 0)?, phase(j, 1)?, phase(j, 2)?)))
            .collect::<Option<Vec<Vectors>>>()?;
        let angles = (0..model.dof).map(|j| motor_angle(model, log, j, motors.ratio[j])).collect();
        (log.time().len() > ROWS).then(|| Motors { t: log.time().to_vec(), vectors, angles })
    }

    /// Mean coherence of the vectors with the rotors, and the pole pairs of each motor.
    fn stands(&self, rows: &[usize], shift: f64, pairs: Option<&[i32]>) -> (f64, Vec<i32>) {
        let mut sum = 0.0;
        let mut found = Vec::with_capacity(self.vectors.len());
        for (joint, (all, angle)) in self.vectors.iter().zip(&self.angles).enumerate() {
            let of = |x: &[f64]| rows.iter().map(|i| x[*i]).collect::<Vec<f64>>();
            let part = Vectors { re: of(&all.re), im: of(&all.im) };
            let moved: Vec<f64> =
                rows.iter().map(|i| between(&self.t, angle, self.t[*i] + shift, *i)).collect();
            let known = pairs.map(|pairs| pairs[joint]);
            let (share, best) = coherence(&part, &moved, known, 1);
            sum += share;
            found.push(best);
        }
        (sum / self.vectors.len().max(1) as f64, found)
    }

    /// Mean time and best shift of a piece \[s\].
    fn of_piece(&self, piece: usize, middle: f64, fine: f64, pairs: &[i32]) -> Option<[f64; 2]> {
        let count = self.t.len() / PIECES;
        let every = count.div_ceil(ROWS).max(1);
        let rows: Vec<usize> = (piece * count..(piece + 1) * count).step_by(every).collect();
        let turning = |shift: f64| -self.stands(&rows, shift, Some(pairs)).0;
        let best =
            between_grid(middle, fine, FINE, turning).filter(|best| -best.misfit >= TELLS)?;
        Some([self.t[rows[rows.len() / 2]], best.shift])
    }
}

/// A shift linear in time.
struct Line {
    at_middle: f64,
    middle: f64,
    slope: f64,
    /// Largest residual of a piece \[s\].
    worst: f64,
}

impl Line {
    fn through(points: &[[f64; 2]]) -> Option<Line> {
        let n = points.len() as f64;
        if points.len() < PIECES / 2 {
            return None;
        }
        let middle = points.iter().map(|[t, _]| t).sum::<f64>() / n;
        let at_middle = points.iter().map(|[_, shift]| shift).sum::<f64>() / n;
        let squares: f64 = points.iter().map(|[t, _]| (t - middle).powi(2)).sum();
        let both: f64 = points.iter().map(|[t, s]| (t - middle) * (s - at_middle)).sum();
        let mut line = Line { at_middle, middle, slope: both / squares, worst: 0.0 };
        line.worst = points.iter().map(|[t, s]| (s - line.at(*t)).abs()).fold(0.0, f64::max);
        line.worst.is_finite().then_some(line)
    }

    fn at(&self, t: f64) -> f64 {
        self.at_middle + self.slope * (t - self.middle)
    }
}

/// The log with the motion taken `shift` \[s\] later, a function of time.
fn shifted(log: &Log, shift: &dyn Fn(f64) -> f64) -> Log {
    let t = log.time();
    let [first, last] = [t.first(), t.last()].map(|t| t.copied().unwrap_or_default());
    let kept: Vec<usize> =
        (0..t.len()).filter(|i| (first..=last).contains(&(t[*i] + shift(t[*i])))).collect();
    let mut shifted = log.of_rows(&kept);
    for ((channel, x), moved) in log.channels.iter().zip(&log.values).zip(&mut shifted.values) {
        if channel.is_motion() {
            *moved = kept.iter().map(|i| between(t, x, t[*i] + shift(t[*i]), *i)).collect();
        }
    }
    shifted
}

/// The value of `x` at a time near row `from`, by linear interpolation.
fn between(t: &[f64], x: &[f64], at: f64, from: usize) -> f64 {
    let last = t.len() - 1;
    let mut i = from.min(last.saturating_sub(1));
    while i > 0 && t[i] > at {
        i -= 1;
    }
    while i + 2 <= last && t[i + 1] < at {
        i += 1;
    }
    let next = (i + 1).min(last);
    let width = t[next] - t[i];
    let share = if width > 0.0 { ((at - t[i]) / width).clamp(0.0, 1.0) } else { 0.0 };
    x[i] + share * (x[next] - x[i])
}

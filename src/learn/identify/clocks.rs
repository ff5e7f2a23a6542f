//! Two recorders brought together more closely than their marks can.
//!
//! A logger sets its output after it has looked, and its marks stand between two samples: all of
//! them can be late by the same part of an interval. The field of the motors tells the rest: the
//! current vector stands still from a rotor only at the right time.

use crate::arm::robot::Model;
use crate::learn::log::{Aligned, Channel, Log, Vectors, coherence, vectors};

use super::torque::motor_angle;

/// Intervals of the slower recorder that are searched to each side, and steps in each.
const REACH: i32 = 2;
const STEPS: i32 = 8;
/// Rows that are looked at in the search, and in each piece of the time.
const ROWS: usize = 2000;
/// Pieces of the time that tell how the clocks go by each other.
const PIECES: usize = 6;
/// Steps to each side in a piece, each a sixteenth of one of the search.
const FINE: i32 = 32;
/// Mean share of the vectors that has to stand still for their field to tell anything.
const TELLS: f64 = 0.6;

/// The log at the time that the field tells, and what is said of it.
#[must_use]
pub fn synchronised(model: &Model, aligned: Aligned) -> (Log, String) {
    let Aligned { log, marks, worst, step } = aligned;
    let said = format!("{marks} marks of the two clocks agree within {:.2} ms", 1e3 * worst);
    let alone = format!(
        "{said}; nothing else tells the clocks: positions may be late by up to {:.1} ms",
        1e3 * step
    );
    let Some(motors) = Motors::of(model, &log) else { return (log, alone) };
    let every = log.time().len().div_ceil(ROWS).max(1);
    let all: Vec<usize> = (0..log.time().len()).step_by(every).collect();
    let coarse = step / f64::from(STEPS);
    let best = (-REACH * STEPS..=REACH * STEPS)
        .map(|k| {
            let shift = coarse * f64::from(k);
            let (stands, pairs) = motors.stands(&all, shift, None);
            (stands, shift, pairs)
        })
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let Some((stands, middle, pairs)) = best.filter(|best| best.0 > TELLS) else {
        return (log, alone);
    };
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

/// The vectors of all motors and the angles of their rotors.
struct Motors {
    t: Vec<f64>,
    vectors: Vec<Vectors>,
    angles: Vec<Vec<f64>>,
}

impl Motors {
    fn of(model: &Model, log: &Log) -> Option<Motors> {
        let motors = model.motors.as_ref()?;
        let phase = |joint: usize, phase: usize| log.column(Channel::PhaseCurrent(joint, phase));
        let vectors = (0..model.dof)
            .map(|j| Some(vectors(phase(j, 0)?, phase(j, 1)?, phase(j, 2)?)))
            .collect::<Option<Vec<Vectors>>>()?;
        let angles = (0..model.dof).map(|j| motor_angle(model, log, j, motors.ratio[j])).collect();
        (log.time().len() > ROWS).then(|| Motors { t: log.time().to_vec(), vectors, angles })
    }

    /// Mean share of the vectors that stands still, with the pole pairs of each motor.
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

    /// Time of a piece and the shift that is best there \[s\].
    fn of_piece(&self, piece: usize, middle: f64, fine: f64, pairs: &[i32]) -> Option<[f64; 2]> {
        let count = self.t.len() / PIECES;
        let every = count.div_ceil(ROWS).max(1);
        let rows: Vec<usize> = (piece * count..(piece + 1) * count).step_by(every).collect();
        let stands: Vec<f64> = (-FINE..=FINE)
            .map(|k| self.stands(&rows, middle + fine * f64::from(k), Some(pairs)).0)
            .collect();
        let best = (1..stands.len() - 1).max_by(|a, b| stands[*a].total_cmp(&stands[*b]))?;
        let [before, here, after] = [stands[best - 1], stands[best], stands[best + 1]];
        // At an end there is no maximum.
        let bend = before + after - 2.0 * here;
        if here < TELLS || here < before || here < after || bend >= 0.0 {
            return None;
        }
        let place = best as f64 - f64::from(FINE) + 0.5 * (before - after) / bend;
        Some([self.t[rows[rows.len() / 2]], middle + fine * place])
    }
}

/// A shift that changes with the time.
struct Line {
    at_middle: f64,
    middle: f64,
    slope: f64,
    /// Largest distance of a piece \[s\].
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

/// The motion taken from later by `shift` of the time \[s\].
fn shifted(log: &Log, shift: &dyn Fn(f64) -> f64) -> Log {
    let t = log.time();
    let [first, last] = [t.first(), t.last()].map(|t| t.copied().unwrap_or_default());
    let kept: Vec<usize> =
        (0..t.len()).filter(|i| (first..=last).contains(&(t[*i] + shift(t[*i])))).collect();
    let values = log.channels.iter().zip(&log.values).map(|(channel, x)| {
        let moves = matches!(
            channel,
            Channel::Position(_) | Channel::Velocity(_) | Channel::Acceleration(_)
        );
        let at = |i: &usize| if moves { between(t, x, t[*i] + shift(t[*i]), *i) } else { x[*i] };
        kept.iter().map(at).collect()
    });
    Log {
        channels: log.channels.clone(),
        values: values.collect(),
        rows: kept.iter().map(|i| log.rows[*i]).collect(),
        rejected: log.rejected.clone(),
        degrees: log.degrees.clone(),
    }
}

/// The value of `x` at a time near row `from`, on the line between two rows.
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

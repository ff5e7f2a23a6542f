//! Positions and speeds of a log without its noise.

use std::ops::Range;

use crate::arm::robot::MAX_DOF;
use crate::learn::log::quantile;

use super::run::Run;

/// Half of the time over which a position is smoothed \[s\]: shorter than a ramp of a robot, longer
/// than two samples of most logs.
const HALF: f64 = 0.03;
/// The same in sampling intervals at least, so that a parabola has rows to spare.
const LEAST_ROWS: f64 = 2.0;
/// Coefficients of a parabola.
const ORDER: usize = 3;

/// An instant of a motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant {
    /// Time \[s\].
    pub t: f64,
    /// Positions \[rad\].
    pub q: [f64; MAX_DOF],
    /// Length of the vector of the joint rates \[rad/s\].
    pub speed: f64,
}

impl Instant {
    /// The distance of its positions from others \[rad\].
    pub(super) fn distance(&self, q: &[f64; MAX_DOF]) -> f64 {
        let squares: f64 = self.q.iter().zip(q).map(|(a, b)| (a - b).powi(2)).sum();
        squares.sqrt()
    }
}

/// The motion of a log.
pub(super) struct Smooth {
    /// One instant for each row.
    pub rows: Vec<Instant>,
    /// Deviation of the speeds \[rad/s\].
    pub noise: f64,
}

impl Smooth {
    /// The motion of a log, smoothed as that of the logs that it is compared with, whose rows are at
    /// most `step` \[s\] apart.
    pub(super) fn of(run: &Run, step: f64) -> Smooth {
        let half = HALF.max(LEAST_ROWS * step) * (1.0 + f64::EPSILON);
        let (mut from, mut to) = (0, 0);
        let (mut rows, mut noises) = (Vec::with_capacity(run.t.len()), Vec::new());
        for t in run.t.iter().copied() {
            while run.t[from] < t - half {
                from += 1;
            }
            while to < run.t.len() && run.t[to] <= t + half {
                to += 1;
            }
            let (instant, noise) = local(run, from..to, t);
            rows.push(instant);
            noises.extend(noise);
        }
        let noise = quantile(noises.into_iter(), 0.5);
        Smooth { rows, noise }
    }

    /// How long the robot is slower than a speed between two rows \[s\].
    pub(super) fn resting(&self, from: usize, to: usize, speed: f64) -> f64 {
        let rows = self.rows.get(from..to).unwrap_or_default();
        let pairs = rows.windows(2).filter(|pair| pair[0].speed < speed);
        pairs.map(|pair| pair[1].t - pair[0].t).sum()
    }

    /// The rows of some in which the robot is not slower than a speed, from one of them to both sides.
    pub(super) fn moving(&self, rows: Range<usize>, at: usize, speed: f64) -> Range<usize> {
        let is_slow = |row: &usize| self.rows[*row].speed < speed;
        let from = (rows.start..at).rev().find(is_slow).unwrap_or(rows.start);
        let to = (at..rows.end.min(self.rows.len())).find(is_slow).unwrap_or(rows.end);
        from..to
    }

    /// Where the motion is nearest to some positions, between two rows.
    pub(super) fn nearest(&self, from: usize, to: usize, q: &[f64; MAX_DOF]) -> Option<Passage> {
        let rows = self.rows.get(from..to.min(self.rows.len()))?;
        let distances = rows.iter().map(|of| of.distance(q));
        let (near, _) = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let row = from + near;
        let mut instant = self.rows[row];
        if near > 0 && near + 1 < rows.len() {
            let [a, b, c] = [row - 1, row, row + 1].map(|row| self.rows[row]);
            let [low, least, high] = [a, b, c].map(|of| of.distance(q).powi(2));
            let curvature = low + high - 2.0 * least;
            if curvature > 0.0 {
                let place = 0.5 * (low - high) / curvature;
                let other = if place < 0.0 { a } else { c };
                instant = between(&b, &other, place.abs().min(1.0));
            }
        }
        Some(Passage { row, instant })
    }
}

/// Where a motion passes a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage {
    /// The row beside it.
    pub row: usize,
    /// The instant.
    pub instant: Instant,
}

fn between(a: &Instant, b: &Instant, share: f64) -> Instant {
    let mix = |a: f64, b: f64| a + share * (b - a);
    let mut q = a.q;
    q.iter_mut().zip(&b.q).for_each(|(a, b)| *a = mix(*a, *b));
    Instant { t: mix(a.t, b.t), q, speed: mix(a.speed, b.speed) }
}

/// The parabola through some rows by least squares, at a time, and the deviation of its speed.
fn local(run: &Run, rows: Range<usize>, t: f64) -> (Instant, Option<f64>) {
    let mut moments = [0.0; 2 * ORDER - 1];
    for at in &run.t[rows.clone()] {
        let mut power = 1.0;
        for moment in &mut moments {
            *moment += power;
            power *= at - t;
        }
    }
    let count = moments[0];
    let mut instant = Instant { t, q: [0.0; MAX_DOF], speed: 0.0 };
    let normal = [0, 1, 2].map(|k| [moments[k], moments[k + 1], moments[k + 2]]);
    let whole = determinant(&normal);
    let (mut speed, mut missed) = (0.0, 0.0);
    for (joint, positions) in run.q.iter().enumerate() {
        let mut sides = [0.0; ORDER];
        let mut squares = 0.0;
        // Small numbers: the squares that are missed are a difference.
        let own = positions[rows.start];
        for (at, q) in run.t[rows.clone()].iter().zip(&positions[rows.clone()]) {
            let (x, y) = (at - t, q - own);
            squares += y * y;
            sides[0] += y;
            sides[1] += y * x;
            sides[2] += y * x * x;
        }
        let fitted = [0, 1, 2].map(|column| {
            let mut replaced = normal;
            replaced.iter_mut().zip(sides).for_each(|(row, side)| row[column] = side);
            determinant(&replaced) / whole
        });
        if count >= ORDER as f64 && fitted.iter().all(|x| x.is_finite()) {
            instant.q[joint] = own + fitted[0];
            speed += fitted[1] * fitted[1];
            let explained: f64 = fitted.iter().zip(sides).map(|(a, b)| a * b).sum();
            missed += (squares - explained).max(0.0);
        } else {
            instant.q[joint] = own;
        }
    }
    instant.speed = speed.sqrt();
    let spare = count - ORDER as f64;
    let noise = (spare > 0.0 && moments[2] > 0.0).then(|| (missed / spare / moments[2]).sqrt());
    (instant, noise)
}

fn determinant(m: &[[f64; 3]; 3]) -> f64 {
    m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
}

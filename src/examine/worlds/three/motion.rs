//! Motions as people record them, on a fine grid of time.

use super::arm::Arm;
use super::profile::{Limits, Profile};
use super::spatial::Point;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;
use std::f64::consts::{PI, TAU};

/// Step of the internal grid \[s\]: half a period of 250 Hz, the servo cycle of many controllers.
pub(super) const STEP: f64 = 0.002;

/// One period of a motion on the grid.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) points: Vec<Point>,
}

impl Track {
    /// The state at a time \[s\] from its start, cyclic: Taylor series about the nearest grid point.
    pub(super) fn angles(&self, time: f64) -> Row {
        let steps = (time / STEP).round();
        let h = time - steps * STEP;
        let point = &self.points[steps.rem_euclid(self.points.len() as f64) as usize];
        let mut out = [0.0; MAX];
        for (i, value) in out.iter_mut().enumerate() {
            *value = point.q[i] + h * (point.v[i] + 0.5 * h * point.a[i]);
        }
        out
    }
}

/// Kinds of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Style {
    Fourier,
    /// Moves between random poses with soft profiles and dwells.
    Moves,
    /// Moves with hard profiles: nearly trapezoids of the rate.
    Trapezoids,
    /// Two stations with approach and retreat.
    PickAndPlace,
    /// Sines whose frequency grows.
    Chirp,
    /// Each joint back and forth at low, constant rate.
    Sweep,
}

/// All styles with their shares in per cent; pick-and-place is this world's emphasis.
const SHARES: [(Style, usize); 6] = [
    (Style::Fourier, 30),
    (Style::Moves, 18),
    (Style::Trapezoids, 12),
    (Style::PickAndPlace, 22),
    (Style::Chirp, 8),
    (Style::Sweep, 10),
];

/// A style by its share.
pub(super) fn style(rng: &mut Rng) -> Style {
    let mut ticket = rng.below(100);
    for (style, share) in SHARES {
        if ticket < share {
            return style;
        }
        ticket -= share;
    }
    Style::Fourier
}

/// One period of a motion of `duration` \[s\] (a multiple of the grid's step).
pub(super) fn track(style: Style, arm: &Arm, duration: f64, rng: &mut Rng) -> Track {
    let count = (duration / STEP).round() as usize;
    match style {
        Style::Fourier => fourier(arm, count, rng),
        Style::Moves => moves(arm, count, false, 0.12, rng),
        Style::Trapezoids => moves(arm, count, false, 0.02, rng),
        Style::PickAndPlace => moves(arm, count, true, 0.08, rng),
        Style::Chirp => chirp(arm, count, rng),
        Style::Sweep => sweep(arm, count, rng),
    }
}

/// Random Fourier series (J. Swevers et al., IEEE T-RA 13, 1997), scaled to the limits.
fn fourier(arm: &Arm, count: usize, rng: &mut Rng) -> Track {
    let period = count as f64 * STEP;
    let highest = (0.7 * period).clamp(4.0, 30.0) as usize;
    let effort = rng.between(0.45, 0.95);
    let mut points = vec![Point::default(); count];
    for i in 0..arm.axes() {
        let terms: Vec<(f64, f64, f64)> = (0..rng.whole(4, 6))
            .map(|k| {
                let order = if k == 0 { rng.whole(1, 2) } else { rng.whole(1, highest) };
                let omega = TAU * order as f64 / period;
                (omega, rng.normal() / (0.4 + omega), rng.between(0.0, TAU))
            })
            .collect();
        let value = |time: f64| {
            let [mut q, mut v, mut a] = [0.0; 3];
            for (omega, size, phase) in &terms {
                let (sin, cos) = (omega * time + phase).sin_cos();
                q += size * sin;
                v += size * omega * cos;
                a -= size * omega * omega * sin;
            }
            [q, v, a]
        };
        let mut most = [1e-9_f64; 3];
        let coarse = (count / 500).max(1);
        for k in (0..count).step_by(coarse) {
            for (most, now) in most.iter_mut().zip(value(k as f64 * STEP)) {
                *most = most.max(now.abs());
            }
        }
        let scale = (arm.span[i] * rng.between(0.6, 1.0) / most[0])
            .min(effort * arm.speed[i] / most[1])
            .min(effort * arm.acceleration[i] / most[2]);
        let centre = arm.middle[i] + 0.1 * arm.span[i] * rng.between(-1.0, 1.0);
        for (k, point) in points.iter_mut().enumerate() {
            let [q, v, a] = value(k as f64 * STEP);
            point.q[i] = centre + scale * q;
            point.v[i] = scale * v;
            point.a[i] = scale * a;
        }
    }
    Track { points }
}

/// Random pose in the arm's work space, `size` of it.
fn pose(arm: &Arm, size: f64, rng: &mut Rng) -> Row {
    let mut out = [0.0; MAX];
    for (i, value) in out.iter_mut().enumerate().take(arm.axes()) {
        *value = arm.middle[i] + size * arm.span[i] * rng.between(-1.0, 1.0);
    }
    out
}

/// Poses of one round of pick-and-place: over a station, down, up, to the other one.
fn stations(arm: &Arm, rng: &mut Rng) -> Vec<Row> {
    let home = pose(arm, 0.3, rng);
    let mut out = vec![home];
    let mut turn = rng.sign();
    for _ in 0..rng.whole(2, 3) {
        let mut above = pose(arm, 0.6, rng);
        above[0] = arm.middle[0] + turn * arm.span[0] * rng.between(0.3, 0.9);
        turn = -turn;
        let mut down = above;
        for i in 1..arm.axes().min(5) {
            down[i] += 0.15 * arm.span[i] * rng.between(-1.0, 1.0);
        }
        out.extend([above, down, above]);
    }
    out
}

/// Limits of the shared path parameter so that no joint passes its own.
pub(super) fn shared(arm: &Arm, change: &Row, share: f64, ramp: f64) -> Limits {
    let mut limits = Limits { rate: 1e3, acceleration: 1e4, jerk: 1e6 };
    for i in 0..arm.axes() {
        let size = change[i].abs().max(1e-6);
        limits.rate = limits.rate.min(share * arm.speed[i] / size);
        limits.acceleration = limits.acceleration.min(share * arm.acceleration[i] / size);
    }
    limits.jerk = limits.acceleration / ramp;
    limits
}

/// Moves between poses, back to the first, the rest of the time in dwells.
fn moves(arm: &Arm, count: usize, stationed: bool, ramp: f64, rng: &mut Rng) -> Track {
    let period = count as f64 * STEP;
    let busy = period * rng.between(0.7, 0.92);
    let share = rng.between(0.4, 0.95);
    let mut poses = if stationed { stations(arm, rng) } else { vec![pose(arm, 0.9, rng)] };
    let start = poses.first().copied().unwrap_or_default();
    let mut now = start;
    let mut legs: Vec<(Row, Row, Profile)> = Vec::new();
    let mut used = 0.0;
    poses.reverse();
    poses.pop();
    let leg = |from: &Row, to: &Row| {
        let mut change = [0.0; MAX];
        for i in 0..arm.axes() {
            change[i] = to[i] - from[i];
        }
        Profile::new(1.0, &shared(arm, &change, share, ramp))
    };
    loop {
        let mut next = poses.pop().unwrap_or_else(|| pose(arm, 0.9, rng));
        let (mut go, mut back) = (leg(&now, &next), leg(&next, &start));
        // The first move always fits: it becomes shorter.
        while legs.is_empty() && go.duration() + back.duration() > busy {
            for i in 0..arm.axes() {
                next[i] = start[i] + 0.7 * (next[i] - start[i]);
            }
            (go, back) = (leg(&now, &next), leg(&next, &start));
        }
        if used + go.duration() + back.duration() > busy && !legs.is_empty() {
            break;
        }
        used += go.duration();
        legs.push((now, next, go));
        now = next;
    }
    let back = leg(&now, &start);
    used += back.duration();
    legs.push((now, start, back));
    let weights: Vec<f64> = legs.iter().map(|_| rng.between(0.2, 1.0)).collect();
    let free = (period - used) / weights.iter().sum::<f64>();
    let mut points = vec![Point { q: start, ..Point::default() }; count];
    let mut begin = 0.0;
    for ((from, to, profile), weight) in legs.iter().zip(&weights) {
        let end = begin + profile.duration() + free * weight;
        let first = (begin / STEP).ceil() as usize;
        for (k, point) in points.iter_mut().enumerate().skip(first) {
            let time = k as f64 * STEP;
            if time >= end {
                break;
            }
            let [s, v, a] = profile.at(time - begin);
            for i in 0..arm.axes() {
                let change = to[i] - from[i];
                point.q[i] = from[i] + s * change;
                point.v[i] = v * change;
                point.a[i] = a * change;
            }
        }
        begin = end;
    }
    Track { points }
}

/// Sines of growing frequency, their size within the limits, still at both ends.
fn chirp(arm: &Arm, count: usize, rng: &mut Rng) -> Track {
    let period = count as f64 * STEP;
    let mut points = vec![Point::default(); count];
    let effort = rng.between(0.4, 0.8);
    for i in 0..arm.axes() {
        let low = rng.between(0.05, 0.15);
        let high = rng.between(0.8, 2.5);
        let growth = (high / low).ln();
        let size = 0.7 * arm.span[i];
        let towards = rng.sign();
        let centre = arm.middle[i];
        // Soft start and stop take 1.5 s each, at most a quarter of the period.
        let soft = (1.5 / period).min(0.25);
        let value = |time: f64| {
            let x = (time / period).clamp(0.0, 1.0);
            let omega = TAU * low * (growth * x).exp();
            let angle = TAU * low * period / growth * ((growth * x).exp() - 1.0);
            // A smooth minimum of the three limits: a kink would be a jump of the rate.
            let limits = [
                size,
                effort * arm.speed[i] / omega,
                effort * arm.acceleration[i] / (omega * omega),
            ];
            let bound = limits.iter().map(|limit| limit.powi(-4)).sum::<f64>().powf(-0.25);
            let edge = (x.min(1.0 - x) / soft).min(1.0);
            let window = (0.5 * PI * edge).sin().powi(4);
            centre + towards * bound * window * angle.sin()
        };
        fill(&mut points, i, value);
    }
    Track { points }
}

/// Angle, rate and acceleration of joint `i` from a smooth function of time.
fn fill(points: &mut [Point], i: usize, value: impl Fn(f64) -> f64) {
    for (k, point) in points.iter_mut().enumerate() {
        let time = k as f64 * STEP;
        let (before, now, after) = (value(time - STEP), value(time), value(time + STEP));
        point.q[i] = now;
        point.v[i] = (after - before) / (2.0 * STEP);
        point.a[i] = (after - 2.0 * now + before) / (STEP * STEP);
    }
}

/// Back and forth at constant, low rate with short turns; joints with different counts of turns.
fn sweep(arm: &Arm, count: usize, rng: &mut Rng) -> Track {
    /// Time in which the acceleration builds up \[s\].
    const SOFT: f64 = 0.03;
    let period = count as f64 * STEP;
    let mut points = vec![Point::default(); count];
    for i in 0..arm.axes() {
        // Turns take three seconds at least: the sweep stays slow.
        let turns = rng.whole(1, ((period / 6.0) as usize).clamp(1, 3)) as f64;
        let half = 0.5 * period / turns;
        let acceleration = 0.3 * arm.acceleration[i];
        let most = (0.24 * arm.speed[i] * half).min(0.2 * acceleration * (half - SOFT).powi(2));
        let width = (2.0 * arm.span[i] * rng.between(0.5, 0.95)).min(most);
        // width = rate·(half − ramp) − rate²/acceleration with ramps of the acceleration.
        let free = half - SOFT;
        let under = (free * free - 4.0 * width / acceleration).max(0.0).sqrt();
        let rate = 0.5 * acceleration * (free - under);
        let profile =
            Profile::new(width, &Limits { rate, acceleration, jerk: acceleration / SOFT });
        let low = arm.middle[i] - 0.5 * width;
        let shift = rng.between(0.0, 2.0 * half);
        for (k, point) in points.iter_mut().enumerate() {
            let time = (k as f64 * STEP + shift).rem_euclid(2.0 * half);
            let (sign, start, time) =
                if time < half { (1.0, low, time) } else { (-1.0, low + width, time - half) };
            let [s, v, a] = profile.at(time);
            point.q[i] = start + sign * s;
            point.v[i] = sign * v;
            point.a[i] = sign * a;
        }
    }
    Track { points }
}

/// The first period with a transient: it starts elsewhere and joins within `time` \[s\].
pub(super) fn entry(track: &Track, offset: &Row, time: f64) -> Track {
    let mut points = track.points.clone();
    let rate = PI / time;
    for (k, point) in points.iter_mut().enumerate() {
        let x = rate * k as f64 * STEP;
        if x >= PI {
            break;
        }
        for i in 0..MAX {
            point.q[i] += 0.5 * offset[i] * (1.0 + x.cos());
            point.v[i] -= 0.5 * offset[i] * rate * x.sin();
            point.a[i] -= 0.5 * offset[i] * rate * rate * x.cos();
        }
    }
    Track { points }
}

//! Motions of the links as people record them, on a fine grid of time.

use super::arm::Arm;
use super::profile::Profile;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;
use std::f64::consts::TAU;

/// Step of the fine grid \[s\]: the integrator runs at 2 kHz.
pub(super) const STEP: f64 = 0.0005;
/// Fine steps in a step of the rigid bodies, which change slowly (500 Hz).
pub(super) const STRIDE: usize = 4;
/// Share of the range of the angles that motions use.
const RANGE: (f64, f64) = (0.35, 0.85);
/// Share of the speed limit that motions use.
const PACE: (f64, f64) = (0.35, 0.9);
/// Speed of slow sweeps over the limit.
const SLOW: (f64, f64) = (0.05, 0.15);
/// Harmonics of a Fourier series (J. Swevers et al., IEEE T-RA 13, 1997).
const HARMONICS: (usize, usize) = (3, 7);
/// Time of rest between two moves \[s\].
const DWELL: (f64, f64) = (0.05, 0.9);
/// Shares of a move's time to full acceleration that the jerk takes: trapezoid, S-curve.
const JERK_SHARES: [f64; 2] = [0.12, 0.5];
/// Chirps: lowest and highest frequency \[Hz\].
const CHIRP: [(f64, f64); 2] = [(0.05, 0.15), (0.5, 1.6)];
/// Time in which a motion grows from rest at the start of a log \[s\].
const LEAD_IN: (f64, f64) = (0.6, 2.0);
/// Rest in which the brakes fall in, for logs of power \[s\].
const LONG_REST: (f64, f64) = (2.0, 5.0);

/// Ways to move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Style {
    Fourier,
    /// Moves with trapezoidal speed, and dwells.
    Trapezoid,
    /// Moves with S-curves, and dwells.
    Curve,
    Chirp,
    Sweep,
}

/// Angles, speeds and accelerations on the fine grid.
#[derive(Clone, Debug, Default)]
pub(super) struct Path {
    /// Angles \[rad\].
    pub(super) q: Vec<Row>,
    /// Speeds \[rad/s\].
    pub(super) v: Vec<Row>,
    /// Accelerations \[rad/s²\].
    pub(super) a: Vec<Row>,
}

/// A motion that is repeated.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) cycle: Path,
    /// The first period, where it starts from rest.
    pub(super) lead: Option<Path>,
    pub(super) steps: usize,
    pub(super) cycles: usize,
}

impl Track {
    /// Duration of one period \[s\].
    pub(super) fn period(&self) -> f64 {
        self.steps as f64 * STEP
    }
}

/// Fine steps of a period of about a duration \[s\].
fn steps_of(period: f64) -> usize {
    ((period / STEP / STRIDE as f64).ceil() as usize).max(1) * STRIDE
}

/// Centre and half range \[rad\] that one joint uses.
fn place(arm: &Arm, j: usize, rng: &mut Rng) -> (f64, f64) {
    // Continuous axes would otherwise turn for most of the time.
    let half = (0.5 * (arm.upper[j] - arm.lower[j])).min(2.2);
    let used = half * rng.uniform(RANGE);
    let middle = 0.5 * (arm.upper[j] + arm.lower[j]);
    (middle + rng.uniform((-1.0, 1.0)) * (half - used), used)
}

/// Stretches one joint's motion, given about 0, to its range and limits.
fn fit(path: &mut Path, arm: &Arm, j: usize, rng: &mut Rng) {
    let most = |rows: &[Row]| rows.iter().map(|row| row[j].abs()).fold(1e-12, f64::max);
    let (centre, half) = place(arm, j, rng);
    let pace = rng.uniform(PACE);
    let scale = (half / most(&path.q))
        .min(pace * arm.velocity[j] / most(&path.v))
        .min(pace * arm.acceleration[j] / most(&path.a));
    for row in 0..path.q.len() {
        path.q[row][j] = centre + scale * path.q[row][j];
        path.v[row][j] *= scale;
        path.a[row][j] *= scale;
    }
}

fn blank(steps: usize) -> Path {
    let rows = vec![[0.0; MAX]; steps];
    Path { q: rows.clone(), v: rows.clone(), a: rows }
}

fn fourier(arm: &Arm, steps: usize, rng: &mut Rng) -> Path {
    let mut path = blank(steps);
    let harmonics = HARMONICS.0 + rng.below(HARMONICS.1 - HARMONICS.0 + 1);
    // Long periods hold more waves, so that the joints move as fast.
    let stretch = (steps as f64 * STEP / 8.0).round().max(1.0);
    for j in 0..arm.count() {
        for k in 1..=harmonics {
            let order = (k as f64 * stretch).round();
            let (amplitude, phase) = (rng.spread(1.0) / k as f64, rng.angle());
            let step = TAU * order / steps as f64;
            let omega = step / STEP;
            // The phasor is turned from row to row: rounding grows to 1e-11 at most.
            let ((mut sin, mut cos), (ds, dc)) = (phase.sin_cos(), step.sin_cos());
            for row in 0..steps {
                path.q[row][j] += amplitude * sin;
                path.v[row][j] += amplitude * omega * cos;
                path.a[row][j] -= amplitude * omega * omega * sin;
                (sin, cos) = (sin * dc + cos * ds, cos * dc - sin * ds);
            }
        }
        fit(&mut path, arm, j, rng);
    }
    path
}

/// Chirps under an envelope that is zero at both ends.
fn chirp(arm: &Arm, steps: usize, rng: &mut Rng) -> Path {
    let mut path = blank(steps);
    let whole = steps as f64 * STEP;
    for j in 0..arm.count() {
        let (low, high) = (rng.log(CHIRP[0]), rng.log(CHIRP[1]));
        let rate = (high / low).ln() / whole;
        let start = rng.angle();
        for row in 0..steps {
            let t = row as f64 * STEP;
            let (es, ec) = (TAU * 0.5 * t / whole).sin_cos();
            let w = TAU * 0.5 / whole;
            // Envelope sin², its first and second derivatives.
            let (e, de, dde) = (es * es, 2.0 * w * es * ec, 2.0 * w * w * (ec * ec - es * es));
            let f = TAU * low * (rate * t).exp();
            let (s, c) = (start + f / rate).sin_cos();
            let (ds, dds) = (f * c, f * rate * c - f * f * s);
            path.q[row][j] = e * s;
            path.v[row][j] = de * s + e * ds;
            path.a[row][j] = dde * s + 2.0 * de * ds + e * dds;
        }
        fit(&mut path, arm, j, rng);
    }
    path
}

/// A joint move on the grid.
struct Move {
    start: f64,
    delta: Row,
    profile: Profile,
}

/// Evaluates moves one after the other, from a start.
fn lay(from: &Row, moves: &[Move], steps: usize) -> Path {
    let mut path = blank(steps);
    let (mut base, mut done) = (*from, 0);
    for row in 0..steps {
        let t = row as f64 * STEP;
        while let Some(part) = moves.get(done).filter(|m| m.start + m.profile.duration <= t) {
            for j in 0..MAX {
                base[j] += part.delta[j];
            }
            done += 1;
        }
        path.q[row] = base;
        for part in moves.iter().skip(done) {
            if t < part.start {
                break;
            }
            let (s, v, a) = part.profile.at(t - part.start);
            for j in 0..MAX {
                path.q[row][j] += part.delta[j] * s;
                path.v[row][j] += part.delta[j] * v;
                path.a[row][j] += part.delta[j] * a;
            }
        }
    }
    path
}

/// A move that keeps the limits.
fn make(arm: &Arm, delta: Row, start: f64, pace: f64, jerk_share: f64) -> Move {
    let (mut v, mut a) = (f64::MAX, f64::MAX);
    for j in 0..arm.count() {
        let way = delta[j].abs().max(1e-6);
        v = v.min(pace * arm.velocity[j] / way);
        a = a.min(pace.max(0.3) * arm.acceleration[j] / way);
    }
    let jerk = a * a / (jerk_share * v);
    Move { start, delta, profile: Profile::new(v, a, jerk) }
}

/// Moves from pose to pose until the period is full; the last one leads back.
fn points(arm: &Arm, period: f64, style: Style, rest: f64, rng: &mut Rng) -> Path {
    let pace = if style == Style::Sweep { rng.log(SLOW) } else { rng.uniform(PACE) };
    let share = JERK_SHARES[usize::from(style == Style::Curve)];
    let places: Vec<(f64, f64)> = (0..arm.count()).map(|j| place(arm, j, rng)).collect();
    let pose = |rng: &mut Rng| {
        let mut q = [0.0; MAX];
        for (j, (centre, half)) in places.iter().enumerate() {
            q[j] = centre + half * rng.uniform((-1.0, 1.0));
        }
        q
    };
    let from = pose(rng);
    let (mut here, mut t, mut moves) = (from, rng.uniform(DWELL), Vec::new());
    loop {
        let mut to = pose(rng);
        let last = t > 0.75 * (period - rest);
        if last {
            to = from;
        } else if rng.chance(0.25) && !moves.is_empty() {
            // Some moves are of one joint alone.
            let only = rng.below(arm.count());
            for j in 0..arm.count() {
                to[j] = if j == only { to[j] } else { here[j] };
            }
        }
        let mut delta = [0.0; MAX];
        for j in 0..arm.count() {
            delta[j] = to[j] - here[j];
        }
        let part = make(arm, delta, t, pace, share);
        t += part.profile.duration + if style == Style::Sweep { 0.1 } else { rng.uniform(DWELL) };
        moves.push(part);
        here = to;
        if last {
            break;
        }
    }
    lay(&from, &moves, steps_of((t + rest).max(0.6 * period)))
}

/// The first period from rest: the motion grows about its own start.
fn grown(path: &Path, rng: &mut Rng) -> Path {
    let ramp = rng.uniform(LEAD_IN);
    let mut lead = path.clone();
    let from = path.q[0];
    for row in 0..((ramp / STEP) as usize).min(path.q.len()) {
        let x = row as f64 * STEP / ramp;
        let w = x * x * x * (10.0 - x * (15.0 - 6.0 * x));
        let dw = 30.0 * x * x * (1.0 - x) * (1.0 - x) / ramp;
        let ddw = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / (ramp * ramp);
        for j in 0..MAX {
            let d = path.q[row][j] - from[j];
            lead.q[row][j] = from[j] + w * d;
            lead.v[row][j] = dw * d + w * path.v[row][j];
            lead.a[row][j] = ddw * d + 2.0 * dw * path.v[row][j] + w * path.a[row][j];
        }
    }
    lead
}

/// A random style; chirps and sweeps are rarer.
pub(super) fn style(rng: &mut Rng) -> Style {
    let all = [Style::Fourier, Style::Trapezoid, Style::Curve, Style::Chirp, Style::Sweep];
    all[rng.weighted(&[0.38, 0.2, 0.22, 0.1, 0.1])]
}

/// A motion of about a period \[s\]; `rests` asks for a long rest at the end of each.
pub(super) fn track(arm: &Arm, style: Style, plan: (f64, usize, bool), rng: &mut Rng) -> Track {
    let (period, cycles, rests) = plan;
    let rest = if rests { rng.uniform(LONG_REST) } else { 0.0 };
    let cycle = match style {
        Style::Fourier => fourier(arm, steps_of(period), rng),
        Style::Chirp => chirp(arm, steps_of(period), rng),
        _ => points(arm, period, style, rest, rng),
    };
    let lead = (style == Style::Fourier && rng.chance(0.4)).then(|| grown(&cycle, rng));
    Track { steps: cycle.q.len(), cycle, lead, cycles }
}

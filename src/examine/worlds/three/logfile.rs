//! The CSV of a log: sampling, jitter, noise, quantisation, decimals, lost rows.

use super::drive::{Run, World};
use super::motion::STEP;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;
use crate::examine::worlds::table::{Table, quantised};

/// A logger.
#[derive(Clone, Debug)]
pub(super) struct Recorder {
    pub(super) rate: f64,
    pub(super) digits: [usize; 3],
    /// Time of the first row \[s\].
    pub(super) start: f64,
    pub(super) rates: bool,
    /// Share of the rows that are lost.
    pub(super) lost: f64,
}

impl Recorder {
    /// A logger of a rate \[Hz\]; `zero` asks for times from 0.
    pub(super) fn new(rate: f64, zero: bool, rng: &mut Rng) -> Self {
        let start = if zero || rng.chance(0.6) {
            0.0
        } else {
            rng.log_between(1.0, 5e4).round() + 0.01 * rng.below(100) as f64
        };
        Self {
            rate,
            digits: [rng.whole(4, 6), rng.whole(5, 8), rng.whole(2, 5)],
            start,
            rates: rng.chance(0.35),
            lost: if rng.chance(0.3) { rng.log_between(2e-4, 5e-3) } else { 0.0 },
        }
    }
}

/// A series at a time \[s\], linear; held at its ends.
pub(super) fn sampled(series: &[Row], time: f64) -> Row {
    let last = series.len().saturating_sub(1);
    let steps = (time / STEP).clamp(0.0, last as f64);
    let k = steps.floor() as usize;
    let share = steps - k as f64;
    let mut out = [0.0; MAX];
    if let (Some(low), Some(high)) = (series.get(k), series.get((k + 1).min(last))) {
        for (i, value) in out.iter_mut().enumerate() {
            *value = low[i] + share * (high[i] - low[i]);
        }
    }
    out
}

/// Decimals of torques that keep small wrists visible: five significant ones of the usual torque.
fn torque_digits(world: &World, digits: usize) -> Vec<usize> {
    let one = |usual: &f64| {
        let size = usual.max(1e-6).log10().floor();
        digits.max((3.0 - size).clamp(0.0, 8.0) as usize)
    };
    world.nominal.usual.iter().take(world.nominal.axes()).map(one).collect()
}

/// The text of a log: clean torques \[Nm\] and powers \[W\] (may be empty), both [`STEP`] apart.
pub(super) fn csv(
    world: &World,
    run: &Run,
    series: &[Row],
    powers: &[f64],
    logger: &Recorder,
    rng: &mut Rng,
) -> String {
    let count = world.nominal.axes();
    let groups: &[&str] = if logger.rates { &["q", "qd", "tau"] } else { &["q", "tau"] };
    let single: &[&str] = if powers.is_empty() { &[] } else { &["power"] };
    let mut out = Table::new(count, groups, single);
    let dt = 1.0 / logger.rate;
    let length = series.len() as f64 * STEP;
    let rows = (length * logger.rate + 1e-6).floor() as usize;
    let period = run.track.points.len() as f64 * STEP;
    let keep = (-dt / world.everyday.colour).exp();
    let drive = (1.0 - keep * keep).sqrt();
    let mut coloured = [0.0; MAX];
    let [time_digits, angle_digits, digits] = logger.digits;
    let torque_digits = torque_digits(world, digits);
    for row in 0..rows {
        let jitter = world.everyday.jitter * dt;
        let time = (row as f64 * dt + rng.spread(jitter)).max(0.0);
        let stamp = logger.start + (time + rng.spread(0.5 * jitter)).max(0.0);
        for (value, habit) in coloured.iter_mut().zip(&world.everyday.joints) {
            *value = keep * *value + drive * habit.coloured * rng.normal();
        }
        let white: Vec<f64> =
            world.everyday.joints.iter().map(|habit| habit.white * rng.normal()).collect();
        if row > 0 && rng.chance(logger.lost) {
            continue;
        }
        let track = match &run.entry {
            // Its last step would wrap to its start; the transient has died out long before.
            Some(entry) if time < period - STEP => entry,
            _ => &run.track,
        };
        out.row(stamp, time_digits);
        for (angle, habit) in track.angles(time).iter().zip(&world.everyday.joints) {
            out.value(quantised(*angle, habit.step), angle_digits);
        }
        if logger.rates {
            // Rates from the angles of one servo cycle on both sides, as drives compute them.
            let from = (time - STEP).max(0.0);
            let (before, after) = (track.angles(from), track.angles(time + STEP));
            for (i, habit) in world.everyday.joints.iter().enumerate() {
                let rate = (after[i] - before[i]) / (time + STEP - from);
                out.value(rate + habit.step * 20.0 * rng.normal(), 5);
            }
        }
        let torques = sampled(series, time + world.everyday.late);
        for (i, habit) in world.everyday.joints.iter().enumerate() {
            let noisy = torques[i] + white[i] + coloured[i];
            out.value(quantised(noisy, habit.quantum), torque_digits[i]);
        }
        if !powers.is_empty() {
            out.value(powers[((time / STEP).round() as usize).min(powers.len() - 1)], 1);
        }
    }
    out.finish()
}

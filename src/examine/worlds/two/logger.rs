//! Logs as files: quantised, noisy, jittered, with lost rows.

use super::plant::Record;
use crate::examine::worlds::model::{MAX, Row};
use crate::examine::worlds::random::Rng;
use crate::examine::worlds::table::{Table, quantised};

/// How a logger writes.
#[derive(Clone, Debug)]
pub(super) struct Style {
    pub(super) n: usize,
    /// Decimals of times, angles and torques.
    pub(super) decimals: (usize, usize, usize),
    /// Time of the first row \[s\].
    pub(super) start: f64,
    /// Standard deviation of the time stamps \[s\].
    pub(super) jitter: f64,
    pub(super) lost: f64,
    /// Step of the encoders \[rad\].
    pub(super) encoder: f64,
    /// Step of the torques \[Nm\].
    pub(super) current: Row,
    /// Standard deviation of the noise of the torques \[Nm\].
    pub(super) noise: Row,
    /// Share of the noise that is kept from row to row.
    pub(super) colour: f64,
    pub(super) rates: bool,
}

/// Steps of the current over its range (12 to 15 bits).
const BITS: (f64, f64) = (4096.0, 32768.0);

impl Style {
    /// Draws the style of a case; `torque` are rms torques and `limit` the largest \[Nm\].
    pub(super) fn draw(n: usize, torque: &Row, limit: &Row, rate: f64, rng: &mut Rng) -> Self {
        let bits = rng.log_between(BITS.0, BITS.1);
        let share = rng.log_between(0.002, 0.015);
        let mut noise = [0.0; MAX];
        for i in 0..n {
            noise[i] = share * rng.between(0.7, 1.4) * torque[i];
        }
        let finest = torque.iter().take(n).fold(f64::INFINITY, |a, b| a.min(*b));
        // Decimals enough for the smallest torque.
        let torque_decimals = (3.0 - finest.log10()).ceil().clamp(2.0, 6.0) as usize;
        Self {
            n,
            decimals: (rng.pick(&[4, 5, 6]), rng.pick(&[5, 6, 7]), torque_decimals),
            start: if rng.chance(0.35) {
                (rng.log_between(10.0, 1e5) * 1e3).round() / 1e3
            } else {
                0.0
            },
            jitter: if rng.chance(0.7) {
                rng.log_between(2e-5, 4e-4) * (100.0 / rate).min(1.0)
            } else {
                0.0
            },
            lost: if rng.chance(0.3) { rng.log_between(5e-4, 5e-3) } else { 0.0 },
            encoder: rng.log_between(1e-6, 4e-5),
            current: limit.map(|x| 2.0 * x / bits),
            noise,
            colour: rng.between(0.0, 0.7),
            rates: rng.chance(0.35),
        }
    }

    /// Standard deviation of the torque noise with quantisation \[Nm\].
    pub(super) fn deviation(&self, i: usize) -> f64 {
        (self.noise[i].powi(2) + self.current[i].powi(2) / 12.0).sqrt()
    }
}

/// A column of numbers beside those of the robot.
pub(super) type Extra<'a> = (&'a str, usize, Vec<f64>);

/// A log as CSV; without torques where `torques` is false.
pub(super) fn csv(
    style: &Style,
    record: &Record,
    torques: bool,
    extra: &[Extra],
    rng: &mut Rng,
) -> String {
    let groups: &[&str] = match (torques, style.rates) {
        (true, true) => &["q", "qd", "tau"],
        (true, false) => &["q", "tau"],
        (false, _) => &["q"],
    };
    let single: Vec<&str> = extra.iter().map(|(name, ..)| *name).collect();
    let mut out = Table::new(style.n, groups, &single);
    let first = record.t[0];
    let (mut colour, mut last) = ([0.0; MAX], -1.0_f64);
    let fresh = (1.0 - style.colour * style.colour).sqrt();
    let (dt, dq, dtau) = style.decimals;
    let shortest = 0.1_f64.powf(dt as f64);
    for (row, t) in record.t.iter().enumerate() {
        for x in &mut colour {
            *x = style.colour * *x + fresh * rng.normal();
        }
        if row > 3 && rng.chance(style.lost) {
            continue;
        }
        last = (t - first + style.start + style.jitter * rng.normal()).max(last + shortest);
        out.row(last, dt);
        for x in &record.q[row][..style.n] {
            out.value(quantised(*x, style.encoder), dq);
        }
        if style.rates && torques {
            for x in &record.v[row][..style.n] {
                // Rates come from differences of the encoder over some ms.
                out.value(x + 60.0 * style.encoder * rng.normal(), dq);
            }
        }
        if torques {
            for i in 0..style.n {
                let raw = record.tau[row][i] + style.noise[i] * colour[i];
                out.value(quantised(raw, style.current[i]), dtau);
            }
        }
        for (_, decimals, values) in extra {
            out.value(values[row], *decimals);
        }
    }
    out.finish()
}

//! The path of the torque signal: delays, filters, and a mode of the structure.

use super::law::Parameter;
use super::motion::STEP;
use crate::examine::worlds::model::{MAX, Row};
use std::f64::consts::TAU;

/// A law of the signals of one joint or all.
#[derive(Clone, Copy, Debug)]
pub(super) struct SignalLaw {
    /// Delay or lag \[s\], or gain of a mode; grows with the fault.
    pub(super) size: f64,
    /// The only joint that has it (from 0).
    pub(super) only: Option<usize>,
    pub(super) form: SignalForm,
}

/// Forms.
#[derive(Clone, Copy, Debug)]
pub(super) enum SignalForm {
    /// Held over the cycle of a bus \[s\] and late: the mean delay is the size.
    Bus { cycle: f64 },
    /// A slot of the bus for each axis: delays from 0.7 to 1.3 of the size.
    Slots,
    /// Two equal lags in a row, in sum the size.
    Cascade,
    /// Mean over twice the size.
    Average,
    /// Outside: a mode of the structure \[Hz\], damping, seen with the gain `size`.
    Mode { frequency: f64, damping: f64 },
}

/// The value of a series at a time \[steps\], linear; held at its ends.
fn at(series: &[Row], i: usize, steps: f64) -> f64 {
    let last = series.len().saturating_sub(1);
    let steps = steps.clamp(0.0, last as f64);
    let k = steps.floor() as usize;
    let (Some(low), Some(high)) = (series.get(k), series.get((k + 1).min(last))) else {
        return 0.0;
    };
    low[i] + (steps - k as f64) * (high[i] - low[i])
}

/// One first-order lag \[s\] over joint `i` of a series, exact for inputs linear over a step.
fn lag(series: &mut [Row], i: usize, time: f64) {
    let ratio = time.max(1e-6) / STEP;
    let keep = (-1.0 / ratio).exp();
    let now = 1.0 - ratio * (1.0 - keep);
    let old = ratio * (1.0 - keep) - keep;
    let mut before = series.first().map_or(0.0, |row| row[i]);
    let mut state = before;
    for row in series {
        state = keep * state + old * before + now * row[i];
        before = row[i];
        row[i] = state;
    }
}

/// Lags of `order` equal poles, in sum `time` \[s\]: the everyday filter.
pub(super) fn filter(series: &mut [Row], count: usize, time: f64, order: usize) {
    for i in 0..count {
        for _ in 0..order.max(1) {
            lag(series, i, time / order.max(1) as f64);
        }
    }
}

impl SignalLaw {
    /// Applies the law to a series \[Nm\], [`STEP`] apart, of `count` joints.
    pub(super) fn apply(&self, series: &mut [Row], count: usize) {
        for i in 0..count.min(MAX) {
            if self.only.is_none_or(|only| only == i) {
                self.joint(series, i, count);
            }
        }
    }

    fn joint(&self, series: &mut [Row], i: usize, count: usize) {
        match self.form {
            SignalForm::Bus { cycle } => {
                let cycle = cycle.min(1.6 * self.size);
                // Whole steps: a value is held for 0 to hold − 1 steps.
                let hold = (cycle / STEP).round().max(1.0);
                let late = self.size / STEP - 0.5 * (hold - 1.0);
                let source = series.to_vec();
                for (k, row) in series.iter_mut().enumerate() {
                    row[i] = at(&source, i, (k as f64 / hold).floor() * hold - late);
                }
            }
            SignalForm::Slots => {
                let share = i as f64 / (count.max(2) - 1) as f64;
                let factor = if self.only.is_some() { 1.0 } else { 0.7 + 0.6 * share };
                let source = series.to_vec();
                for (k, row) in series.iter_mut().enumerate() {
                    row[i] = at(&source, i, k as f64 - factor * self.size / STEP);
                }
            }
            SignalForm::Cascade => {
                lag(series, i, 0.5 * self.size);
                lag(series, i, 0.5 * self.size);
            }
            SignalForm::Average => average(series, i, 2.0 * self.size),
            SignalForm::Mode { frequency, damping } => {
                let omega = TAU * frequency;
                let mut rate = 0.0;
                let mut place = series.first().map_or(0.0, |row| row[i]);
                for row in series {
                    rate +=
                        STEP * (omega * omega * (row[i] - place) - 2.0 * damping * omega * rate);
                    place += STEP * rate;
                    row[i] += self.size * (place - row[i]);
                }
            }
        }
    }

    /// Its parameters by the library's names.
    pub(super) fn parameters(&self) -> Vec<Parameter> {
        let only = ("only_joint", self.only.map_or(0.0, |i| (i + 1) as f64), false);
        match self.form {
            SignalForm::Bus { .. } => vec![("delay", self.size, true), only],
            SignalForm::Slots => vec![("delay", self.size, self.only.is_some()), only],
            SignalForm::Cascade => vec![("lag", self.size, true), only],
            SignalForm::Average => vec![("lag", self.size, false), only],
            SignalForm::Mode { frequency, .. } => {
                vec![("gain", self.size, false), ("frequency", frequency, false)]
            }
        }
    }
}

/// Moving average over a length \[s\] of the past, trapezoids with a part of a step at the end.
fn average(series: &mut [Row], i: usize, length: f64) {
    let steps = (length / STEP).max(0.1);
    let first = series.first().map_or(0.0, |row| row[i]);
    let mut sums = Vec::with_capacity(series.len() + 1);
    let (mut sum, mut before) = (-first, first);
    for row in series.iter() {
        sum += 0.5 * (before + row[i]);
        if sums.is_empty() {
            sum = 0.0;
        }
        before = row[i];
        sums.push(sum);
    }
    // Integral up to a time in steps; before the start the first value holds.
    let integral = |time: f64| {
        if time <= 0.0 {
            return first * time;
        }
        let k = time.floor() as usize;
        let low = sums.get(k).copied().unwrap_or(sum);
        let high = sums.get(k + 1).copied().unwrap_or(low);
        low + (time - k as f64) * (high - low)
    };
    for (k, row) in series.iter_mut().enumerate() {
        row[i] = (integral(k as f64) - integral(k as f64 - steps)) / steps;
    }
}

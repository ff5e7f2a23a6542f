//! Smooth functions of one variable of a joint's motion.

use crate::arm::effects::{Motion, Variable};
use crate::gap::tunables::Tunables;

/// Values of functions: by function, by motion, by row.
pub(super) type Functions = Vec<Vec<Vec<f64>>>;

/// Angles and times in which functions fade after a reversal, over the usual ones.
const ANGLES: [f64; 5] = [0.1, 0.33, 1.0, 3.0, 10.0];
const TIMES: [f64; 2] = [1.0, 3.0];

/// Number of functions of a variable.
fn count(variable: Variable) -> usize {
    match variable {
        Variable::Speed => 10,
        Variable::Position => 8,
        Variable::PositionSense | Variable::Load | Variable::LoadSense => 5,
        Variable::LoadSpeed | Variable::TimeSense => 6,
        Variable::Reversal => ANGLES.len() + TIMES.len(),
    }
}

/// Standard deviation of the amplitude of `m` half waves, relative to that of a slow one.
#[must_use]
pub(super) fn roughness(m: f64, tunables: &Tunables) -> f64 {
    1.0 / (1.0 + (m / tunables.halved).powi(2)).sqrt()
}

/// The range of a variable over all motions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    low: f64,
    high: f64,
}

impl Range {
    pub(super) fn of<'a>(values: impl Iterator<Item = &'a f64>) -> Range {
        let empty = Range { low: f64::INFINITY, high: f64::NEG_INFINITY };
        values.fold(empty, |range, x| Range { low: range.low.min(*x), high: range.high.max(*x) })
    }

    /// `m` half waves over the range.
    pub(super) fn wave(&self, x: f64, m: usize) -> f64 {
        let width = (self.high - self.low).max(1e-9);
        (std::f64::consts::PI * m as f64 * (x - self.low) / width).cos()
    }
}

/// The arguments of a variable at a joint, of each motion.
fn arguments(
    variable: Variable,
    motions: &[&Motion<'_>],
    joint: usize,
    tunables: &Tunables,
) -> Vec<Vec<f64>> {
    let fastest =
        motions.iter().flat_map(|m| &m.rates[joint]).fold(0.0, |a: f64, x| a.max(x.abs()));
    let slow = (tunables.slow * fastest).max(1e-9);
    let of_motion = |m: &&Motion<'_>| -> Vec<f64> {
        match variable {
            Variable::Speed | Variable::LoadSpeed => {
                m.rates[joint].iter().map(|v| v.signum() * (v.abs() / slow).ln_1p()).collect()
            }
            Variable::Position | Variable::PositionSense => m.q[joint].clone(),
            Variable::Load => m.gear[joint].clone(),
            Variable::LoadSense => m.gear[joint].iter().map(|x| x.abs()).collect(),
            Variable::Reversal => (0..m.rows()).map(|row| row as f64).collect(),
            Variable::TimeSense => m.t.clone(),
        }
    };
    motions.iter().map(of_motion).collect()
}

/// What a function of the variable is multiplied by.
fn factor(variable: Variable, m: &Motion<'_>, joint: usize, row: usize) -> f64 {
    let sense = m.senses[joint][row];
    match variable {
        Variable::Speed => sense.abs(),
        Variable::PositionSense
        | Variable::LoadSense
        | Variable::Reversal
        | Variable::TimeSense => sense,
        Variable::LoadSpeed => m.gear[joint][row],
        Variable::Position | Variable::Load => 1.0,
    }
}

/// A rest from which on a motion begins anew \[s\].
const LONG_REST: f64 = 0.1;

/// Angle \[rad\] and time \[s\] since the last reversal of the motor, by row.
fn since_reversal(m: &Motion<'_>, joint: usize) -> [Vec<f64>; 2] {
    let (rates, senses, step) = (&m.rates[joint], &m.senses[joint], m.step());
    let long = (LONG_REST / step) as usize;
    let mut rested = 0;
    let (mut angle, mut time) = (f64::INFINITY, f64::INFINITY);
    let [mut angles, mut times] = [vec![0.0; rates.len()], vec![0.0; rates.len()]];
    // The second pass of a periodic motion knows the last reversal before its start.
    for _ in 0..if m.closed { 2 } else { 1 } {
        let mut before =
            if m.closed { rates.last() } else { rates.first() }.copied().unwrap_or(0.0);
        for (row, rate) in rates.iter().enumerate() {
            rested = if senses[row] == 0.0 { rested + 1 } else { 0 };
            if rested > long {
                (angle, time) = (0.0, 0.0);
            } else if rate * before < 0.0 {
                time = step * rate.abs() / (rate - before).abs();
                angle = 0.5 * rate.abs() * time;
            } else {
                angle += 0.5 * (rate + before).abs() * step;
                time += step;
            }
            (angles[row], times[row]) = (angle, time);
            before = *rate;
        }
    }
    [angles, times]
}

/// The functions of a variable at a joint: by function, by motion, by row, each with unit size
/// times its roughness. A load is measured in the size of the load.
#[must_use]
pub(super) fn functions(
    variable: Variable,
    motions: &[&Motion<'_>],
    joint: usize,
    tunables: &Tunables,
) -> Functions {
    if variable == Variable::Reversal {
        return after_reversals(motions, joint, tunables);
    }
    let arguments = arguments(variable, motions, joint, tunables);
    let range = Range::of(arguments.iter().flatten());
    let scale = match variable {
        Variable::LoadSpeed => 1.0 / rms(motions.iter().flat_map(|m| &m.gear[joint])).max(1e-12),
        _ => 1.0,
    };
    (0..count(variable))
        .map(|k| {
            let value = |x: f64| range.wave(x, k + 1) * roughness((k + 1) as f64, tunables);
            let of = |(m, x): (&&Motion<'_>, &Vec<f64>)| -> Vec<f64> {
                let at = |row: usize| scale * factor(variable, m, joint, row) * value(x[row]);
                (0..m.rows()).map(at).collect()
            };
            motions.iter().zip(&arguments).map(of).collect()
        })
        .collect()
}

/// Functions that fade after each reversal, with the sense of the motion.
fn after_reversals(motions: &[&Motion<'_>], joint: usize, tunables: &Tunables) -> Functions {
    let mut all = fades(motions, joint, tunables);
    for fade in &mut all {
        for (series, m) in fade.iter_mut().zip(motions) {
            series.iter_mut().zip(&m.senses[joint]).for_each(|(x, sense)| *x *= sense);
        }
    }
    all
}

/// What is left of 1 after each reversal: by function, by motion, by row.
#[must_use]
pub(super) fn fades(motions: &[&Motion<'_>], joint: usize, tunables: &Tunables) -> Functions {
    let since: Vec<[Vec<f64>; 2]> = motions.iter().map(|m| since_reversal(m, joint)).collect();
    let usual = [tunables.fade_angle, tunables.fade_time];
    let all = ANGLES.iter().map(|by| (0, *by)).chain(TIMES.iter().map(|by| (1, *by)));
    all.map(|(of, by)| {
        // Functions that fade more slowly are smaller.
        let (fade, size) = (by * usual[of], (1.0 / by).min(1.0));
        let series = |since: &[Vec<f64>; 2]| -> Vec<f64> {
            since[of].iter().map(|x| size * (-x / fade).exp()).collect()
        };
        since.iter().map(series).collect()
    })
    .collect()
}

/// Root of the mean square.
pub(super) fn rms<'a>(values: impl Iterator<Item = &'a f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for x in values {
        sum += x * x;
        count += 1.0;
    }
    (sum / count.max(1.0)).sqrt()
}

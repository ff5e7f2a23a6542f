//! A periodic motion between rest and rest, for the tests of repetitions.

use std::f64::consts::TAU;

use super::uniform::Section;

/// Interval of the rows, s.
pub(super) const STEP: f64 = 0.01;

/// Position, rate and acceleration at the time `t` \[s\].
pub(super) fn motion(t: f64) -> [f64; 3] {
    let w = TAU / 5.0;
    let (s1, c1) = (w * t).sin_cos();
    let (s4, c4) = (4.0 * w * t).sin_cos();
    [0.7 * s1 + 0.2 * c4, 0.7 * w * c1 - 0.8 * w * s4, -0.7 * w * w * s1 - 3.2 * w * w * c4]
}

/// Rest, a ramp, five and a half periods, rest.
pub(super) fn log() -> Section {
    let q: Vec<f64> = (0..3500)
        .map(|i| {
            let t = STEP * f64::from(i) - 3.0;
            if t < 0.0 {
                motion(0.0)[0] * (1.0 + t / 3.0)
            } else if t < 27.5 {
                motion(t)[0]
            } else {
                motion(27.5)[0]
            }
        })
        .collect();
    let torque = q.iter().enumerate().map(|(i, q)| 3.0 * q + (i % 2) as f64).collect();
    Section { start: 0.0, step: STEP, series: vec![q, torque], lost: Vec::new() }
}

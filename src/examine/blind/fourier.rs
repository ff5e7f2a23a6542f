//! Excitation motions: random Fourier series, scaled to the limits.
//!
//! The form is that of J. Swevers et al., "Optimal robot excitation and identification", IEEE T-RA
//! 13, 1997; the coefficients are random.

use std::f64::consts::TAU;

use super::motion::{Motion, STEP_S, Sample};
use super::random::Random;
use super::workspace::Workspace;

/// Number of harmonics of a joint.
const HARMONICS: usize = 5;
/// Largest share of each limit that a motion uses.
const LARGEST_SHARE: f64 = 0.85;

/// A motion with the period `period_s` within the workspace.
pub(super) fn fourier(workspace: &Workspace, period_s: f64, random: &mut Random) -> Motion {
    let count = (period_s / STEP_S).round() as usize;
    let mut samples = vec![Sample::ZERO; count];
    for joint in 0..workspace.dof {
        let mut waves = Vec::new();
        for harmonic in 1..=HARMONICS {
            let size = random.normal() / (harmonic as f64).sqrt();
            waves.push((harmonic as f64 * TAU / period_s, size, random.between(0.0, TAU)));
        }
        let at = |t: f64| {
            let mut sums = [0.0; 3];
            for (omega, size, phase) in &waves {
                let (sin, cos) = (omega * t + phase).sin_cos();
                sums[0] += size * sin;
                sums[1] += size * omega * cos;
                sums[2] -= size * omega * omega * sin;
            }
            sums
        };
        let states: Vec<[f64; 3]> = (0..count).map(|i| at(i as f64 * STEP_S)).collect();
        let (mut low, mut high, mut rate, mut push) = (0.0_f64, 0.0_f64, 1e-9_f64, 1e-9_f64);
        for [q, qd, qdd] in &states {
            low = low.min(*q);
            high = high.max(*q);
            rate = rate.max(qd.abs());
            push = push.max(qdd.abs());
        }
        let [from, to] = workspace.range[joint];
        let share = random.between(0.45, LARGEST_SHARE);
        let scale = ((to - from) / (high - low).max(1e-9))
            .min(workspace.velocity[joint] / rate)
            .min(workspace.acceleration[joint] / push)
            * share;
        let room = (to - from) - scale * (high - low);
        let shift = from + room * random.between(0.2, 0.8) - scale * low;
        for (sample, [q, qd, qdd]) in samples.iter_mut().zip(states) {
            sample.q[joint] = shift + scale * q;
            sample.qd[joint] = scale * qd;
            sample.qdd[joint] = scale * qdd;
        }
    }
    Motion { samples }
}

//! Whether a periodic motion is made of the harmonics that were fitted to it.

use crate::learn::identify::Samples;

/// Amplitude of the last harmonics, of the largest one, above which a motion has no higher ones:
/// those of moves with jumps of the jerk fall by the third power, below this at the tenth.
const SHARP: f64 = 1e-3;
/// Number of the last harmonics: one may be small by chance.
const LAST: usize = 3;

/// Whether the spectrum of a periodic motion ends with its last harmonic: that of a motion that is
/// made of harmonics does; that of moves with jumps of the jerk is cut off where noise begins.
pub(super) fn ends_sharply(samples: &Samples, harmonics: usize) -> bool {
    let Some(block) = samples.blocks.first() else { return false };
    let rows = block.t.len() as f64;
    let amplitude = |q: &[f64], k: usize| {
        let (mut c, mut s) = (0.0, 0.0);
        for (row, q) in q.iter().enumerate() {
            let angle = std::f64::consts::TAU * (k * row) as f64 / rows;
            c += q * angle.cos();
            s += q * angle.sin();
        }
        c.hypot(s)
    };
    block.q.iter().any(|q| {
        let largest = (1..=harmonics).map(|k| amplitude(q, k)).fold(0.0, f64::max);
        let last = harmonics.saturating_sub(LAST - 1).max(1);
        let at_end = (last..=harmonics).map(|k| amplitude(q, k)).fold(0.0, f64::max);
        at_end > SHARP * largest
    })
}

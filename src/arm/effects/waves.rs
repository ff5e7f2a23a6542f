//! Conversion between amplitude and phase and cosine and sine part of a wave.

use super::effect::Published;

/// The first two coordinates are cosine and sine part, the first two parameters amplitude and
/// phase; the others are equal.
pub(super) const AMPLITUDE_AND_PHASE: Published = Published {
    parameters: |x| replaced(x, |a, b| [a.hypot(b), b.atan2(a)]),
    coordinates: |x| {
        replaced(x, |amplitude, phase| [amplitude * phase.cos(), amplitude * phase.sin()])
    },
};

fn replaced(x: &[f64], pair: impl Fn(f64, f64) -> [f64; 2]) -> Vec<f64> {
    match x {
        [a, b, rest @ ..] => pair(*a, *b).into_iter().chain(rest.iter().copied()).collect(),
        _ => x.to_vec(),
    }
}

//! Stated probabilities are those with which effects were there.
//!
//! The evidence knows the laws of its library alone, so that it is surer than it may be. How far it
//! can be trusted was counted on development cases of `blind generate` (docs/gap.md).

use super::diagnosis::Said;

/// Share of the effects that were asserted without a doubt which were there.
const ASSERTED: f64 = 0.95;
/// The same of those that were found and refused.
const REFUSED: f64 = 0.1;

/// Cases of `blind generate` in which stated probabilities were counted, after the method was fixed
/// (seed 1009, docs/gap.md).
pub const EXAMINED: usize = 110;
/// Ends of intervals of stated probabilities, the mean there, how many of the effects were there, and
/// of how many.
pub const COUNTED: [[f64; 5]; 5] = [
    [0.0, 0.25, 0.074, 5.0, 166.0],
    [0.25, 0.5, 0.469, 1.0, 2.0],
    [0.75, 0.9, 0.858, 2.0, 4.0],
    [0.9, 0.95, 0.946, 13.0, 13.0],
    [0.95, 0.99, 0.95, 40.0, 40.0],
];

/// Takes for each effect what the evidence says by how often it is right.
pub(super) fn calibrate(asserted: &mut [Said], refused: &mut [Said]) {
    for (of, share) in [(asserted, ASSERTED), (refused, REFUSED)] {
        for said in of {
            said.probability *= share;
        }
    }
}

/// How probable it is that an effect of another channel is there, by the logarithm of its odds.
pub(super) fn asserted(nats: f64) -> f64 {
    ASSERTED / (1.0 + (-nats).exp())
}

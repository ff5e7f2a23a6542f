//! Stated probabilities are those with which effects were there.
//!
//! The evidence knows the laws of its library alone, so that it is surer than it may be. How far it
//! can be trusted was counted on development cases of `blind generate` (docs/gap.md).

use super::findings::Said;

/// Share of the effects that were asserted without a doubt which were there.
const ASSERTED: f64 = 0.95;
/// The same of those that were found and refused.
const REFUSED: f64 = 0.1;

/// Cases of `blind generate` in which stated probabilities were counted: seed 1010, diagnosed once by
/// the method as it is before labels were read (docs/gap.md).
pub const EXAMINED: usize = 110;
/// Ends of intervals of stated probabilities, the mean there, how many of the effects were there, and
/// of how many.
pub const COUNTED: [[f64; 5]; 6] = [
    [0.0, 0.25, 0.075, 4.0, 157.0],
    [0.25, 0.5, 0.475, 1.0, 1.0],
    [0.5, 0.75, 0.711, 1.0, 2.0],
    [0.75, 0.9, 0.846, 4.0, 4.0],
    [0.9, 0.95, 0.93, 12.0, 12.0],
    [0.95, 0.99, 0.95, 33.0, 33.0],
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

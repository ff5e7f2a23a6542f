//! Stated probabilities are those with which effects were there.

/// Share of the effects that were asserted without a doubt which were there.
const ASSERTED: f64 = 0.95;

/// What the evidence says by how often it is right: it knows the laws of its library alone.
pub(super) fn calibrated(probability: f64) -> f64 {
    ASSERTED * probability
}

/// How probable it is that an effect of another channel is there, by the logarithm of its odds.
pub(in crate::gap) fn asserted(nats: f64) -> f64 {
    ASSERTED / (1.0 + (-nats).exp())
}

//! Draws of the normal distribution; those of a crate would move the thresholds that are drawn.

/// A standard normal deviate (G. E. P. Box, M. E. Muller 1958).
pub(super) fn normal(random: &mut fastrand::Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.f64()).cos()
}

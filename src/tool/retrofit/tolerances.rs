//! Differences that count as rounding where two simulations are compared.

/// Rounding of a time, s.
pub(super) const TIME_TOLERANCE: f64 = 1e-6;
/// Distance of a joint from where it should be, after the rounding of emitted text, rad.
pub(super) const ENDPOINT_TOLERANCE: f64 = 1e-4;

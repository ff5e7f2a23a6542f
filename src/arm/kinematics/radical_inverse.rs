//! Evenly distributed points in a cube, for searches and checks over all poses.

/// Number `n` of the van der Corput sequence to the base, between 0 and 1; sequences to several
/// bases fill a cube evenly (J. H. Halton, 1960).
#[must_use]
pub fn radical_inverse(mut n: u32, base: u32) -> f64 {
    let (mut sum, mut share) = (0.0, 1.0);
    while n > 0 {
        share /= f64::from(base);
        sum += share * f64::from(n % base);
        n /= base;
    }
    sum
}

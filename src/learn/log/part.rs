//! Names of workpieces as numbers: a log has columns of numbers only.

use super::notation::{Notation, number};

/// Constants of the hash FNV-1a (G. Fowler, L. C. Noll, P. Vo).
const BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0100_0000_01b3;
/// Bits that a number holds exactly.
const BITS: u64 = (1 << 52) - 1;

/// The number of a part: its own, or a negative one that stands for its name.
pub(super) fn part_number(text: &str, notation: Notation) -> f64 {
    let own = number(text, notation).ok();
    own.unwrap_or_else(|| {
        let hash =
            text.bytes().fold(BASIS, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME));
        -1.0 - (hash & BITS) as f64
    })
}

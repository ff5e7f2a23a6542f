//! Tokens by place.

use crate::rapid::syntax::Tokens;

/// The token that contains a byte; past the last token, their number.
pub(super) fn token_at(tokens: &Tokens, byte: u32) -> usize {
    let (mut low, mut high) = (0, tokens.count());
    while low < high {
        let middle = low.midpoint(high);
        if tokens.range(middle).end <= byte {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}

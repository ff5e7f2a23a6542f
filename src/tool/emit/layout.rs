//! The layout of streams: instructions or arrays, in one module or several.

use std::ops::Range;

/// Minimum number of points for arrays with `Auto`: three seconds of motion. Shorter streams use
/// plain instructions, with no extra time between movements.
const ARRAY_FROM: usize = 64;

/// Maximum number of points of a module, except for a longer single stream. Modules with 1,400
/// inline movements (100 kB) are known to have run on robots.
const MODULE_POINTS: usize = 1_400;

/// How the points of a stream are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layout {
    /// One instruction per point.
    Plain,
    /// Constant arrays, and a loop over them.
    Array,
    /// Arrays for long streams only.
    #[default]
    Auto,
}

impl Layout {
    /// Whether a stream with this number of points becomes arrays. A loop needs a point before the
    /// last.
    pub fn is_array(self, points: usize) -> bool {
        match self {
            Layout::Plain => false,
            Layout::Array => points > 1,
            Layout::Auto => points >= ARRAY_FROM,
        }
    }
}

/// Groups of streams (given by their numbers of points) that share a module.
pub(super) fn parts(points: &[usize]) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let (mut begin, mut sum) = (0, 0);
    for (index, count) in points.iter().enumerate() {
        if index > begin && sum + count > MODULE_POINTS {
            parts.push(begin..index);
            (begin, sum) = (index, 0);
        }
        sum += count;
    }
    parts.push(begin..points.len());
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modules_are_filled_in_order_and_none_is_empty() {
        assert_eq!(parts(&[10, 20, 1_380]), [0..2, 2..3]);
        assert_eq!(parts(&[1_400, 1]), [0..1, 1..2]);
        assert_eq!(parts(&[5_000, 5_000, 700, 700, 1]), [0..1, 1..2, 2..4, 4..5]);
    }

    #[test]
    fn long_streams_become_arrays() {
        assert!(!Layout::Auto.is_array(ARRAY_FROM - 1) && Layout::Auto.is_array(ARRAY_FROM));
        assert!(Layout::Array.is_array(2) && !Layout::Array.is_array(1));
        assert!(!Layout::Plain.is_array(10_000));
    }
}

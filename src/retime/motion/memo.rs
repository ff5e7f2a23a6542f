//! Results that are kept, found by what they are computed from.

use std::collections::BTreeMap;
use std::fmt::{self, Debug, Write};
use std::sync::{Mutex, PoisonError};

use sha2::{Digest, Sha256};

/// Hash of what a result is computed from.
pub type Key = [u8; 32];

/// The last results of a computation.
pub struct Memo<V> {
    most: usize,
    /// The present generation and the one before: a full one replaces the one before.
    kept: Mutex<[BTreeMap<Key, V>; 2]>,
}

impl<V: Clone> Memo<V> {
    /// A memo that keeps the last `most` results at least, and twice as many at most.
    #[must_use]
    pub fn new(most: usize) -> Memo<V> {
        Memo { most, kept: Mutex::default() }
    }

    /// The result for a key, which is computed unless it is kept.
    pub fn get_or(&self, key: Key, compute: impl FnOnce() -> V) -> V {
        let kept = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let found = kept().iter().find_map(|generation| generation.get(&key).cloned());
        // The lock is free while the result is computed.
        let value = found.unwrap_or_else(compute);
        let mut kept = kept();
        if kept[0].len() >= self.most && !kept[0].contains_key(&key) {
            kept.swap(0, 1);
            kept[0].clear();
        }
        kept[0].insert(key, value.clone());
        value
    }
}

impl<V> Debug for Memo<V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Memo").finish_non_exhaustive()
    }
}

/// The key of values: that of their debug texts, which have all digits of numbers.
#[must_use]
pub fn key(of: &impl Debug) -> Key {
    struct Hasher(Sha256);
    impl Write for Hasher {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0.update(text);
            Ok(())
        }
    }
    let mut hasher = Hasher(Sha256::new());
    // Writing to a hash never fails.
    let _ = write!(hasher, "{of:?}");
    hasher.0.finalize().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_results_are_not_computed_again() {
        let memo = Memo::new(2);
        let computed = |of: u32| {
            let mut again = false;
            let value = memo.get_or(key(&of), || {
                again = true;
                of + 1
            });
            assert_eq!(value, of + 1);
            again
        };
        let order = [1, 2, 1, 3, 1, 2, 4, 5, 6, 1];
        let expected = [true, true, false, true, false, false, true, true, true, true];
        assert_eq!(order.map(computed), expected);
        assert!(
            memo.kept.lock().unwrap_or_else(PoisonError::into_inner).iter().flatten().count() <= 4
        );
    }

    #[test]
    fn keys_tell_all_digits_apart() {
        assert_ne!(key(&[0.1, 0.2]), key(&[0.1, f64::from_bits(0.2_f64.to_bits() + 1)]));
        assert_ne!(key(&("ab", "c")), key(&("a", "bc")));
        assert_eq!(key(&[1.5; 3]), key(&[1.5; 3]));
    }
}

//! Names without regard to case, as numbers.

use std::collections::HashMap;

use crate::rapid::text::Charset;

/// A name without regard to case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Key(u32);

/// All names that were seen.
#[derive(Clone, Debug, Default)]
pub(super) struct Keys {
    by_text: HashMap<String, Key>,
    /// In lower case.
    texts: Vec<String>,
}

impl Keys {
    /// The key of a name in lower case.
    pub(super) fn key(&mut self, lower: String) -> Key {
        if let Some(key) = self.by_text.get(&lower) {
            return *key;
        }
        let key = Key(self.texts.len() as u32);
        self.texts.push(lower.clone());
        self.by_text.insert(lower, key);
        key
    }

    /// The key of a name in lower case, if it was seen.
    pub(super) fn find(&self, lower: &str) -> Option<Key> {
        self.by_text.get(lower).copied()
    }

    /// The name in lower case.
    pub(super) fn text(&self, key: Key) -> &str {
        &self.texts[key.0 as usize]
    }
}

/// Values by key: an array, because the keys are numbers without gaps.
#[derive(Clone, Debug)]
pub(super) struct KeyMap<T>(Vec<Option<T>>);

impl<T: Copy> KeyMap<T> {
    pub(super) fn new() -> KeyMap<T> {
        KeyMap(Vec::new())
    }

    pub(super) fn get(&self, key: Key) -> Option<T> {
        self.0.get(key.0 as usize).copied().flatten()
    }

    pub(super) fn insert(&mut self, key: Key, value: T) {
        let index = key.0 as usize;
        if index >= self.0.len() {
            self.0.resize(index + 1, None);
        }
        self.0[index] = Some(value);
    }

    /// Inserts a value unless the key has one.
    pub(super) fn insert_first(&mut self, key: Key, value: T) {
        if self.get(key).is_none() {
            self.insert(key, value);
        }
    }

    pub(super) fn remove(&mut self, key: Key) {
        if let Some(slot) = self.0.get_mut(key.0 as usize) {
            *slot = None;
        }
    }
}

/// The keys of the spellings in one file, so that each spelling is decoded once.
pub(super) struct Spellings<'a> {
    charset: Charset,
    seen: HashMap<&'a [u8], Key>,
}

impl<'a> Spellings<'a> {
    pub(super) fn new(charset: Charset) -> Spellings<'a> {
        Spellings { charset, seen: HashMap::new() }
    }

    pub(super) fn key(&mut self, keys: &mut Keys, bytes: &'a [u8]) -> Key {
        if let Some(key) = self.seen.get(bytes) {
            return *key;
        }
        let key = keys.key(self.charset.decode(bytes).to_lowercase());
        self.seen.insert(bytes, key);
        key
    }
}

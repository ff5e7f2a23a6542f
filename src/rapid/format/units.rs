//! The statements, declarations and comments that a range touches.

use std::ops::Range;

use super::gap::Gap;
use super::layout::{Layout, Start};
use crate::rapid::syntax::{TokenKind, Tokens};

/// Words of whole statements.
pub(super) struct Units {
    /// By word: the number of its statement.
    unit_of: Vec<usize>,
    /// By statement: whether it is formatted.
    chosen: Vec<bool>,
}

impl Units {
    /// The statements that `range` touches. `is_first` tells whether a word is the first on its line.
    pub(super) fn new(
        words: &[usize],
        layout: &Layout,
        tokens: &Tokens,
        range: &Range<u32>,
        is_first: impl Fn(usize) -> bool,
    ) -> Units {
        let mut unit_of = Vec::with_capacity(words.len());
        let mut spans: Vec<Range<u32>> = Vec::new();
        for (index, word) in words.iter().enumerate() {
            let place = tokens.range(*word);
            let is_comment = tokens.kind(*word) == TokenKind::Comment;
            let begins = if is_comment {
                // A comment between statements is one of its own, unless it stands behind one.
                let next = layout.behind(*word);
                let is_between = next.is_none_or(|next| layout.starts[next] != Start::Inside);
                is_between && is_first(index)
            } else {
                layout.starts[*word] == Start::Line
            };
            if begins || spans.is_empty() {
                spans.push(place.clone());
            }
            if let Some(span) = spans.last_mut() {
                span.end = place.end;
            }
            unit_of.push(spans.len() - 1);
        }
        let touches = |span: &Range<u32>| {
            span.start < range.end && range.start < span.end
                || range.is_empty() && span.start <= range.start && range.start <= span.end
        };
        Units { unit_of, chosen: spans.iter().map(touches).collect() }
    }

    /// Whether a word is in one of the statements.
    pub(super) fn contains(&self, word: usize) -> bool {
        self.unit_of.get(word).is_some_and(|unit| self.chosen[*unit])
    }

    /// The part of the white space before a word that may change, from a byte on, and its new text. What
    /// lies between a statement and another one that stays is only the indentation.
    pub(super) fn part(&self, word: usize, old: Gap<'_>, new: &[u8]) -> Option<(usize, Vec<u8>)> {
        if !self.contains(word) {
            return None;
        }
        let before = word.checked_sub(1);
        if old.lines() == 0 || before.is_some_and(|before| self.contains(before)) {
            return Some((0, new.to_vec()));
        }
        let indentation = &new[Gap::new(new).before_last_line()..];
        Some((old.before_last_line(), indentation.to_vec()))
    }
}

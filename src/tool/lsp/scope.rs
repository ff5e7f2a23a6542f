//! What a name means at a place where the statement is not finished.

use super::cursor::Cursor;
use super::entity::Declared;
use super::workspace::View;
use crate::rapid::builtins;
use crate::rapid::names::{DeclarationId, Kind, Names, ValueType};
use crate::rapid::syntax::TokenKind;

/// The declarations that are visible at a place, in one task.
pub(super) struct Scope<'v> {
    pub(super) view: View<'v>,
    pub(super) names: &'v Names,
    pub(super) visible: Vec<DeclarationId>,
}

impl<'v> Scope<'v> {
    /// The scope at a byte, in the first task that loads the file.
    pub(super) fn new(view: View<'v>, byte: u32) -> Option<Scope<'v>> {
        let names = view.project.names_of(view.file).next()?;
        Some(Scope { view, names, visible: names.visible(view.file, byte) })
    }

    pub(super) fn declared(&self, id: DeclarationId) -> Declared<'v> {
        Declared { names: self.names, id }
    }

    /// The declaration of a name in lower case that has one of these kinds.
    pub(super) fn find(&self, key: &str, wanted: impl Fn(Kind) -> bool) -> Option<DeclarationId> {
        let fits = |id: &DeclarationId| wanted(self.names.declaration(*id).kind);
        let own = self.visible.iter().copied();
        let own = own.filter(|id| self.names.key(*id) == key).find(fits);
        own.or_else(|| Names::predefined(key).filter(fits))
    }

    pub(super) fn routine(&self, key: &str) -> Option<DeclarationId> {
        self.find(key, |kind| matches!(kind, Kind::Routine(_)))
    }

    /// The type of a value or of the result of a function.
    fn value(&self, key: &str) -> ValueType {
        let has_value = |kind| {
            matches!(kind, Kind::Data(_) | Kind::Parameter(_) | Kind::Counter | Kind::Routine(_))
        };
        if let Some(id) = self.find(key, has_value) {
            return self.names.declaration(id).value;
        }
        let predefined = builtins::predefined(key).and_then(|it| Names::predefined(it.type_name));
        ValueType { declaration: predefined, dimensions: 0 }
    }

    /// A type by its name in lower case.
    pub(super) fn of_type(&self, key: &str) -> ValueType {
        let is_type = |kind| matches!(kind, Kind::Record | Kind::Alias | Kind::Basic(_));
        ValueType { declaration: self.find(key, is_type), dimensions: 0 }
    }

    /// The type of the value that the last words form: `a.b{1}`.
    pub(super) fn last_value(&self, cursor: &Cursor<'_>, words: &[usize]) -> ValueType {
        let mut chain = Vec::new();
        let mut at = words.len();
        while let Some(word) = at.checked_sub(1).map(|last| words[last]) {
            match cursor.kind(word) {
                TokenKind::RightBrace | TokenKind::RightParen => {
                    let Some(start) = group_start(cursor, &words[..at]) else { break };
                    at = start;
                }
                TokenKind::Identifier => {
                    chain.push(cursor.text(word));
                    at -= 1;
                    let before = at.checked_sub(1).map(|last| cursor.kind(words[last]));
                    if before != Some(TokenKind::Dot) {
                        break;
                    }
                    at -= 1;
                }
                _ => break,
            }
        }
        let mut parts = chain.into_iter().rev();
        let Some(first) = parts.next() else { return ValueType::UNKNOWN };
        let first = self.value(&first);
        parts.fold(first, |value, part| self.component(value, &part))
    }

    fn component(&self, value: ValueType, key: &str) -> ValueType {
        let found = self.components(value).find(|id| self.names.key(*id) == key);
        found.map_or(ValueType::UNKNOWN, |id| self.names.declaration(id).value)
    }

    /// The components of a value.
    pub(super) fn components(&self, value: ValueType) -> impl Iterator<Item = DeclarationId> {
        let record = value.declaration.and_then(|id| self.names.base(id));
        record.into_iter().flat_map(|record| self.names.inside(record))
    }

    /// How well a value of one type can be given for another, as far as both are known.
    pub(super) fn fit(&self, wanted: ValueType, given: ValueType) -> Fit {
        let base = |value: ValueType| value.declaration.and_then(|id| self.names.base(id));
        match (base(wanted), base(given)) {
            (Some(_), Some(_)) if wanted.declaration == given.declaration => Fit::Same,
            (Some(wanted), Some(given)) if wanted == given => Fit::Alike,
            _ => Fit::Other,
        }
    }
}

/// How well a type fits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fit {
    /// It is the type.
    Same,
    /// It stands for the same: `intnum` for `num`.
    Alike,
    /// It is another one, or is not known.
    Other,
}

/// The start of the group that ends with the last word.
fn group_start(cursor: &Cursor<'_>, words: &[usize]) -> Option<usize> {
    let mut depth = 0;
    for (index, word) in words.iter().enumerate().rev() {
        match cursor.kind(*word) {
            TokenKind::RightParen | TokenKind::RightBrace | TokenKind::RightBracket => depth += 1,
            TokenKind::LeftParen | TokenKind::LeftBrace | TokenKind::LeftBracket => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(index);
        }
    }
    None
}

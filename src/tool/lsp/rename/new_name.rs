//! Whether a text can be a name.

use super::refusal::Refusal;
use crate::rapid::builtins;
use crate::rapid::names::Names;
use crate::rapid::syntax::{TokenKind, tokenize};

/// Most characters of a name.
const LONGEST: usize = 32;

/// The name in lower case.
pub(super) fn checked(new: &str) -> Result<String, Refusal> {
    let tokens = tokenize(new.as_bytes());
    let kind = tokens.kind(0);
    let is_one = tokens.count() == 1;
    if is_one && kind.is_keyword() {
        return Err(Refusal::Keyword(new.to_owned()));
    }
    if !is_one || kind != TokenKind::Identifier || !new.starts_with(char::is_alphabetic) {
        return Err(Refusal::NotAName(new.to_owned()));
    }
    let length = new.chars().count();
    if length > LONGEST {
        return Err(Refusal::TooLong { name: new.to_owned(), length });
    }
    let key = new.to_lowercase();
    let taken = Names::predefined(&key).is_some()
        || builtins::data_type(&key).is_some()
        || builtins::is_listed(&key);
    if taken { Err(Refusal::Taken(new.to_owned())) } else { Ok(key) }
}

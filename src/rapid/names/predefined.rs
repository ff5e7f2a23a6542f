//! The predefined declarations.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::collect::{Bytes, Collected};
use super::declaration::{Basic, DeclarationId, Kind};
use super::keys::Key;
use crate::rapid::builtins::DECLARATIONS;
use crate::rapid::syntax;
use crate::rapid::text::{FileId, charset};

/// The file of predefined declarations.
pub(super) const NOWHERE: FileId = FileId(u32::MAX);

/// The predefined declarations and their names.
pub(super) struct Predefined {
    pub(super) collected: Collected,
    pub(super) by_name: HashMap<Key, DeclarationId>,
}

/// Read once.
pub(super) static PREDEFINED: LazyLock<Predefined> = LazyLock::new(|| {
    let mut collected = Collected::default();
    for text in DECLARATIONS {
        let bytes = text.as_bytes();
        let source = Bytes { file: NOWHERE, bytes, charset: charset(bytes) };
        collected.add(source, &syntax::parse(bytes));
    }
    let top = collected.declarations.iter().enumerate().filter(|(_, declaration)| {
        let parent = declaration.parent.map(|id| &collected.declarations[id.0 as usize]);
        parent.is_some_and(|parent| parent.kind == Kind::Module)
    });
    let by_name: HashMap<Key, DeclarationId> =
        top.map(|(index, declaration)| (declaration.key, DeclarationId(index as u32))).collect();
    for (id, key) in std::mem::take(&mut collected.stated) {
        let basic = match collected.keys.text(key) {
            "atomic" => Some(Basic::Atomic),
            "semivalue" => Some(Basic::SemiValue),
            "nonvalue" => Some(Basic::NonValue),
            "opaque" => Some(Basic::Opaque),
            "number" => Some(Basic::Number),
            "any" => Some(Basic::Any),
            _ => None,
        };
        let declaration = &mut collected.declarations[id.0 as usize];
        match basic {
            Some(basic) => declaration.kind = Kind::Basic(basic),
            None => declaration.value.declaration = by_name.get(&key).copied(),
        }
    }
    Predefined { collected, by_name }
});

//! The predefined declarations.

use std::sync::LazyLock;

use super::collect::{Bytes, Collected};
use super::declaration::{Basic, DeclarationId, Kind};
use super::keys::KeyMap;
use crate::rapid::builtins::DECLARATIONS;
use crate::rapid::syntax;
use crate::rapid::text::{FileId, Span, charset};

/// The file of the first module of predefined declarations; the others count down.
const LAST_FILE: u32 = u32::MAX;

/// The predefined declarations and their names.
pub(super) struct Predefined {
    pub(super) collected: Collected,
    pub(super) by_name: KeyMap<DeclarationId>,
}

/// Read once.
pub(super) static PREDEFINED: LazyLock<Predefined> = LazyLock::new(|| {
    let mut collected = Collected::default();
    for (index, text) in DECLARATIONS.into_iter().enumerate() {
        let bytes = text.as_bytes();
        let file = FileId(LAST_FILE - index as u32);
        let source = Bytes { file, content: bytes, charset: charset(bytes) };
        collected.add(source, &syntax::parse(bytes));
    }
    let top = collected.declarations.iter().enumerate().filter(|(_, declaration)| {
        let parent = declaration.parent.map(|id| &collected.declarations[id.0 as usize]);
        parent.is_some_and(|parent| parent.kind == Kind::Module)
    });
    let mut by_name = KeyMap::new();
    for (index, declaration) in top {
        by_name.insert(declaration.key, DeclarationId(index as u32));
    }
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
            None => declaration.value.declaration = by_name.get(key),
        }
    }
    Predefined { collected, by_name }
});

/// The text of a span of a predefined declaration.
pub(super) fn text(span: Span) -> &'static str {
    let module = DECLARATIONS.get((LAST_FILE - span.file.0) as usize);
    module.and_then(|text| text.get(span.start as usize..span.end as usize)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rapid::builtins::{function, instruction};
    use crate::rapid::names::declaration::RoutineKind;

    #[test]
    fn declarations_are_free_of_errors_and_agree_with_the_tables() {
        for text in DECLARATIONS {
            assert_eq!(syntax::parse(text.as_bytes()).errors, []);
        }
        let all = &PREDEFINED.collected;
        for declaration in &all.declarations {
            let name = all.keys.text(declaration.key);
            let typed = declaration.value.declaration.is_some();
            match declaration.kind {
                Kind::Routine(RoutineKind::Proc) => assert!(instruction(name).is_some(), "{name}"),
                Kind::Routine(_) => assert!(function(name).is_some() && typed, "{name}"),
                Kind::Data(_) | Kind::Parameter(_) | Kind::Component | Kind::Alias => {
                    assert!(typed, "{name} has no type");
                }
                _ => {}
            }
        }
    }
}

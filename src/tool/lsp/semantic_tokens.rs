//! Colours by meaning.

use gen_lsp_types::{SemanticToken, SemanticTokens, SemanticTokensLegend};

use super::workspace::View;
use crate::rapid::names::{Declaration, Kind, Meaning, Names, Role, RoutineKind, Storage, Use};
use crate::rapid::syntax::TokenKind;
use crate::rapid::text::Span;

/// The kinds, in the order of their numbers.
const KINDS: [&str; 13] = [
    "namespace",
    "type",
    "struct",
    "property",
    "variable",
    "parameter",
    "function",
    "event",
    "label",
    "keyword",
    "comment",
    "string",
    "number",
];

/// The modifiers, in the order of their bits.
const MODIFIERS: [&str; 3] = ["declaration", "readonly", "defaultLibrary"];

const DECLARATION: u32 = 1;
const READ_ONLY: u32 = 1 << 1;
const BUILT_IN: u32 = 1 << 2;

/// What the numbers of tokens mean.
pub(super) fn legend() -> SemanticTokensLegend {
    let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    SemanticTokensLegend { token_types: owned(&KINDS), token_modifiers: owned(&MODIFIERS) }
}

/// The tokens of a document.
pub(super) fn semantic_tokens(view: View<'_>) -> SemanticTokens {
    let module = view.project.module(view.file);
    let names = view.project.names_of(view.file).next();
    let mut uses = names.map_or(&[][..], |names| names.uses(view.file)).iter().peekable();
    let tokens = module.parse().tree.tokens();
    let mut data = Vec::new();
    let (mut line, mut character) = (0, 0);
    for index in 0..tokens.count() {
        let range = tokens.range(index);
        let span = Span { file: view.file, start: range.start, end: range.end };
        while uses.next_if(|one| one.start < range.start).is_some() {}
        let own = uses.peek().copied().filter(|one| one.start == range.start);
        let Some((kind, modifiers)) = (match tokens.kind(index) {
            TokenKind::Comment => Some(("comment", 0)),
            TokenKind::Number => Some(("number", 0)),
            TokenKind::Identifier => own.zip(names).map(|(one, names)| identifier(names, one)),
            TokenKind::String | TokenKind::UnclosedString => Some(("string", 0)),
            kind if kind.is_keyword() => Some(("keyword", 0)),
            _ => None,
        }) else {
            continue;
        };
        let start = view.positions().position(range.start);
        let length = view.workspace.units.length(&module.file.text(span));
        let delta_line = start.line - line;
        let delta_start =
            if delta_line == 0 { start.character - character } else { start.character };
        (line, character) = (start.line, start.character);
        let token_type = KINDS.iter().position(|known| *known == kind).unwrap_or_default() as u32;
        data.push(SemanticToken {
            delta_line,
            delta_start,
            length,
            token_type,
            token_modifiers_bitset: modifiers,
        });
    }
    SemanticTokens { result_id: None, data }
}

fn identifier(names: &Names, one: &Use) -> (&'static str, u32) {
    let by_role = match one.role {
        Role::Procedure | Role::Function => "function",
        Role::Trap => "event",
        Role::Type => "type",
        Role::Component => "property",
        Role::Argument => "parameter",
        Role::Label => "label",
        Role::Declaration | Role::Value => "variable",
    };
    match one.meaning {
        Meaning::Declared(id) => {
            let declaration = names.declaration(id);
            let (kind, mut modifiers) = declared(declaration);
            if one.role == Role::Declaration {
                modifiers |= DECLARATION;
            }
            if names.is_predefined(id) {
                modifiers |= BUILT_IN;
            }
            (kind, modifiers)
        }
        Meaning::Predefined(_) => (by_role, READ_ONLY | BUILT_IN),
        Meaning::Known => (by_role, BUILT_IN),
        Meaning::Late | Meaning::Open | Meaning::Unknown => (by_role, 0),
    }
}

fn declared(declaration: &Declaration) -> (&'static str, u32) {
    match declaration.kind {
        Kind::Module => ("namespace", 0),
        Kind::Record => ("struct", 0),
        Kind::Component => ("property", 0),
        Kind::Alias | Kind::Basic(_) => ("type", 0),
        Kind::Data(Storage::Const) | Kind::Counter => ("variable", READ_ONLY),
        Kind::Data(Storage::Pers | Storage::Var) => ("variable", 0),
        Kind::Routine(RoutineKind::Trap) => ("event", 0),
        Kind::Routine(RoutineKind::Func | RoutineKind::Proc) => ("function", 0),
        Kind::Parameter(_) => ("parameter", 0),
        Kind::Label => ("label", 0),
    }
}

//! What may stand at the cursor.

use crate::rapid::builtins::OTHERS;
use crate::rapid::names::{DeclarationId, Kind, RoutineKind, ValueType};
use crate::rapid::syntax::TokenKind;
use crate::tool::lsp::call::{Argument, Call, call, is_in_list};
use crate::tool::lsp::cursor::{Cursor, Place, ends_value};
use crate::tool::lsp::scope::Scope;

/// What may stand at the cursor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// A new name, or nothing.
    Nothing,
    /// These components or options.
    These(Vec<DeclarationId>),
    /// A type; before it in a list of parameters, how it is passed.
    Type(&'static [&'static str]),
    /// One of these words.
    Words(&'static [&'static str]),
    /// A label of the routine.
    Label,
    /// A trap.
    Trap,
    /// A statement; behind the condition of an IF also the rest of it.
    Statement,
    /// A value, of this type if it is known.
    Value(ValueType),
}

const PASSED: &[&str] = &["INOUT", "VAR", "PERS"];
const DECLARATIONS: &[&str] = &[
    "VAR",
    "PERS",
    "CONST",
    "PROC",
    "FUNC",
    "TRAP",
    "RECORD",
    "ALIAS",
    "LOCAL",
    "TASK",
    "ENDMODULE",
];
const SCOPED: &[&str] = &["VAR", "PERS", "CONST", "PROC", "FUNC", "TRAP", "RECORD", "ALIAS"];
const OPERATORS: &[&str] = &["AND", "OR", "XOR", "DIV", "MOD"];
const CONDITION: &[&str] = &["THEN", "AND", "OR", "XOR", "DIV", "MOD"];
const LOOP: &[&str] = &["FROM", "TO", "STEP", "DO", "DIV", "MOD"];
const REPEATED: &[&str] = &["DO", "AND", "OR", "XOR", "DIV", "MOD"];

pub(super) fn wanted(cursor: &Cursor<'_>, scope: &Scope<'_>) -> Wanted {
    match (cursor.last(), cursor.place) {
        (Some(TokenKind::Dot), _) => {
            let before = &cursor.words[..cursor.words.len() - 1];
            Wanted::These(scope.components(scope.last_value(cursor, before)).collect())
        }
        (last, Place::Header) => header(last),
        (Some(TokenKind::Backslash), _) => options(cursor, scope),
        (None, Place::Outside) => Wanted::Words(&["MODULE"]),
        (None, Place::Module) => Wanted::Words(DECLARATIONS),
        (None, Place::Record) => Wanted::Type(&["ENDRECORD"]),
        (_, Place::Record) => Wanted::Nothing,
        (Some(TokenKind::Local | TokenKind::Task), _) => Wanted::Words(SCOPED),
        (last, _) => declaration(cursor, scope).unwrap_or_else(|| statement(cursor, scope, last)),
    }
}

/// In the first line of a routine.
fn header(last: Option<TokenKind>) -> Wanted {
    match last {
        Some(TokenKind::LeftParen | TokenKind::Comma | TokenKind::Backslash | TokenKind::Bar) => {
            Wanted::Type(PASSED)
        }
        Some(TokenKind::Var | TokenKind::Pers | TokenKind::InOut | TokenKind::Func) => {
            Wanted::Type(&[])
        }
        _ => Wanted::Nothing,
    }
}

/// In the declaration of data.
fn declaration(cursor: &Cursor<'_>, scope: &Scope<'_>) -> Option<Wanted> {
    let is_scope =
        |word: &&usize| matches!(cursor.kind(**word), TokenKind::Local | TokenKind::Task);
    let rest = &cursor.words[cursor.words.iter().take_while(is_scope).count()..];
    match cursor.kind(*rest.first()?) {
        TokenKind::Var | TokenKind::Pers | TokenKind::Const => {}
        TokenKind::Alias => {
            return Some(if rest.len() == 1 { Wanted::Type(&[]) } else { Wanted::Nothing });
        }
        _ => return None,
    }
    let Some(of_type) = rest.get(1) else { return Some(Wanted::Type(&[])) };
    let assigned = rest.iter().any(|word| cursor.kind(*word) == TokenKind::Assign);
    if !assigned && !is_in_list(cursor) {
        return Some(Wanted::Nothing);
    }
    let value = scope.of_type(&cursor.text(*of_type));
    Some(value_or_operator(cursor, value, OPERATORS))
}

/// In a statement of a routine.
fn statement(cursor: &Cursor<'_>, scope: &Scope<'_>, last: Option<TokenKind>) -> Wanted {
    let Some(last) = last else { return Wanted::Statement };
    let first = cursor.words.first().map(|word| cursor.kind(*word));
    let unknown = ValueType::UNKNOWN;
    match first {
        Some(TokenKind::Goto) => return Wanted::Label,
        Some(TokenKind::Connect) if last == TokenKind::With => return Wanted::Trap,
        Some(TokenKind::Connect) if last != TokenKind::Connect => return Wanted::Words(&["WITH"]),
        Some(TokenKind::For) if last == TokenKind::For => return Wanted::Nothing,
        Some(TokenKind::For) => return value_or_operator(cursor, scope.of_type("num"), LOOP),
        Some(TokenKind::If | TokenKind::ElseIf) => {
            return value_or_operator(cursor, scope.of_type("bool"), CONDITION);
        }
        Some(TokenKind::While) => {
            return value_or_operator(cursor, scope.of_type("bool"), REPEATED);
        }
        _ => {}
    }
    if let Some(call) = call(cursor) {
        let of_type = if call.is_fresh { parameter(cursor, scope, &call) } else { unknown };
        return value_or_operator(cursor, of_type, OPERATORS);
    }
    let target = cursor.words.iter().position(|word| cursor.kind(*word) == TokenKind::Assign);
    let of_type = match target {
        Some(at) if at + 1 == cursor.words.len() => scope.last_value(cursor, &cursor.words[..at]),
        _ => unknown,
    };
    value_or_operator(cursor, of_type, OPERATORS)
}

fn value_or_operator(
    cursor: &Cursor<'_>,
    of_type: ValueType,
    operators: &'static [&'static str],
) -> Wanted {
    // Behind the name of a called procedure its first argument begins.
    let is_callee = call(cursor).is_some_and(|call| Some(&call.callee) == cursor.words.last());
    match cursor.last() {
        Some(last) if ends_value(last) && !is_callee => Wanted::Words(operators),
        _ => Wanted::Value(of_type),
    }
}

/// The options of the called routine that are not given yet.
fn options(cursor: &Cursor<'_>, scope: &Scope<'_>) -> Wanted {
    let Some(call) = call(cursor) else { return Wanted::Nothing };
    let Some(routine) = scope.routine(&cursor.text(call.callee)) else { return Wanted::Nothing };
    let given: Vec<String> = call.given.iter().map(|word| cursor.text(*word)).collect();
    let names = scope.names;
    let free = names.inside(routine).filter(|id| {
        let key = names.key(*id);
        let optional =
            matches!(names.declaration(*id).kind, Kind::Parameter(mode) if mode.group.is_some());
        let others = names.is_predefined(*id) && key == OTHERS;
        optional && !others && given.iter().all(|given| given != key)
    });
    Wanted::These(free.collect())
}

/// The type of the parameter of the argument at the cursor.
fn parameter(cursor: &Cursor<'_>, scope: &Scope<'_>, call: &Call) -> ValueType {
    let names = scope.names;
    let found = scope.routine(&cursor.text(call.callee)).and_then(|routine| {
        let parameters = || {
            let inside = names.inside(routine).map(|id| (id, names.declaration(id)));
            inside.filter_map(|(id, declaration)| match declaration.kind {
                Kind::Parameter(mode) => Some((id, mode, declaration.value)),
                _ => None,
            })
        };
        match call.argument {
            Argument::Position(wanted) => {
                parameters().filter(|(_, mode, _)| mode.group.is_none()).nth(wanted)
            }
            Argument::Named(word) => {
                let key = cursor.text(word);
                parameters().find(|(id, _, _)| names.key(*id) == key)
            }
            Argument::Unnamed => None,
        }
    });
    found.map_or(ValueType::UNKNOWN, |(_, _, value)| value)
}

/// Whether a routine is a function.
pub(super) fn is_function(kind: Kind) -> bool {
    kind == Kind::Routine(RoutineKind::Func)
}
